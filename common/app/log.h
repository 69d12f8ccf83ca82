// SPDX-License-Identifier: Apache-2.0
// Lines on the screen: `say("{} nodes", n)` prints "[csd] 1234 nodes" from the program's root rank only.
#pragma once
#include <fmt/format.h>

#include <string>

namespace bw {

/// Names the program in front of each line and says whether this rank speaks. Before it is called every rank does,
/// without a name.
void set_speaker(const std::string& program, bool speaks);
const std::string& program_name();
bool speaks();

void say_line(const std::string& line);   ///< stdout
void warn_line(const std::string& line);  ///< stderr, with "warning: "
/// stderr, from any rank, whatever set_speaker said.
void error_line(const std::string& line);

template <class... A>
void say(fmt::format_string<A...> text, A&&... values) {
  if (speaks()) say_line(fmt::format(text, std::forward<A>(values)...));
}
template <class... A>
void warn(fmt::format_string<A...> text, A&&... values) {
  if (speaks()) warn_line(fmt::format(text, std::forward<A>(values)...));
}

/// A line that the next one replaces (the progress bar); empty removes it.
void show_status(const std::string& line);

}  // namespace bw
