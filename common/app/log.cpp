// SPDX-License-Identifier: Apache-2.0
#include "common/app/log.h"

#include <cstdio>

namespace bw {

namespace {

struct Speaker {
  std::string program;
  bool speaks = true;
  std::string status;
};
Speaker& speaker() {
  static Speaker s;
  return s;
}

/// One write per line, so that lines of two programs on one terminal do not mix.
void print(std::FILE* out, const char* kind, const std::string& line) {
  const Speaker& s = speaker();
  const bool covered = !s.status.empty();
  const std::string name = s.program.empty() ? "" : "[" + s.program + "] ";
  const std::string all = fmt::format("{}{}{}{}\n", covered ? "\r\033[K" : "", name, kind, line);
  std::fwrite(all.data(), 1, all.size(), out);
  std::fflush(out);
  if (covered) show_status(std::string(s.status));
}

}  // namespace

void set_speaker(const std::string& program, bool speaks) {
  speaker().program = program;
  speaker().speaks = speaks;
}
const std::string& program_name() { return speaker().program; }
bool speaks() { return speaker().speaks; }

void say_line(const std::string& line) { print(stdout, "", line); }
void warn_line(const std::string& line) { print(stderr, "warning: ", line); }
void error_line(const std::string& line) { print(stderr, "error: ", line); }

void show_status(const std::string& line) {
  if (line.empty() && speaker().status.empty()) return;
  const std::string all = "\r\033[K" + line;
  std::fwrite(all.data(), 1, all.size(), stdout);
  std::fflush(stdout);
  speaker().status = line;
}

}  // namespace bw
