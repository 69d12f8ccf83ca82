// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/walls.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cfd/embed/scan.h"
#include "common/parallel/loop.h"

namespace bw::cfd {

Walls::Walls(const Lattice& lattice, const GhostRules& rules, const std::array<int, 3>& block, double p_ref,
             const WallOptions& options)
    : lattice_(lattice), rules_(rules), block_(block), p_ref_(p_ref), options_(options) {
  for (size_t d = 0; d < 3; ++d) blocks_[d] = lattice.n[d] / block[d];
  map_.clear(lattice);
  if (options.treatment == WallTreatment::cut_cell) cut_.emplace(lattice, rules, block);
}

size_t Walls::block_number(const Index3& c) const {
  return (size_t(c[2] / block_[2]) * size_t(blocks_[1]) + size_t(c[1] / block_[1])) * size_t(blocks_[0]) +
         size_t(c[0] / block_[0]);
}

void Walls::begin(const coupling::WetSurface& surface, const std::vector<Vec3>& x, const std::vector<Vec3>& v) {
  changes_ = {};
  if (conservative()) sent_x_ = surface.x;
  const bool same = placed_ && surface.topo_version == surface_.topo_version && x.size() == surface_.x.size();
  if (same && x == surface_.x) {
    if (v != surface_.v) {
      surface_.v = v;
      update_velocities(surface_, map_);
      const auto renew_probe = [&](int64_t i) {
        Probe& p = probes_[size_t(i)];
        p.v = coupling::face_mean(v, surface_.quads[size_t(p.face)]);
      };
      if (probes_current_) parallel_for(int64_t(probes_.size()), renew_probe);
    }
  } else {
    std::vector<Vec3> before = x;  // where the nodes were, or their ancestors
    if (same) {
      before = std::move(surface_.x);
    } else {
      coupling::NodePlaces now(surface);
      std::vector<Vec3> v_last = v_last_.empty() ? v_last_ : v;
      for (size_t i = 0; i < x.size() && placed_; ++i)
        if (const int64_t old = places_.find_or_ancestor(surface, i, now); old >= 0) {
          before[i] = surface_.x[size_t(old)];
          if (!v_last.empty()) v_last[i] = v_last_[size_t(old)];
        }
      v_last_ = std::move(v_last);
      surface_ = surface;
      places_ = std::move(now);
      lips_.pair(surface_);
    }
    surface_.x = x;
    surface_.v = v;
    rescan(placed_ ? &before : nullptr);
  }
  if (cut_ && !placed_) cut_->place(surface_, x);
  placed_ = true;
  if (!probes_current_) place_probes();
  values_.assign(2 * probes_.size(), 0.0);
}

void Walls::set_step(double dt, const std::vector<Vec3>& x_end) {
  dt_ = dt;
  if (cut_) cut_->begin(surface_, surface_.x, surface_.v, x_end, dt);
  if (options_.treatment != WallTreatment::mirror || v_last_.empty()) return;
  std::vector<Vec3> a(surface_.v.size());
  for (size_t i = 0; i < a.size(); ++i) a[i] = (surface_.v[i] - v_last_[i]) * (2 / (dt + dt_last_));
  update_accelerations(surface_, a, map_);
}

void Walls::place_probes() {
  find_probes(surface_, map_, size_t(blocks_[0]) * size_t(blocks_[1]) * size_t(blocks_[2]),
              [&](const Index3& c) { return block_number(c); }, probes_, first_probe_);
  probes_current_ = true;
}

void Walls::end(const std::vector<Vec3>& x_end) {
  changes_ = {};
  if (options_.treatment == WallTreatment::mirror && dt_ > 0) v_last_ = surface_.v, dt_last_ = dt_;
  if (x_end == surface_.x) return;
  const std::vector<Vec3> before = std::move(surface_.x);
  surface_.x = x_end;
  rescan(&before);
}

void Walls::rescan(const std::vector<Vec3>* x_before) {
  probes_current_ = false;
  scan(surface_, lattice_, map_now_);
  if (options_.slits != Slits::centre) find_apertures(surface_, options_.slits, map_now_);
  if (x_before) changes_ = compare(map_, map_now_, swept_cells(surface_, *x_before, lattice_));
  std::swap(map_, map_now_);
}

void Walls::accept(int layer) {
  for (const FreshCell& f : changes_.fresh)
    if (f.layer == layer) map_.drop_flag(f.cell, cell_fresh);
}

double Walls::largest_step() const {
  double rate = 0;
  for (const Vec3& v : surface_.v)
    for (int d = 0; d < 3; ++d)
      if (lattice_.active(d)) rate = std::max(rate, std::abs(v[d]) / lattice_.h[d]);
  return rate > 0 ? 0.5 / rate : std::numeric_limits<double>::max();
}

bool Walls::near(const Index3& first) const {
  const Range r = probes_of(first);
  if (r.first != r.last) return true;
  Index3 lower = first, upper;
  for (size_t d = 0; d < 3; ++d) {
    const int ghost = lattice_.active(int(d)) ? ghost_layers : 0;
    upper[d] = first[d] + block_[d] + ghost;
    lower[d] -= ghost;
    // ghosts from the other end of a periodic domain: not worth a closer look
    if (rules_[2 * d] == GhostRule::periodic && (lower[d] < 0 || upper[d] > lattice_.n[d]))
      return map_.link_count() > 0;
  }
  return map_.touches(lower, upper);
}

Walls::Range Walls::probes_of(const Index3& first) const {
  if (first_probe_.empty()) return {0, 0};
  const size_t b = block_number(first);
  return {first_probe_[b], first_probe_[b + 1]};
}

void Walls::set_links(const std::vector<LinkLoad>& links, double dt) {
  const size_t faces = surface_.quads.size();
  face_forces_.met.assign(faces, 0);
  face_forces_.force.assign(faces, {});
  face_forces_.moment.assign(faces, {});
  face_forces_.rho_c_area.assign(faces, 0.0);
  for (const LinkLoad& l : links) {
    if (l.face < 0) continue;
    const size_t f = size_t(l.face);
    const Vec3 force = (l.impulse - p_ref_ * l.area_time) / dt;
    face_forces_.met[f] = 1;
    face_forces_.force[f] += force;
    face_forces_.moment[f] += cross(l.at, force);
    face_forces_.rho_c_area[f] += l.rho_c * norm(l.area_time) / dt;
  }
}

Vec3 Walls::area_at_middle(int32_t face) const {
  const std::array<int32_t, 4>& q = surface_.quads[size_t(face)];
  std::vector<Vec3> x;
  for (const int32_t node : q) x.push_back(surface_.x[size_t(node)] + 0.5 * dt_ * surface_.v[size_t(node)]);
  return coupling::area_vector(x, {0, 1, 2, 3});
}

coupling::Loads Walls::loads() {
  coupling::Loads r;
  const size_t faces = surface_.quads.size();
  std::vector<double> p[2];
  for (auto& side : p) side.assign(faces, p_ref_);
  r.impedance.assign(faces, 0.0);
  std::vector<uint8_t> wet(faces, 0);
  for (size_t i = 0; i < probes_.size(); ++i) {
    const size_t f = size_t(probes_[i].face);
    p[probes_[i].side < 0][f] = values_[2 * i];
    r.impedance[f] += values_[2 * i + 1];
    wet[f] = 1;
  }
  double h = std::numeric_limits<double>::max();
  for (int d = 0; d < 3; ++d)
    if (lattice_.active(d)) h = std::min(h, lattice_.h[d]);
  lip_force_ = {};
  r.p.resize(faces);
  if (conservative()) r.traction.assign(faces, {});
  for (size_t f = 0; f < faces; ++f) {
    const bool thin = !surface_.flags.empty() && surface_.flags[f] & coupling::face_thin;
    r.p[f] = thin ? p_ref_ + p[0][f] - p[1][f] : p[0][f];
    const Vec3 area = coupling::area_vector(surface_.x, surface_.quads[f]);
    if (cut_ && face_forces_.met[f]) {  // facets have pressures of their own
      wet[f] = 1;
      r.p[f] = p_ref_ - dot(face_forces_.force[f], area) / std::max(dot(area, area), 1e-300);
    }
    if (!wet[f]) {
      ++r.totals.dry_faces;
      r.totals.dry_area += norm(area);
    } else if (!conservative() && !surface_.flags.empty() && surface_.flags[f] & coupling::face_lip) {
      const double aperture = lips_.aperture(surface_, int32_t(f)), full = r.p[f];
      const double first = first_aperture_.emplace(surface_.face_id[f], std::max(aperture, 0.0)).first->second;
      const double open = aperture < Lips::apart ? std::clamp(2 * (aperture - first) / h, 0.0, 1.0) : 1.0;
      r.p[f] = p_ref_ + open * (full - p_ref_);
      r.impedance[f] *= open;
      lip_force_ += (r.p[f] - full) * area;
    }
    if (!conservative() || !(wet[f] || face_forces_.met[f])) continue;
    const Vec3 sent = coupling::area_vector(sent_x_, surface_.quads[f]);
    Vec3 force = face_forces_.force[f];
    if (cut_) force -= p_ref_ * (area_at_middle(int32_t(f)) - sent);  // facets are those of mid-step
    if (const double size = norm(sent); size > 0) r.traction[f] = (force + (r.p[f] - p_ref_) * sent) / size;
  }
  return r;
}

void Walls::save(const Saved& to) const {
  to.same("x", surface_.x);
  to.same("v", surface_.v);
  std::vector<std::array<int32_t, 4>> cells;
  CutMap::for_each_difference(map_, map_, [&](const Index3& c) {
    if (const int flags = map_.flags(c) & (cell_sealed | cell_fresh)) cells.push_back({c[0], c[1], c[2], flags});
  });
  to.same("cells", cells);
  std::vector<std::pair<int64_t, double>> apertures(first_aperture_.begin(), first_aperture_.end());
  std::sort(apertures.begin(), apertures.end());
  std::vector<int64_t> faces;
  std::vector<double> first;
  for (const auto& [face, aperture] : apertures) faces.push_back(face), first.push_back(aperture);
  to.same("lips", faces);
  to.same("apertures", first);
  if (options_.treatment == WallTreatment::mirror) to.same("v_last", v_last_), to.number("dt_last", dt_last_);
  if (cut_) cut_->save(to);
}

void Walls::restore(const Restored& from, const coupling::WetSurface& surface) {
  if (cut_) cut_->restore(from);
  begin(surface, from.same<Vec3>("x"), from.same<Vec3>("v"));
  for (const std::array<int32_t, 4>& c : from.same<std::array<int32_t, 4>>("cells")) {
    map_.set_flag({c[0], c[1], c[2]}, uint8_t(c[3]));
    if (c[3] & cell_sealed) map_.note_orphans();
  }
  const std::vector<int64_t> faces = from.same<int64_t>("lips");
  const std::vector<double> first = from.same<double>("apertures");
  first_aperture_.clear();
  for (size_t i = 0; i < faces.size(); ++i) first_aperture_.emplace(faces[i], first[i]);
  if (options_.treatment == WallTreatment::mirror)
    v_last_ = from.same<Vec3>("v_last"), dt_last_ = from.number<double>("dt_last");
  probes_current_ = false;
}

}  // namespace bw::cfd
