// SPDX-License-Identifier: Apache-2.0
#include "coupling/check/scenario.h"

#include <fmt/format.h>

#include <chrono>
#include <cstring>
#include <thread>

#include "common/app/error.h"
#include "common/app/log.h"

namespace bw::coupling::check {
namespace {

constexpr Scenario against_fluid[] = {
    {.name = "rest", .expected = "a cube at rest in gas at rest: P = p0 on each face within 1e-6, no net force"},
    {.name = "piston",
     .expected = "the cube starts at a small speed: P - p0 = +rho c u in front, -rho c u behind, within a quarter "
                 "(units, sign, gauge)"},
    {.name = "co_moving", .expected = "a cube that swims with the program's own stream: P = p0 within 1e-3"},
    {.name = "split",
     .expected =
         "the moving cube breaks in two, all orders turned: pressures follow the face ids, lips get finite ones"},
    {.name = "degenerate", .expected = "quads without area and triangles among the faces: one finite P each"},
    {.name = "empty", .expected = "a surface without faces: an answer without pressures"},
    {.name = "vanish", .expected = "all faces die, later others are born: answers of the right length"},
    {.name = "short_windows",
     .expected = "windows a thousand times shorter than asked for elsewhere: t0 < t1 <= t1_max"},
    {.name = "fixed_window",
     .expected =
         "the solid leads, by windows of many steps of the fluid: t1 = t1_max, P above p0 in front, below behind"},
    {.name = "t_end", .expected = "the run ends at the smaller t_end with BYE both ways, exit code 0"},
    {.name = "early_bye", .expected = "BYE instead of the first surface: answered, exit code 0"},
    {.name = "turned", .expected = "the fluid comes first on the command line: the same", .turned = true},
    {.name = "ranks_2", .expected = "two ranks: the same loads as one, bit for bit", .ranks = 2, .like = "ranks_1"},
    {.name = "ranks_3", .expected = "three ranks: the same loads as one, bit for bit", .ranks = 3, .like = "ranks_1"},
    {.name = "nan",
     .expected = "a velocity that is not a number: both end with code 69",
     .code = exit_bad_value,
     .timed = true},
    {.name = "index",
     .expected = "a face that names a node that isn't there: code 69",
     .code = exit_bad_value,
     .timed = true},
    {.name = "size", .expected = "too few positions: code 68", .code = exit_malformed, .timed = true},
    {.name = "order", .expected = "a window that is left out: code 68", .code = exit_malformed, .timed = true},
    {.name = "hash",
     .expected = "a hash that isn't the connectivity's: code 68",
     .code = exit_malformed,
     .timed = true},
    {.name = "version", .expected = "HELLO of major version 2: code 65", .code = exit_version, .timed = true},
    {.name = "minor",
     .expected = "a solid that needs a minor version yet to come: code 65",
     .code = exit_version,
     .timed = true},
    {.name = "magic", .expected = "HELLO of another protocol: code 64", .code = exit_protocol, .timed = true},
    {.name = "p_ref", .expected = "another reference pressure: code 66", .code = exit_disagreement, .timed = true},
    {.name = "fail", .expected = "FAIL with code 42: the program ends with 42 too", .code = 42, .timed = true},
    {.name = "silence",
     .expected = "no surface for the silence limit of 2 s: code 75",
     .code = exit_silence,
     .timed = true,
     .wait = short_silence},
    {.name = "death",
     .expected = "the solid dies without a word: the program is gone too, not code 0",
     .code = -1,
     .timed = true},
};

constexpr Scenario against_solid[] = {
    {.name = "rest", .expected = "P = p_ref: each surface sound, the solid got no impulse"},
    {.name = "push",
     .expected =
         "P above p_ref: the solid's books are sum -(P - p_ref) A dt to 1e-12, its faces move along that force"},
    {.name = "short_windows",
     .expected = "windows of a tenth of the stable step: the next starts where this one ended"},
    {.name = "stop", .expected = "the fluid asks to stop: BYE after that window, exit code 0"},
    {.name = "turned", .expected = "the fluid comes first on the command line: the same", .turned = true},
    {.name = "ranks_2", .expected = "two ranks: the same surfaces as one, bit for bit", .ranks = 2, .like = "ranks_1"},
    {.name = "nan",
     .expected = "a pressure that is not a number: both end with code 69",
     .code = exit_bad_value,
     .timed = true},
    {.name = "late_t1", .expected = "t1 beyond t1_max: code 69", .code = exit_bad_value, .timed = true},
    {.name = "standstill", .expected = "t1 = t0: code 69", .code = exit_bad_value, .timed = true},
    {.name = "size", .expected = "a pressure too few: code 68", .code = exit_malformed, .timed = true},
    {.name = "order", .expected = "an answer to another window: code 68", .code = exit_malformed, .timed = true},
    {.name = "books",
     .expected = "an impulse in LOAD that isn't that of its pressures: code 78",
     .code = exit_ledger,
     .timed = true},
    {.name = "bye", .expected = "BYE instead of LOAD: code 76", .code = exit_bye, .timed = true},
    {.name = "version", .expected = "HELLO of major version 2: code 65", .code = exit_version, .timed = true},
    {.name = "minor",
     .expected = "a fluid that needs a minor version yet to come: code 65",
     .code = exit_version,
     .timed = true},
    {.name = "magic", .expected = "HELLO of another protocol: code 64", .code = exit_protocol, .timed = true},
    {.name = "p_ref", .expected = "another reference pressure: code 66", .code = exit_disagreement, .timed = true},
    {.name = "apart", .expected = "a domain far from the surface: code 67", .code = exit_apart, .timed = true},
    {.name = "fail", .expected = "FAIL with code 42: the program ends with 42 too", .code = 42, .timed = true},
    {.name = "silence",
     .expected = "no load for the silence limit of 2 s: code 75",
     .code = exit_silence,
     .timed = true,
     .wait = short_silence},
    {.name = "death",
     .expected = "the fluid dies without a word: the program is gone too, not code 0",
     .code = -1,
     .timed = true},
};

}  // namespace

std::span<const Scenario> scenarios_of(const std::string& play) {
  if (play == "solid") return against_fluid;
  return against_solid;
}

void found_wanting(const std::string& text) { throw CodedError(exit_found_wanting, text); }

void mark_accident() {
  const double now = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  error_line(fmt::format("accident at {:.6f}", now));
}

void keep_silent(Channel& channel, const Options& options) {
  const bool apart = !options.port.empty();
  std::this_thread::sleep_for(std::chrono::duration<double>(apart ? 2 * short_silence : 10 * short_silence));
  if (!apart) return;
  for (int i = 0; i < 200; ++i) {
    channel.poll();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

void strange_hello(Channel& channel, HelloBlock h, const std::string& scenario) {
  if (scenario == "version") h.major = 2;
  if (scenario == "minor") h.minor_needed = protocol_minor + 1;
  if (scenario == "magic") std::memset(h.magic, 'x', sizeof h.magic);
  if (scenario == "p_ref") h.p_ref = 2 * h.p_ref + 1;
  if (scenario == "apart")
    for (double& x : h.lower) x = 9e29;
  HelloBlock other{};
  channel.receive(tag_hello, "HELLO", &other, sizeof other);
  mark_accident();
  channel.send(tag_hello, &h, sizeof h);
  channel.flush();
  if (scenario == "minor" && other.minor < minor_of_minor_needed)  // it can't know: who needs more refuses it
    channel.fail(exit_version, check_minor(h, other)->text);
}

}  // namespace bw::coupling::check
