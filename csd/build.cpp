// SPDX-License-Identifier: Apache-2.0
#include "csd/build.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/app/log.h"
#include "csd/ranks/needed.h"
#include "csd/step.h"

namespace bw::csd {
namespace {

Mesh build_mesh(const SolidCase& cs) {
  std::vector<Mesh> parts;
  std::vector<std::string> names;
  for (const BodyCase& body : cs.bodies) {
    MeshQuality quality;
    parts.push_back(make_mesh(body.mesh, quality));
    names.push_back(body.name);
    say("body {}: {}", body.name, summary(quality));
    for (const std::string& line : quality_report(quality)) say("  {}", line);
    for (const std::string& note : quality.notes) say("  {}", note);
  }
  Mesh mesh = merge(std::move(parts), names);
  if (cs.renumber) renumber_for_locality(mesh);
  return mesh;
}

void set_initial_velocities(const SolidCase& cs, const Mesh& mesh, State& s) {
  for (int e = 0; e < mesh.elem_count(); ++e) {
    const BodyCase& body = cs.bodies[size_t(mesh.body[ElemId(e)])];
    for (NodeId n : mesh.hex[ElemId(e)])
      s.v[n] = body.velocity + (body.motion ? body.motion->velocity(s.x[n]) : Vec3{});
  }
  for (const InitialVelocityCase& region : cs.velocities)
    for (NodeId n : node_set(mesh, region.nodes, region.place))
      s.v[n] = region.velocity + (region.motion ? region.motion->velocity(s.x[n]) : Vec3{});
}

/// InputError if nothing flows though the criterion, or the pieces' strength, asks how it does.
void check_flow(const SolidCase& cs) {
  if (std::any_of(cs.bodies.begin(), cs.bodies.end(),
                  [](const BodyCase& body) { return std::holds_alternative<J2Case>(body.material.choice); }))
    return;
  const auto& criterion = cs.fracture->criterion.model;
  const auto& pieces = cs.fracture->pieces;
  if (std::holds_alternative<EqpsLimit>(criterion) || std::holds_alternative<JohnsonCookDamage>(criterion))
    throw InputError(
        fmt::format("{}: expected a body that flows (material kind \"j2\"): elastic ones have no plastic "
                    "strain and never break by it",
                    cs.fracture->place));
  if (const auto* mott = pieces ? std::get_if<Mott>(&pieces->law) : nullptr; mott && mott->strength == 0)
    throw InputError(fmt::format("{}: expected `strength`, as no body has a flow stress", pieces->place));
}

/// [body] InputError if the criterion needs what a body that flows doesn't tell.
std::vector<FailureData> failure_data(const SolidCase& cs) {
  check_flow(cs);
  std::vector<FailureData> data;
  for (const BodyCase& body : cs.bodies) {
    data.push_back(body.material.failure);
    const bool flows = std::holds_alternative<J2Case>(body.material.choice);
    std::visit(
        [&](const auto& criterion) {
          if constexpr (requires { criterion.is_known(data.back()); })
            if (flows && !criterion.is_known(data.back()))
              throw InputError(
                  fmt::format("{}: the material of body \"{}\" doesn't tell what \"{}\" needs (damage, "
                              "spall_stress)",
                              cs.fracture->place, body.name, criterion.name));
        },
        cs.fracture->criterion.model);
  }
  return data;
}

/// InputError where nodes that a wall stops start behind it: it would put them, at once, where others are.
void check_walls(const std::vector<ConditionKind>& conditions, const Mesh& mesh) {
  for (const auto& condition : conditions) {
    const auto* wall = std::get_if<RigidWall>(&condition);
    if (!wall) continue;
    double deepest = 0, farthest = 0;
    Vec3 at;
    for (int32_t i = 0; i < mesh.node_count(); ++i) {
      if (!wall->stops(NodeId(i))) continue;
      const double gap = dot(mesh.X[NodeId(i)] - wall->point, wall->normal);
      farthest = std::max(farthest, norm(mesh.X[NodeId(i)] - wall->point));
      if (gap < deepest) deepest = gap, at = mesh.X[NodeId(i)];
    }
    if (deepest < -1e-6 * farthest)
      throw InputError(
          fmt::format("{}: the node at ({:.6g}, {:.6g}, {:.6g}) m starts {:.3g} m behind the wall; another "
                      "`point` or `normal`, or `nodes` without it",
                      wall->place, at.x, at.y, at.z, -deepest));
  }
}

/// Local steps know nothing of what ties nodes of different steps to each other.
void check_local_steps(const SolidCase& cs, const Comm& comm) {
  if (cs.time_step.levels == 0) return;
  const auto refuse = [&](bool is_so, const char* what) {
    if (is_so)
      throw InputError(fmt::format("{}: local time steps don't work with {}", cs.time_step.place_levels, what));
  };
  refuse(cs.filter.kind != "off", "a pressure filter");
  refuse(cs.contact.has_value(), "contact");
  refuse(cs.relaxation.has_value(), "a run to static");
  refuse(cs.mass_scaling.has_value(), "mass scaling");
  refuse(cs.time_step.fixed > 0, "a fixed step");
  refuse(comm.size() > 1, "several ranks of csd; use threads");
  for (const ConditionCase& condition : cs.conditions)
    refuse(std::holds_alternative<Spring>(condition.kind) || std::holds_alternative<Tie>(condition.kind),
           "springs and ties");
}

Physics build_physics(const SolidCase& cs, const Mesh& mesh, const Comm& comm, State& s) {
  check_local_steps(cs, comm);
  Elements elements;
  elements.blocks = make_blocks(mesh, int(cs.bodies.size()));
  if (comm.size() > 1) elements.ranks = std::make_shared<Ranks>(comm, mesh, elements.blocks);
  for (const BodyCase& body : cs.bodies) elements.materials.push_back(make_material(body.material));
  elements.skip_elastic = cs.skip_elastic;
  elements.single_history = cs.history == "single";
  start(mesh, elements, s);
  Physics ph;
  ph.elements = std::move(elements);
  ph.viscosity = cs.viscosity;
  s.local.most = cs.time_step.levels;
  ph.resting.skip = cs.skip_resting;
  ph.resting.start(ph.elements.blocks.block_count());
  for (int block = 0; block < ph.elements.blocks.block_count(); ++block)  // other ranks' are never looked at here
    if (!ph.elements.blocks.is_own(block)) ph.resting.state[size_t(block)] = Resting::reached;
  if (cs.filter.kind != "off") ph.filter.emplace(cs.filter, ph.elements, s);
  if (!cs.loads.empty()) {
    std::vector<LoadKind> kinds;
    for (const LoadCase& load : cs.loads) kinds.push_back(load.kind);
    ph.loads.emplace(mesh, std::move(kinds));
  }
  for (const ConditionCase& condition : cs.conditions) ph.conditions.push_back(condition.kind);
  for (auto& condition : ph.conditions) std::visit([&](auto& c) { c.select(mesh); }, condition);
  check_walls(ph.conditions, mesh);
  if (!cs.wet.faces.empty()) face_sets(mesh, cs.wet.faces, cs.wet.place);
  if (cs.relaxation) ph.relaxation.emplace(*cs.relaxation, s.x.size());
  if (cs.mass_scaling) ph.mass_scaling.emplace(*cs.mass_scaling, s);
  if (cs.fracture) ph.cracks.emplace(*cs.fracture, mesh, s.t, failure_data(cs));
  if (cs.contact) ph.contact.emplace(*cs.contact);
  if (cs.rigid) {
    std::vector<std::string> names;
    for (const BodyCase& body : cs.bodies) names.push_back(body.name);
    ph.rigid.emplace(*cs.rigid, names, mesh);
  }
  return ph;
}

}  // namespace

Model build(const Case& cs, const Comm& comm) {
  Mesh mesh = build_mesh(cs.solid);
  Topology topology(mesh);
  State s;
  Physics ph = build_physics(cs.solid, mesh, comm, s);
  set_initial_velocities(cs.solid, mesh, s);
  if (ph.elements.ranks && !ph.relaxation)  // dynamic relaxation looks at all nodes in each step
    ph.elements.ranks->follow(nodes_needed_everywhere(mesh, cs.solid.loads, ph.conditions), s);
  Model model{std::move(mesh), std::move(topology), std::move(s), std::move(ph)};
  first_forces(model);
  if (const auto& ranks = model.physics.elements.ranks) ranks->complete(model.state);
  if (model.physics.rigid) model.physics.rigid->start(model);
  model.physics.energy.initial = energy_row(model.physics, model.state).residual;
  return model;
}

}  // namespace bw::csd
