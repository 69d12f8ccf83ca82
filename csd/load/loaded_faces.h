// SPDX-License-Identifier: Apache-2.0
// Faces that bear a load, in the order in which they add to their nodes.
#pragma once
#include <utility>
#include <vector>

#include "common/parallel/loop.h"
#include "csd/mesh/mesh.h"

namespace bw::csd {

/// Groups of faces in colours: groups of one colour share no node, so several threads add to nodes at once, and a node
/// receives in the same order for any number of threads. Colours hold for good: cracks only remove sharing.
class LoadedFaces {
 public:
  LoadedFaces() = default;
  /// Each face once; kept by element and side.
  LoadedFaces(const Mesh& mesh, std::vector<Face> faces);

  size_t size() const { return faces_.size(); }
  Face operator[](size_t i) const { return faces_[i]; }
  auto begin() const { return faces_.begin(); }
  auto end() const { return faces_.end(); }
  /// Adds the load's forces at time t on all faces but those that are left. In parallel. What is read and written at a
  /// face's nodes is asked for in good time: after cracks they lie far apart.
  template <class Load>
  void add(const Load& load, const Mesh& mesh, const Field<Vec3, NodeId>& x, double t, Field<Vec3, NodeId>& f) const {
    const auto now = load.at(t);
    for (const auto& groups : colours_)
      parallel_for_dynamic(int64_t(groups.size()), [&](int64_t g) {
        const auto [first, last] = groups[size_t(g)];
        fetch(mesh, groups[size_t(g)], x, f);
        for (size_t i = first; i < last; ++i) {
          if (is_left(i)) continue;
          const auto n = mesh.nodes_of(faces_[i]);
          load.on_face(i, {x[n[0]], x[n[1]], x[n[2]], x[n[3]]}, now, [&](size_t a) -> Vec3& { return f[n[a]]; });
        }
      });
  }
  /// Faces with nodes that are marked [node] are left from now on, no others; later nodes are not marked. Returns those
  /// that were not left before, in the order in which they added to their nodes.
  std::vector<int32_t> leave(const Mesh& mesh, const std::vector<char>& is_left);

 private:
  using Group = std::pair<size_t, size_t>;  // from one face to before another
  bool is_left(size_t i) const { return !left_.empty() && left_[i]; }
  void fetch(const Mesh& mesh, Group group, const Field<Vec3, NodeId>& x, const Field<Vec3, NodeId>& f) const;

  std::vector<Face> faces_;
  std::vector<char> left_;  // [face]; empty: none
  std::vector<std::vector<Group>> colours_;
};

}  // namespace bw::csd
