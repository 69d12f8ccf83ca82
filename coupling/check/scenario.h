// SPDX-License-Identifier: Apache-2.0
// The scenarios: what fsi-check does, and what it expects of the program under test.
#pragma once
#include <span>
#include <string>

#include "coupling/channel.h"
#include "coupling/check/options.h"
#include "coupling/messages.h"

namespace bw::coupling::check {

struct Scenario {
  const char* name;
  const char* expected;   ///< for people
  int code = 0;           ///< exit code of the pair
  bool timed = false;     ///< ends with an accident, after which both must be gone in time
  double wait = 0;        ///< s that pass first by agreement
  int ranks = 1;          ///< of the program under test
  const char* like = "";  ///< another scenario that it must agree with, bit for bit
  bool turned = false;    ///< the program under test comes first on the command line
};
/// Against a program of the other role; in the order of play.
std::span<const Scenario> scenarios_of(const std::string& play);

/// What fsi-check itself found wrong: ends the run with this code.
constexpr int exit_found_wanting = 9;
[[noreturn]] void found_wanting(const std::string& text);
/// A line for the driver: the clock of an accident on purpose.
void mark_accident();
/// Says HELLO with what the scenario makes wrong in it, after the peer's has come.
void strange_hello(Channel& channel, HelloBlock h, const std::string& scenario);
/// Longer than the silence limit of the scenarios that wait for it; met by a port the program can't end this one.
void keep_silent(Channel& channel, const Options& options);
constexpr double short_silence = 2;  ///< s, silence limit of the scenarios that wait for it

int play_solid(Channel& channel, const Options& options);
int play_fluid(Channel& channel, const Options& options);

}  // namespace bw::coupling::check
