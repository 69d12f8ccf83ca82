// SPDX-License-Identifier: Apache-2.0
#include "common/io/json.h"

#include <fmt/format.h>

#include <cmath>

namespace bw {

namespace {

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\')
      out += fmt::format("\\{}", c);
    else if (static_cast<unsigned char>(c) < 0x20)
      out += fmt::format("\\u{:04x}", int(c));
    else
      out += c;
  }
  return out + "\"";
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{}", value) : "null"; }

}  // namespace

void JsonObject::add(const std::string& name, double value) { members_.push_back({name, number(value), {}}); }
void JsonObject::add(const std::string& name, int64_t value) {
  members_.push_back({name, fmt::format("{}", value), {}});
}
void JsonObject::add(const std::string& name, bool value) { members_.push_back({name, value ? "true" : "false", {}}); }
void JsonObject::add(const std::string& name, const std::string& value) {
  members_.push_back({name, quoted(value), {}});
}
void JsonObject::add(const std::string& name, const std::vector<double>& values) {
  std::string list;
  for (const double v : values) list += fmt::format("{}{}", list.empty() ? "" : ", ", number(v));
  members_.push_back({name, fmt::format("[{}]", list), {}});
}
void JsonObject::add(const std::string& name, const std::vector<JsonObject>& values) {
  members_.push_back({name, "", values, false, true});
}
void JsonObject::add(const std::string& name, const JsonObject& value) {
  members_.push_back({name, "", {value}, true, false});
}

std::string JsonObject::text(int level) const {
  const std::string blanks(size_t(2 * level + 2), ' ');
  std::string out = "{";
  for (size_t i = 0; i < members_.size(); ++i) {
    const Member& m = members_[i];
    out += fmt::format("{}\n{}{}: ", i ? "," : "", blanks, quoted(m.name));
    if (m.is_object) {
      out += m.objects[0].text(level + 1);
    } else if (m.is_list) {
      out += '[';
      for (size_t j = 0; j < m.objects.size(); ++j)
        out += fmt::format("{}\n{}  {}", j ? "," : "", blanks, m.objects[j].text(level + 2));
      out += m.objects.empty() ? "]" : fmt::format("\n{}]", blanks);
    } else {
      out += m.value;
    }
  }
  return members_.empty() ? "{}" : fmt::format("{}\n{}}}", out, std::string(size_t(2 * level), ' '));
}

}  // namespace bw
