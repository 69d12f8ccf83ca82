// SPDX-License-Identifier: Apache-2.0
// fsi-check: does a program keep to PROTOCOL.md? Plays the other half of a coupled run against it.
#include <cstdio>
#include <filesystem>

#include "common/app/guarded.h"
#include "common/app/log.h"
#include "coupling/check/driver.h"
#include "coupling/check/scenario.h"
#include "coupling/join.h"

namespace {

using namespace bw;
using namespace bw::coupling;

int play(int argc, char** argv, const check::Options& options) {
  Session session(argc, argv);
  return guarded(session, [&]() -> int {
    CouplingCase cs;
    cs.join_limit = options.port.empty() ? 30 : 10;
    if (!options.port.empty()) cs.join = "port", cs.port_file = options.port;
    const bool solid = options.play == "solid";
    const Joined joined = join(session, solid ? Role::solid : Role::fluid, cs);
    if (!joined.channel) throw CodedError(check::exit_found_wanting, "the program under test has not the other role");
    return solid ? check::play_solid(*joined.channel, options) : check::play_fluid(*joined.channel, options);
  });
}

}  // namespace

int main(int argc, char** argv) {
  set_speaker("fsi-check", true);
  if (argc > 1 && (std::string(argv[1]) == "--help" || std::string(argv[1]) == "-h")) {
    std::fputs(check::usage(), stdout);
    return exit_ok;
  }
  try {
    const check::Options options = check::read_options(argc, argv);
    if (!options.scenario.empty()) return play(argc, argv, options);
    std::vector<std::string> arguments;
    for (int i = 1; i < argc && std::string(argv[i]) != "--"; ++i) arguments.push_back(argv[i]);
    set_speaker("", true);
    return check::run_all(std::filesystem::canonical("/proc/self/exe"), options, arguments) == 0 ? exit_ok : 1;
  } catch (const InputError& e) {
    error_line(e.what());
    std::fputs(check::usage(), stderr);
    return exit_input;
  }
}
