// SPDX-License-Identifier: Apache-2.0
#include "common/io/manual.h"

#include <fmt/format.h>

#include "common/io/quantity.h"

namespace bw {

namespace {

void print(const ManualSection& s, int depth, std::string& out) {
  if (!s.path.empty())
    out += fmt::format("\n{} {}{}\n", depth == 0 ? "##" : "###", s.path, s.note.empty() ? "" : "    (" + s.note + ")");
  if (!s.doc.empty()) out += s.doc + "\n";
  if (!s.entries.empty()) out += '\n';
  for (const auto& e : s.entries) {
    const std::string need = e.fallback.empty() ? "required" : "default " + e.fallback;
    out += fmt::format("- `{}` : {}; {}\n      {}\n", e.key, e.kind, need, e.doc);
  }
  for (const auto& sub : s.sections) print(*sub, depth + 1, out);
}

constexpr const char* introduction = R"text(# The case file

TOML 1.0. One file serves both programs; each reads its own table and the common ones.

- A bare number is SI. A text carries its unit: `"7.76 g/cm^3"`, `"1.283e10 dyn/cm^2"`, `"150 us"`, `"25 degC"`,
  `"4.29e6 J/kg"`, `"0.5 kg/(m s^2)"`. Numbers of a list may be either: `["1 cm", 0.02, 0]`.
- A point or vector is a list of three: `[0, 0, "-300 m/s"]`.
- `[a.b]` opens a table, `[[a.b]]` one of a list of tables; `b = {key = 1}` and `b = [{key = 1}, {key = 2}]` say the same in line.
- Below, `a.b[]` stands for each of the tables [[a.b]]. A heading `a.b(kind = "x")` lists the keys that stand beside `kind = "x"` in
  the table [a.b].
- Paths of files are relative to the folder of the case file.
- A key that is not listed here is an error.

## Units

)text";

}  // namespace

ManualSection& ManualSection::add(std::string new_path, std::string new_note, std::string new_doc) {
  auto s = std::make_unique<ManualSection>();
  s->path = std::move(new_path);
  s->note = std::move(new_note);
  s->doc = std::move(new_doc);
  sections.push_back(std::move(s));
  return *sections.back();
}

std::string ManualSection::text() const {
  std::string out = introduction + unit_manual();
  if (!entries.empty()) out += "\n## At the top of the file\n";
  print(*this, -1, out);
  return out;
}

}  // namespace bw
