// SPDX-License-Identifier: Apache-2.0
// cfd: compressible flow of two materials with embedded moving surfaces, alone or coupled to a solid program.
#include <cstdio>

#include "cfd/run.h"
#include "common/app/guarded.h"
#include "common/app/log.h"
#include "common/app/machine.h"
#include "coupling/replay.h"

namespace bw::cfd {
namespace {

int program(const Session& session, int argc, char** argv) {
  const CommandLine line = read_command_line(argc, argv, "cfd", "compressible flow: detonation products and air around moving, cracking bodies");
  if (line.exit_code) return *line.exit_code;
  if (line.manual) {
    std::fputs(case_manual().c_str(), stdout);
    return exit_ok;
  }
  const Case cs = read_case(line);
  const int threads = use_threads(cs.fluid.threads);
  if (const std::string text = thread_warning(threads); !text.empty()) warn("{}", text);
  if (line.check) {
    check(cs, session.world());
    return exit_ok;
  }
  coupling::Joined joined = coupling::join_or_replay(session, coupling::Role::fluid, cs.coupling);
  set_speaker("cfd", joined.mine.root());
  return run(cs, joined.mine, joined.channel.get());
}

}  // namespace
}  // namespace bw::cfd

int main(int argc, char** argv) {
  bw::Session session(argc, argv);
  bw::set_speaker("cfd", bw::is_first_of_program(session));
  return bw::guarded(session, [&] { return bw::cfd::program(session, argc, argv); });
}
