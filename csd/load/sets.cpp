// SPDX-License-Identifier: Apache-2.0
#include "csd/load/sets.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "common/app/error.h"

namespace bw::csd {
namespace {

/// Levenshtein distance.
size_t edits(const std::string& a, const std::string& b) {
  std::vector<size_t> row(b.size() + 1);
  for (size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (size_t i = 1; i <= a.size(); ++i) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= b.size(); ++j) {
      const size_t above = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, diagonal + (a[i - 1] != b[j - 1])});
      diagonal = above;
    }
  }
  return row[b.size()];
}

template <class Sets>
const auto& find(const Sets& sets, const std::string& name, const std::string& place, const char* kind) {
  if (const auto it = sets.find(name); it != sets.end()) return it->second;
  std::string names, nearest;
  for (const auto& [other, unused] : sets) {
    names += (names.empty() ? "" : ", ") + other;
    if (nearest.empty() || edits(name, other) < edits(name, nearest)) nearest = other;
  }
  throw InputError(fmt::format("{}: the mesh has no {} set \"{}\"{}; it has: {}", place, kind, name,
                               nearest.empty() ? "" : fmt::format(", did you mean \"{}\"?", nearest),
                               names.empty() ? "none" : names));
}

}  // namespace

const std::vector<NodeId>& node_set(const Mesh& mesh, const std::string& name, const std::string& place) {
  return find(mesh.node_sets, name, place, "node");
}
const std::vector<ElemId>& elem_set(const Mesh& mesh, const std::string& name, const std::string& place) {
  return find(mesh.elem_sets, name, place, "element");
}
const std::vector<Face>& face_set(const Mesh& mesh, const std::string& name, const std::string& place) {
  return find(mesh.face_sets, name, place, "face");
}
std::vector<Face> face_sets(const Mesh& mesh, const std::vector<std::string>& names, const std::string& place) {
  if (names.empty()) throw InputError(fmt::format("{}: expected the name of a face set at least", place));
  std::vector<Face> faces;
  std::set<std::pair<int, int>> seen;
  for (const std::string& name : names)
    for (Face f : face_set(mesh, name, place))
      if (seen.insert({f.elem, f.side}).second) faces.push_back(f);
  return faces;
}

}  // namespace bw::csd
