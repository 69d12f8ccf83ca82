// SPDX-License-Identifier: Apache-2.0
// Fragments that move as rigid bodies: in the step (csd/step.cpp), and who becomes one. A fragment is a component by
// shared nodes, so a node is of one rigid body or of none. On several ranks every rank moves all of them alike. A
// body's nodes follow it in each step where conditions, contact or another program may look at them, else only where
// loads or elements beside it do (Followers); the others when all are asked for (complete).
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "common/math/units.h"
#include "csd/fragments/air_drag.h"
#include "csd/fragments/followers.h"
#include "csd/fragments/fragments.h"
#include "csd/fragments/rigid_body.h"
#include "csd/load/conditions/list.h"

namespace bw::csd {

struct Model;
struct State;
struct Physics;
struct Elements;

/// [solid.rigid.box]
struct BoxInput {
  Vec3 lower{}, upper{};
  template <class K>
  void describe(K& k) {
    k.required("lower", lower, dim::length, "corner of the box");
    k.required("upper", upper, dim::length, "opposite corner");
    k.expect(lower.x < upper.x && lower.y < upper.y && lower.z < upper.z, "upper", "more than lower in x, y and z");
  }
};

/// [solid.rigid]
struct RigidInput {
  int elements = 0, every = 10;
  double age = 0, stress = 0;
  std::string motion = "six_dof", place;
  std::vector<std::string> bodies;
  std::vector<double> switch_times;
  std::optional<BoxInput> box;
  std::optional<DragInput> drag;
  template <class K>
  void describe(K& k) {
    k.optional("elements", elements,
               "a fragment of at most so many elements becomes rigid; 0: none does by itself. Bodies as they were at "
               "the start are no fragments, and fragments with held nodes (conditions but walls, springs and drag) "
               "stay as they are");
    k.optional("age", age, dim::time, "it must have been apart for so long");
    k.optional("stress", stress, dim::pressure,
               "and the mean over its volume of the von Mises stress must be below; 0: any");
    k.choice("motion", motion, {"six_dof", "mean_force"},
             "six_dof: momentum and angular momentum are kept; mean_force: the mean of the forces accelerates all its "
             "nodes alike (the paper's), its spin is lost");
    k.optional("every", every, "steps from one look for new ones to the next");
    k.optional("bodies", bodies, "names of bodies that are rigid from the start");
    k.optional("switch_times", switch_times, dim::time,
               "when these become deformable, rigid again and so on, at the step that reaches the time");
    k.table("box", box,
            "a fragment that has left this box altogether is retired: it becomes rigid, is recorded as it flew, stands "
            "still and costs nothing; absent: none");
    k.table("drag", drag, "drag of still air on rigid bodies, on top of their loads; absent: none");
    k.expect(elements >= 0, "elements", "a number >= 0");
    k.expect(age >= 0, "age", "a time >= 0");
    k.expect(stress >= 0, "stress", "a stress >= 0");
    k.expect(every >= 1, "every", "a number >= 1");
    bool rises = true;
    for (size_t i = 1; i < switch_times.size(); ++i) rises = rises && switch_times[i] > switch_times[i - 1];
    k.expect(rises, "switch_times", "times that rise");
    k.expect(switch_times.empty() || !bodies.empty(), "switch_times", "`bodies` that they are for");
    if (!k.is_manual()) place = k.where("bodies");
  }
};

class Rigid {
 public:
  /// body_names of the mesh's bodies. InputError for a name that isn't one.
  Rigid(const RigidInput& input, const std::vector<std::string>& body_names, const Mesh& mesh);

  /// At the start, forces known: bodies that are rigid from then on. InputError if nodes of theirs are held.
  void start(Model& m);
  /// At the end of a step: new ones, and those whose time has come. Costs nothing while there is nothing to look at.
  void renew(Model& m);

  /// x, v and f of all nodes as their bodies have them.
  void complete(State& s);
  /// Loads' own forces at all nodes.
  void complete(Loads& loads) const { followers_.give_back(loads); }
  /// All nodes are followed in each step from now on: another program looks at them.
  void follow_all(Model& m);

  // --- in the step, in this order
  void begin_kick(State& s, double h);  ///< after the nodes' own
  void meet_walls(std::vector<ConditionKind>& conditions, State& s, double dt);
  void drift(State& s, double dt);  ///< after the nodes' own: places, and velocities as they have turned
  void after_elements(const Elements& el, State& s);  ///< nodes bear no internal force, flow is undone
  /// Once all loads and conditions have added theirs; dt: the step that ends, 0: they are summed up anew.
  void take_forces(const Loads* loads, State& s, double dt);
  void end_kick(State& s, double h);  ///< after the nodes' own
  /// Nodes lose what drag has added: their forces change within the step.
  void give_back(State& s);
  /// W, of the loads' forces that Loads leaves to bodies, at the bodies' velocities; as Loads::power.
  double load_power(const State& s) const;
  double drag_work() const { return drag_work_; }  ///< J, since the start
  /// Bound of the step [s] where no element gives one: the fastest turns by 0.05, or flies a tenth of its radius.
  double accurate_step() const;

