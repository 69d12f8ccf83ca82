// SPDX-License-Identifier: Apache-2.0
// Contact by impulses on the velocities with which positions are about to move: a node that would pass through a face
// within the step loses, with the face, the part of their relative velocity that makes it pass
// (csd/fragments/meeting.h). An impulse acts on both along the face's normal through the node and its foot, so momentum
// and angular momentum are exact; it takes energy, or none, and what it takes is booked. What has passed already is not
// pushed back.
//   lips: nodes of the lips of a crack against the faces that they parted from, until these have moved away
//   bodies: nodes against the faces of other fragments and bodies, found by a spatial hash
// Every rank follows all nodes that may meet, and does the same.
#pragma once
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/math/units.h"
#include "csd/fragments/fragments.h"
#include "csd/fragments/supports.h"

namespace bw::csd {

struct Model;
struct Meeting;

/// [solid.contact]
struct ContactInput {
  bool lips = true, bodies = true;
  double restitution = 0, friction = 0;
  template <class K>
  void describe(K& k) {
    k.optional("lips", lips, "the lips of a crack don't pass through each other");
    k.optional("bodies", bodies,
               "fragments and bodies don't pass through each other: no node of one through a face of another (edges "
               "may cross edges by a part of an element)");
    k.optional("restitution", restitution, dim::none,
               "between rigid fragments or bodies: relative velocity along the normal, after over before, of the "
               "points that meet; at most 1. Deformable ones bounce by their own stiffness");
    k.optional("friction", friction, dim::none,
               "Coulomb's coefficient where at least one of the two is rigid; there is none between deformable ones, "
               "whose angular momentum it would change");
    k.expect(restitution >= 0 && restitution <= 1, "restitution", "a number from 0 to 1");
    k.expect(friction >= 0, "friction", "a number >= 0");
  }
};

class Contact {
 public:
  explicit Contact(const ContactInput& input) : input_(input) {}

  /// Changes velocities s.v, those of the coming step dt, and rigid bodies' motion.
  void act(Model& m, double dt);
  double work() const { return work_; }           ///< J, since the start; negative but for moving supports
  int64_t impulses() const { return impulses_; }  ///< given so far
  /// Nodes of deformable bodies that the last step's impulses moved, each once. Forces of contact come with the step
  /// after a time: until then velocities at that time lack half a step of what holds these nodes.
  const std::vector<NodeId>& pushed() const { return pushed_; }

  struct Pair {
    NodeId node;
    Face face;
    float depth;  ///< m: what lies deeper behind the face has not come through it
  };
  /// Faces that a node may meet soon; of all of one group, those that it is in front of and the nearest one behind
  /// which it is count.
  struct Nearby {
    std::vector<Pair> pairs;
    std::vector<int32_t> group{0};  ///< [groups + 1] into pairs
    int count() const { return int(group.size()) - 1; }
    void clear() { pairs.clear(), group.assign(1, 0); }
  };

  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    a.list("supported", held_.row), a.list("free", held_.free);
    a.list("fresh", fresh_), a.list("fresh_sides", is_fresh_), a.value("lips", lips_);
    a.list("lip_pairs", near_lips_.pairs), a.list("lip_groups", near_lips_.group);
    a.list("body_pairs", near_bodies_.pairs), a.list("body_groups", near_bodies_.group);
    a.list("surface", surface_), a.value("margin", margin_), a.value("used", used_), a.value("drift", drift_);
    a.value("version", version_), a.value("searched", searched_), a.value("next_search", next_search_);
    a.value("impulses", impulses_), a.value("work", work_);
  }
  /// After keep() has restored, and the state with it.
  void go_on(Model& m) { follow_surface(m); }

 private:
  // contact_search.cpp
  void find_depths(const Mesh& mesh);
  void follow_surface(Model& m);
  void add_lips(const Model& m);
  void search_lips(const Model& m);
  void search_bodies(Model& m, double travel);
  std::vector<Face> faces_near_others(const Model& m, const Fragments& fragments) const;
  bool is_lip_pair(const Model& m, NodeId n, Face f) const;
  // contact.cpp
  void renew(Model& m, double dt);
  void renew_supports(const Model& m);
  std::vector<Meeting> find_meetings(Model& m, double dt) const;

  ContactInput input_;
  Supports held_;
  std::vector<Face> fresh_;          // lips that haven't parted
  Field<uint8_t, ElemId> is_fresh_;  // bit per side
  Nearby near_lips_, near_bodies_;
  Field<std::array<float, 6>, ElemId> depths_;  // m, of each side; found at the first search
  std::vector<NodeId> surface_;                 // all nodes of the boundary, at the last search
  std::vector<NodeId> pushed_;                  // by the last act()
  std::vector<int32_t> root_;                   // work space: [node, body]
  size_t lips_ = 0;                             // of the boundary that are known
  int64_t version_ = -1, searched_ = -1;        // of the topology: known; that near_bodies_ is of
  int64_t next_search_ = 0;                     // the earliest step for one because of cracks
  double margin_ = -1, used_ = 0;               // m, of near_bodies_; by which things may have come nearer since
  Vec3 drift_;                                  // m/s, about what the whole surface moves with
  int64_t impulses_ = 0;
  double work_ = 0;
  std::optional<Fragments> own_fragments_;  // without cracks
};

}  // namespace bw::csd
