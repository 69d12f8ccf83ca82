// SPDX-License-Identifier: Apache-2.0
#include "coupling/handshake.h"

#include <algorithm>
#include <cstring>

#include "common/app/log.h"
#include "common/app/timers.h"

namespace bw::coupling {

Greeting shake_hands(Channel& channel, const CouplingCase& cs, const Hello& hello) {
  const Timed timed("handshake", Timed::waiting);
  Greeting result;
  double& t_end = result.t_end = hello.t_end;
  if (channel.leader()) {
    const HelloBlock mine = result.mine = pack(hello, cs, name_of(channel.role()), channel.mine().size());
    channel.send(tag_hello, &mine, sizeof mine);
    channel.wait({tag_hello});  // of any size: another version's may be longer
    std::vector<char> bytes(channel.size_of(tag_hello));
    channel.receive(tag_hello, "HELLO", bytes.data(), bytes.size());
    HelloBlock& other = result.other;
    std::memcpy(static_cast<void*>(&other), bytes.data(), std::min(bytes.size(), sizeof other));
    if (const Verdict fault = check_protocol(other, bytes.size())) channel.fail(fault->code, fault->text);
    other.program[sizeof other.program - 1] = other.version[sizeof other.version - 1] = 0;
    channel.set_peer(other.program, std::min(mine.silence_limit, other.silence_limit));
    if (const Verdict fault = check_minor(mine, other)) channel.fail(fault->code, fault->text);
    if (const Verdict fault = check_agreement(mine, other)) channel.fail(fault->code, fault->text);
    channel.flush();
    result.features = other.features;
    if (other.t_end > 0) t_end = t_end > 0 ? std::min(t_end, other.t_end) : other.t_end;
    if (!(t_end > hello.t0)) channel.fail(exit_disagreement, "HELLO: neither program knows when to end");
    if (channel.role() == Role::solid) {  // one of the two says so
      if (t_end != hello.t_end)
        warn("{} ends at {:.9g} s already, {:.9g} s were asked for here", other.program, t_end, hello.t_end);
      if (const std::string warning = overlap_warning(mine, other); !warning.empty()) warn("{}", warning);
    }
  }
  channel.share(&t_end, sizeof t_end);
  channel.share(&result.features, sizeof result.features);
  return result;
}

}  // namespace bw::coupling
