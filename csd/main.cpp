// SPDX-License-Identifier: Apache-2.0
// csd: explicit Lagrangian finite elements, alone or coupled to a fluid program.
#include <cstdio>

#include "common/app/guarded.h"
#include "common/app/log.h"
#include "common/app/machine.h"
#include "coupling/replay.h"
#include "csd/run.h"

namespace bw::csd {
namespace {

int program(const Session& session, int argc, char** argv) {
  const CommandLine line = read_command_line(argc, argv, "csd", "solid mechanics: metal that flows, cracks and flies");
  if (line.exit_code) return *line.exit_code;
  if (line.manual) {
    std::fputs(case_manual().c_str(), stdout);
    return exit_ok;
  }
  const Case cs = read_case(line);
  const int threads = use_threads(cs.solid.threads);
  if (const std::string text = thread_warning(threads); !text.empty()) warn("{}", text);
  coupling::Joined joined;
  if (!line.check) {
    joined = coupling::join_or_replay(session, coupling::Role::solid, cs.coupling);
    set_speaker("csd", joined.mine.root());
  }
  Model model = build(cs, joined.mine);
  if (line.check) {
    check(cs, model);
    return exit_ok;
  }
  return run(cs, model, joined.channel.get());
}

}  // namespace
}  // namespace bw::csd

int main(int argc, char** argv) {
  bw::Session session(argc, argv);
  bw::set_speaker("csd", bw::is_first_of_program(session));
  return bw::guarded(session, [&] { return bw::csd::program(session, argc, argv); });
}