  const std::vector<RigidBody>& bodies() const { return bodies_; }
  std::vector<RigidBody>& bodies() { return bodies_; }
  /// [node] 1: of a rigid body; later nodes are not.
  const std::vector<char>& is_rigid_node() const { return is_rigid_; }
  /// Place of a node's body in bodies(), -1: it has none.
  int32_t body_at(NodeId n) const { return size_t(n) < body_at_.size() ? body_at_[size_t(n)] : -1; }
  /// Nodes of no body, ascending, the same on all ranks: how many of the state's, and the i-th.
  int64_t free_count(const State& s) const;
  NodeId free_node(int64_t i) const {
    const int64_t later = i - int64_t(free_.size());
    return later < 0 ? free_[size_t(i)] : NodeId(int64_t(is_rigid_.size()) + later);
  }
  bool is_rigid(NodeId n) const { return size_t(n) < is_rigid_.size() && is_rigid_[size_t(n)]; }
  int64_t elements() const { return elements_; }  ///< that are rigid now
  /// What left the box, in all; null if there is none.
  struct Left {
    int64_t count = 0;
    double mass = 0;  ///< kg
    Vec3 momentum{};  ///< kg m/s
  };
  const Left* left() const { return input_.box ? &left_ : nullptr; }
  /// Rows of those that left get the motion that they left with.
  void add_left(Model& m, std::vector<Fragment>& table);
  /// Up to date with all cracks.
  const Fragments& fragments(Model& m);

  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    RigidBody::keep(a, bodies_);
    a.lists("elements", elems_);
    a.value("next_switch", next_switch_), a.value("opened", opened_), a.value("waiting", is_waiting_);
    a.list("records", records_), a.value("left", left_);
    if (input_.drag) a.list("air", air_), a.value("drag_work", drag_work_);
  }
  /// After keep() has restored, and the state with it: what follows from them.
  void go_on(Model& m);

 private:
  struct Piece {  // label of the fragment and its elements, ascending
    int32_t label;
    std::vector<ElemId> elems;
  };
  struct Record {  // of a fragment that left
    ElemId elem;   // one of its
    double t;
    Vec3 velocity, angular_momentum, spin;
    double kinetic_energy;
  };
  struct Air {        // what a body feels of it
    double area = 0;  // m^2, 0: it is too large
    Vec3 R;           // N
  };
  struct Kept {  // histories of the rigid elements of a block that has others
    int block;
    std::vector<int> in_lanes;
    std::vector<double> values;  // [components][lane]
  };
  std::vector<Piece> candidates(Model& m);
  std::vector<Piece> beyond_box(Model& m);
  void retire(Model& m);
  void keep_calm(Model& m, std::vector<Piece>& pieces);
  template <class Work>
  void for_bodies(const Work& work);
  void renew_asked(Model& m, size_t first);
  void freeze(Model& m, const std::vector<Piece>& pieces);
  Air air_of(const Model& m, const Piece& piece, const RigidBody& body) const;
  double add_drag(size_t b, State& s, double dt);  ///< J, its work in this half step
  void release(Model& m);
  void renew_marks(Model& m, size_t first = 0);
  void renew_block(Model& m, int block);
  std::vector<Piece> pieces_of(Model& m, const std::vector<char>& is_label_wanted);
  std::vector<Piece> switched_pieces(Model& m);

  RigidInput input_;
  RigidBody::Motion motion_;
  std::vector<char> is_switched_;           // [mesh's body] named in `bodies`
  size_t next_switch_ = 0;                  // into switch_times
  std::optional<Fragments> own_fragments_;  // without cracks
  std::vector<int64_t> whole_;              // [label at the start] elements
  std::vector<RigidBody> bodies_;           // in the order in which they became
  std::vector<std::vector<ElemId>> elems_;  // [body]
  std::vector<Air> air_;                    // [body] where there is drag
  double drag_work_ = 0;
  bool follows_all_ = false, asks_all_ = false;
  bool is_current_ = true;        // nodes that don't follow are where their bodies are
  Followers followers_;           // unless all are asked for
  std::vector<char> is_rigid_;    // [node]
  std::vector<int32_t> body_at_;  // [node]
  std::vector<NodeId> free_;      // of those in is_rigid_
  std::vector<Kept> kept_;
  std::vector<Record> records_;
  Left left_;
  int64_t elements_ = 0, opened_ = -1;  // faces at the last look
  bool is_waiting_ = false;             // for age or stress
};

}  // namespace bw::csd
