// SPDX-License-Identifier: Apache-2.0
#include "coupling/fluid_side.h"

#include <fmt/format.h>

#include "common/app/timers.h"
#include "common/parallel/loop.h"
#include "coupling/handshake.h"

namespace bw::coupling {

FluidSide::FluidSide(Channel& channel, const CouplingCase& cs, const Hello& hello) : channel_(channel) {
  const Greeting greeting = shake_hands(channel, cs, hello);
  t_end_ = greeting.t_end;
  minor_ = greeting.minor();
  known_.t = hello.t0;
  known_.window = hello.first_window - 1;
}

bool FluidSide::receive() {
  const Timed timed("wait for the surface", Timed::waiting);
  int32_t goes_on = 1;
  if (channel_.leader()) {
    if (channel_.wait({tag_step, tag_bye}) == tag_bye) {
      ByeBlock bye{};
      channel_.receive(tag_bye, "BYE", &bye, sizeof bye);
      bye = ByeBlock{};
      channel_.send(tag_bye, &bye, sizeof bye);
      channel_.flush();
      goes_on = 0;
    } else {
      channel_.receive(tag_step, "STEP", &step_, sizeof step_);
      if (const Verdict fault = check_step(step_, known_)) channel_.fail(fault->code, fault->text);
    }
  }
  channel_.share(&goes_on, sizeof goes_on);
  if (!goes_on) {
    channel_.mine().barrier();
    channel_.close();
    return false;
  }
  channel_.share(&step_, sizeof step_);
  window_ = {.index = step_.window,
             .t0 = step_.t0,
             .t1_max = step_.t1_max,
             .dt_stable = step_.dt_stable,
             .checkpoint = bool(step_.flags & step_checkpoint),
             .last = bool(step_.flags & step_last),
             .fixed = bool(step_.flags & step_fixed),
             .mean_pressure = bool(step_.flags & step_mean_pressure)};
  channel_.set_place(window_.index, window_.t0);
  receive_surface();
  return true;
}

void FluidSide::receive_surface() {
  topology_changed_ = step_.flags & step_connectivity;
  surface_.topo_version = step_.topo_version;
  if (channel_.leader()) receive_from_solid(size_t(step_.n_nodes), size_t(step_.n_faces));
  channel_.share(surface_.x);
  channel_.share(surface_.v);
  if (topology_changed_) {
    channel_.share(surface_.quads);
    for (std::vector<int64_t>* ids : {&surface_.node_id, &surface_.node_parent, &surface_.face_id})
      channel_.share(*ids);
    channel_.share(surface_.body);
    channel_.share(surface_.flags);
  }
  known_.window = step_.window;
  known_.topo_version = step_.topo_version;
  known_.hash = step_.hash;
  known_.n_nodes = step_.n_nodes;
  known_.n_faces = step_.n_faces;
}

void FluidSide::receive_from_solid(size_t nodes, size_t faces) {
  if (topology_changed_) {
    surface_.quads.resize(faces), ids_.resize(2 * nodes + faces), values_.resize(2 * faces);
    channel_.receive(tag_quads, "SURFACE: quads", surface_.quads.data(), faces * sizeof surface_.quads[0]);
    channel_.receive(tag_ids, "SURFACE: ids", ids_.data(), ids_.size() * sizeof ids_[0]);
    channel_.receive(tag_faces, "SURFACE: body and flags", values_.data(), values_.size() * sizeof values_[0]);
  }
  surface_.x.resize(nodes);
  surface_.v.resize(nodes);
  const auto receive_motion = [&] {
    channel_.receive(tag_x, "SURFACE: x", surface_.x.data(), nodes * sizeof(Vec3));
    channel_.receive(tag_v, "SURFACE: v", surface_.v.data(), nodes * sizeof(Vec3));
  };
  Verdict fault;
  uint64_t hash = step_.hash;
  const auto unpack_connectivity = [&] {
    const auto parents = ids_.begin() + int64_t(nodes), face_ids = parents + int64_t(nodes);
    surface_.node_id.assign(ids_.begin(), parents);
    surface_.node_parent.assign(parents, face_ids);
    surface_.face_id.assign(face_ids, ids_.end());
    const auto flags = values_.begin() + int64_t(faces);
    surface_.body.assign(values_.begin(), flags);
    surface_.flags.assign(flags, values_.end());
    fault = check_connectivity(surface_);
    hash = connectivity_hash(surface_, minor_);
  };
  if (topology_changed_)
    beside(int64_t(faces), receive_motion, unpack_connectivity);
  else
    receive_motion();
  if (!fault) fault = check_motion(surface_);
  if (fault) channel_.fail(fault->code, fault->text);
  if (hash != step_.hash) channel_.fail(exit_malformed, "SURFACE: the hash of the connectivity is not that of STEP");
}

void FluidSide::kept(const std::string& file) {
  if (!channel_.leader()) return;
  KeptBlock block{};
  block.window = window_.index;
  std::snprintf(block.file, sizeof block.file, "%s", file.c_str());
  channel_.send(tag_kept, &block, sizeof block);
  channel_.flush();
}

void FluidSide::send(const Loads& loads) {
  const Timed timed("send loads");
  known_.t = loads.t1;
  if (!channel_.leader()) return;
  const LoadBlock load = pack(loads, step_);
  if (const Verdict fault = check_load(load, step_)) channel_.fail(fault->code, fault->text);
  if (const Verdict fault = check_values(loads, surface_)) channel_.fail(fault->code, fault->text);
  channel_.send(tag_load, &load, sizeof load);
  channel_.send(tag_p, std::span<const double>(loads.p));
  if (!loads.traction.empty()) channel_.send(tag_traction, std::span<const Vec3>(loads.traction));
  if (!loads.impedance.empty()) channel_.send(tag_impedance, std::span<const double>(loads.impedance));
  channel_.flush();
  channel_.set_place(window_.index, loads.t1);
}

}  // namespace bw::coupling
