// SPDX-License-Identifier: Apache-2.0
#include "coupling/check/options.h"

#include <fmt/format.h>

#include <functional>
#include <map>

#include "common/app/error.h"

namespace bw::coupling::check {

const char* usage() {
  return "usage: fsi-check --play solid|fluid [options] -- PROGRAM [ARGUMENTS]\n"
         "Plays the other half of a coupled run against PROGRAM, scenario by scenario, and says what was expected.\n"
         "  --only A,B  --skip A,B      scenarios\n"
         "  --p-ref PA                  reference pressure of the case (101325)\n"
         "  --scheme NAME               that of the case: fluid_first (default), box1 or concurrent\n"
         "  --limit S                   longest time from an accident to the end of both programs (2)\n"
         "  --windows N                 windows of a scenario (10)\n"
         "  --window S                  their longest duration (a hundredth of edge/c; 20 stable steps of the solid)\n"
         "  --port FILE                 PROGRAM is started apart and met by this port file (an old one is there "
         "first)\n"
         "playing the solid, a cube in gas at rest:\n"
         "  --centre X Y Z  --edge M    of the cube (0.5 0.5 0.5, 0.2)\n"
         "  --p0 PA --rho KG/M3 --c M/S the gas (p-ref, 1.225, 340.3)\n"
         "  --speed M/S                 of the cube where it moves (1)\n"
         "  --flow X Y Z                the program's own stream, which a cube that swims along must not disturb (not "
         "looked at)\n"
         "playing the fluid:\n"
         "  --push PA                   pressure above p-ref (1e5)\n";
}

namespace {

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> words(1);
  for (const char c : text)
    if (c == ',')
      words.emplace_back();
    else
      words.back() += c;
  return words;
}

double number(const std::string& option, const std::string& word) {
  try {
    size_t end = 0;
    const double value = std::stod(word, &end);
    if (end == word.size()) return value;
  } catch (const std::exception&) {
  }
  throw InputError(fmt::format("{}: '{}' is no number", option, word));
}

}  // namespace

Options read_options(int argc, char** argv) {
  Options o;
  int at = 1;
  const auto next = [&](const std::string& option) -> std::string {
    if (++at >= argc) throw InputError(option + ": a value is missing");
    return argv[at];
  };
  const auto vec = [&](Vec3& v) {
    const std::string option = argv[at];
    for (int d = 0; d < 3; ++d) v[d] = number(option, next(option));
  };
  const auto real = [&](double& v) {
    const std::string option = argv[at];
    v = number(option, next(option));
  };
  const std::map<std::string, std::function<void()>> known = {
      {"--play", [&] { o.play = next("--play"); }},
      {"--scenario", [&] { o.scenario = next("--scenario"); }},
      {"--record", [&] { o.record = next("--record"); }},
      {"--scheme", [&] { o.scheme = next("--scheme"); }},
      {"--port", [&] { o.port = next("--port"); }},
      {"--only", [&] { o.only = split(next("--only")); }},
      {"--skip", [&] { o.skip = split(next("--skip")); }},
      {"--p-ref", [&] { real(o.p_ref); }},
      {"--p0", [&] { real(o.p0); }},
      {"--rho", [&] { real(o.rho); }},
      {"--c", [&] { real(o.c); }},
      {"--speed", [&] { real(o.speed); }},
      {"--edge", [&] { real(o.edge); }},
      {"--push", [&] { real(o.push); }},
      {"--limit", [&] { real(o.limit); }},
      {"--window", [&] { real(o.window); }},
      {"--windows", [&] { o.windows = int(number("--windows", next("--windows"))); }},
      {"--centre", [&] { vec(o.centre); }},
      {"--flow", [&] { vec(o.flow), o.has_flow = true; }},
  };
  for (; at < argc; ++at) {
    const std::string word = argv[at];
    if (word == "--") {
      o.command.assign(argv + at + 1, argv + argc);
      break;
    }
    const auto found = known.find(word);
    if (found == known.end()) throw InputError(fmt::format("unknown argument '{}'", word));
    found->second();
  }
  if (o.play != "solid" && o.play != "fluid") throw InputError("--play: expected solid or fluid");
  if (o.scheme != "fluid_first" && o.scheme != "box1" && o.scheme != "concurrent")
    throw InputError("--scheme: expected fluid_first, box1 or concurrent");
  if (o.command.empty() && o.scenario.empty()) throw InputError("the program to be checked is missing: -- PROGRAM");
  if (!(o.edge > 0) || !(o.rho > 0) || !(o.c > 0) || o.windows < 4 || o.window < 0 || !(o.limit > 0))
    throw InputError("--edge, --rho, --c, --limit: expected positive numbers; --windows: at least 4");
  return o;
}

}  // namespace bw::coupling::check
