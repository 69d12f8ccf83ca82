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
  /// work(i) for every face, which may add to its nodes. In parallel. What it reads and writes at its nodes is asked
  /// for in good time: after cracks a face's nodes lie far apart.
  template <class Work>
  void for_each(const Mesh& mesh, const Field<Vec3, NodeId>& x, const Field<Vec3, NodeId>& f, const Work& work) const {
    for (const auto& groups : colours_)
      parallel_for_dynamic(int64_t(groups.size()), [&](int64_t g) {
        fetch(mesh, groups[size_t(g)], x, f);
        for (size_t i = groups[size_t(g)].first; i < groups[size_t(g)].second; ++i) work(i);
      });
  }

 private:
  using Group = std::pair<size_t, size_t>;  // from one face to before another
  void fetch(const Mesh& mesh, Group group, const Field<Vec3, NodeId>& x, const Field<Vec3, NodeId>& f) const;

  std::vector<Face> faces_;
  std::vector<std::vector<Group>> colours_;
};

}  // namespace bw::csd
