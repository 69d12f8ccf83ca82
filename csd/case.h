// SPDX-License-Identifier: Apache-2.0
// The case file as csd sees it: [time], [output], [solid], [coupling]. Only case.cpp reads input.
#pragma once
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/app/cli.h"
#include "common/app/run_control.h"
#include "coupling/case.h"
#include "csd/element/elements.h"
#include "csd/element/filter.h"
#include "csd/energy.h"
#include "csd/fracture/fracture.h"
#include "csd/fragments/contact.h"
#include "csd/fragments/rigid.h"
#include "csd/load/conditions/list.h"
#include "csd/load/list.h"
#include "csd/load/mass_scaling.h"
#include "csd/load/relaxation.h"
#include "csd/load/sets.h"
#include "csd/material/material_case.h"
#include "csd/mesh/input.h"
#include "csd/probe.h"

namespace bw::csd {

/// Initial motion of a body besides its velocity: spin about an axis, and radial away from the axis or a point.
struct MotionCase {
  Vec3 spin{}, centre{}, axis{0, 0, 1};
  double radial = 0;
  std::string away_from = "axis";
  template <class K>
  void describe(K& k) {
    k.optional("spin", spin, dim::spin, "angular velocity about `centre`");
    k.optional("radial", radial, dim::velocity, "speed away from the axis, or from its centre");
    k.choice("away_from", away_from, {"axis", "centre"}, "what `radial` leads away from");
    k.optional("centre", centre, dim::length, "a point of the axis");
    k.optional("axis", axis, dim::none, "direction of the axis (of any length)");
    k.expect(norm(axis) > 0, "axis", "a direction other than (0, 0, 0)");
  }
  Vec3 velocity(const Vec3& x) const;
};

/// [[solid.body]]
struct BodyCase {
  std::string name;
  MeshInput mesh;
  MaterialCase material;
  Vec3 velocity{};
  std::optional<MotionCase> motion;
  template <class K>
  void describe(K& k) {
    k.required("name", name, "of the body; its sets are also known as \"name.set\"");
    k.table("mesh", mesh, "mesh of the body");
    k.table("material", material, "material of the body");
    k.optional("velocity", velocity, dim::velocity, "initial velocity");
    k.table("motion", motion, "further initial velocity: spin and expansion");
    k.expect(!name.empty(), "name", "a name");
  }
};

struct TimeStepCase {
  double safety = 0.9, maximum = 0, fixed = 0;
  int levels = 0;
  std::string place_levels;
  template <class K>
  void describe(K& k) {
    k.optional("safety", safety, dim::none,
               "step over 2/omega_max, where omega_max is a bound from the elements' actual stiffness");
    k.optional("maximum", maximum, dim::time, "longest step; 0: no limit");
    k.optional("fixed", fixed, dim::time, "step, whatever is stable; 0: from the stable step");
    k.optional(
        "levels", levels,
        "local time steps: elements far from limiting the step take one of up to 2^levels times the shortest; 0: "
        "all take the same");
    if (!k.is_manual()) place_levels = k.where("levels");
    k.expect(safety > 0 && safety <= 1.5, "safety", "a number in (0, 1.5]");
    k.expect(levels >= 0 && levels <= 6, "levels", "a number from 0 to 6");
    k.expect(maximum >= 0, "maximum", "a time >= 0");
    k.expect(fixed >= 0, "fixed", "a time >= 0");
  }
};

struct ViscosityCase : BulkViscosity {
  template <class K>
  void describe(K& k) {
    k.optional("linear", linear, dim::none,
               "c1 of q = rho h (c1 c_L + c2^2 h |rate|) |rate|, on compression; 0.06 is usual");
    k.optional("quadratic", quadratic, dim::none, "c2; 1.5 is usual (strong shocks)");
    k.expect(linear >= 0, "linear", "a number >= 0");
    k.expect(quadratic >= 0, "quadratic", "a number >= 0");
  }
};

/// [[solid.velocity]]
struct InitialVelocityCase {
  std::string nodes, place;
  Vec3 velocity{};
  std::optional<MotionCase> motion;
  template <class K>
  void describe(K& k) {
    k.required("nodes", nodes, "name of the node set, of a region for example (mesh.sets)");
    k.optional("velocity", velocity, dim::velocity, "initial velocity");
    k.table("motion", motion, "further initial velocity: spin and expansion");
    if (!k.is_manual()) place = k.where("nodes");
  }
};

/// [solid.wet]
struct WetCase {
  std::vector<std::string> faces;
  template <class K>
  void describe(K& k) {
    k.optional("faces", faces,
               "face sets that touch the fluid, besides faces made by cracks; empty: the whole boundary");
    if (!k.is_manual()) place = k.where("faces");
  }
  std::string place;
};

/// InputError if two of the list have one name.
template <class K, class Named>
void expect_own_names(K& k, const char* key, const std::vector<Named>& list) {
  std::set<std::string> names;
  for (const Named& item : list)
    k.expect(names.insert(item.name).second, key, "a name of its own for each (\"" + item.name + "\" is there twice)");
}

/// [solid]
struct SolidCase {
  int threads = 0;
  bool renumber = true, skip_resting = true, skip_elastic = true;
  std::string history = "double";
  std::vector<BodyCase> bodies;
  FilterCase filter;
  ViscosityCase viscosity;
  EnergyCase energy;
  TimeStepCase time_step;
  std::optional<FractureInput> fracture;
  std::optional<RigidInput> rigid;
  std::optional<ContactInput> contact;
  std::vector<InitialVelocityCase> velocities;
  std::vector<LoadCase> loads;
  std::vector<ConditionCase> conditions;
  std::optional<RelaxationCase> relaxation;
  std::optional<MassScalingCase> mass_scaling;
  std::vector<ProbeCase> probes;
  WetCase wet;
  template <class K>
  void describe(K& k) {
    k.optional("threads", threads, "threads of csd; 0: OMP_NUM_THREADS or what the machine gives");
    k.expect(threads >= 0, "threads", "a number of threads, or 0");
    k.optional("renumber", renumber,
               "number elements and nodes along a space-filling curve (faster; results differ by round-off)");
    k.optional("skip_resting", skip_resting, "pass over elements that no wave has reached (faster; the same results)");
    k.optional(
        "skip_elastic", skip_elastic,
        "pass over the return mapping where nothing yields, and read the history of a parallelepiped in which nothing "
        "has flowed at one point only (faster; the same results)");
    k.choice("history", history, {"double", "single"},
             "precision in which the points' plastic strains are stored; single: half the memory, rounded by 6e-8");
    k.tables("body", bodies, "a body: mesh, material, initial motion");
    k.expect(!bodies.empty(), "body", "at least one [[solid.body]]");
    expect_own_names(k, "body", bodies);
    k.table("filter", filter, "pressure filter");
    k.table("viscosity", viscosity, "bulk viscosity; off unless given");
    k.table("energy", energy, "what happens when energy goes missing");
    k.table("time_step", time_step, "choice of the time step");
    k.table("fracture", fracture, "cracks by splitting nodes; absent: none");
    k.table("rigid", rigid, "fragments and bodies that move as rigid ones; absent: none");
    k.table("contact", contact, "lips of cracks, fragments and bodies meet each other; absent: they pass through");
    k.tables("velocity", velocities, "initial velocity of a region, in place of its body's");
    k.tables("load", loads, "a load");
    k.tables("condition", conditions, "a condition on nodes");
    k.table("static", relaxation, "to the static solution by dynamic relaxation; absent: the run is dynamic");
    k.table("mass_scaling", mass_scaling, "more mass for elements with short steps; absent: none");
    k.expect(!(rigid && relaxation), "rigid", "no [solid.static] beside it: a rigid body has no static solution");
    k.tables("probe", probes, "columns of solid_history.csv");
    expect_own_names(k, "probe", probes);
    k.table("wet", wet, "the surface that touches the fluid");
  }
};

struct Case {
  std::string file;
  RunControl run;
  coupling::CouplingCase coupling;
  SolidCase solid;
  std::string restart;  ///< a checkpoint, or a folder: its latest one; empty: from the start
};

/// InputError for anything wrong in the file.
Case read_case(const CommandLine& line);
/// Every key, with unit, default and meaning.
std::string case_manual();

}  // namespace bw::csd
