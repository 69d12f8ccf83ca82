// SPDX-License-Identifier: Apache-2.0
#include "coupling/ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "common/app/error.h"
#include "common/math/sum.h"

namespace bw::coupling {
namespace {

/// Entries of the sorted list a that the sorted list b lacks.
int64_t missing_in(const std::vector<int64_t>& a, const std::vector<int64_t>& b) {
  int64_t count = 0;
  auto at = b.begin();
  for (const int64_t id : a) {
    while (at != b.end() && *at < id) ++at;
    count += at == b.end() || *at != id;
  }
  return count;
}

}  // namespace

SolidTotals& SolidTotals::operator+=(const SolidTotals& b) {
  impulse += b.impulse;
  moment += b.moment;
  work += b.work;
  substeps += b.substeps;
  return *this;
}

SolidTotals substep_totals(std::span<const Vec3> f, std::span<const Vec3> x_window, std::span<const Vec3> x_before,
                           std::span<const Vec3> x_after, double h) {
  ExactSum3 impulses, moments;
  ExactSum work;
  for (size_t i = 0; i < f.size(); ++i) {
    const Vec3 impulse = h * f[i];
    impulses += impulse;
    moments += cross(x_window[i], impulse);
    work += dot(f[i], x_after[i] - x_before[i]);
  }
  return {.impulse = impulses.value(), .moment = moments.value(), .work = work.value(), .substeps = 1};
}

void Ledger::open(const Window& window, const WetSurface& surface, const Loads& loads) {
  const double work_fluid_sum = row_.work_fluid_sum, work_solid_sum = row_.work_solid_sum;
  const Vec3 advance = row_.advance;
  row_ = LedgerRow{};  // the sums go on
  row_.advance = advance;
  row_.work_fluid_sum = work_fluid_sum;
  row_.work_solid_sum = work_solid_sum;
  row_.window = window.index;
  row_.t0 = window.t0;
  row_.t1 = loads.t1;
  row_.fluid = loads.totals;
  if (first_ || surface.topo_version != topo_version_) {
    quads_ = surface.quads;
    std::vector<int64_t> face_id = surface.face_id;
    if (!std::is_sorted(face_id.begin(), face_id.end())) std::sort(face_id.begin(), face_id.end());
    if (!first_) {
      row_.born = missing_in(face_id, face_id_);
      row_.dead = missing_in(face_id_, face_id);
    }
    face_id_ = std::move(face_id);
    topo_version_ = surface.topo_version;
    first_ = false;
  }
  const double dt = loads.t1 - window.t0;
  area_.resize(quads_.size());
  ExactSum3 area_sum, moment_sum;
  ExactSum area, scale, moment_scale;
  for (size_t begin = 0; begin < quads_.size(); begin += terms_at_once) {
    Vec3 areas, moments;
    double sizes = 0, forces = 0, levers = 0;
    for (size_t f = begin; f < std::min(begin + terms_at_once, quads_.size()); ++f) {
      area_[f] = area_vector(surface.x, quads_[f]);
      const Vec3 centre = face_mean(surface.x, quads_[f]);
      const double size = norm(area_[f]);
      double force = std::abs(loads.p[f]) * size;
      if (!loads.traction.empty()) force += norm(loads.traction[f]) * size;
      areas += area_[f], moments += cross(centre, area_[f]);
      sizes += size, forces += force, levers += force * norm(centre);
    }
    area_sum += areas, moment_sum += moments;
    area += sizes, scale += forces * dt, moment_scale += levers * dt;
  }
  row_.area = area.value();
  row_.impulse_scale = scale.value();
  row_.moment_scale = moment_scale.value();
  reference_impulse_ = (p_ref_ * dt) * area_sum.value();
  reference_moment_ = (p_ref_ * dt) * moment_sum.value();
  x_wall_.resize(surface.x.size());
  for (size_t i = 0; i < x_wall_.size(); ++i) x_wall_[i] = surface.x[i] + dt * surface.v[i];
}

void Ledger::add_to_sums(double tolerance) {
  if (sums_.windows == 0) sums_.mass_first = row_.fluid.mass;
  ++sums_.windows, sums_.born += row_.born, sums_.dead += row_.dead;
  sums_.dry_most = std::max(sums_.dry_most, row_.fluid.dry_faces);
  sums_.impulse_fluid += row_.fluid.impulse + reference_impulse_, sums_.impulse_solid += row_.solid.impulse;
  sums_.moment_fluid += row_.fluid.moment + reference_moment_, sums_.moment_solid += row_.solid.moment;
  const auto larger = [](double& most, double defect, double scale) {
    if (scale > 0) most = std::max(most, defect / scale);
  };
  larger(sums_.impulse_defect, norm(row_.impulse_defect), row_.impulse_scale);
  larger(sums_.moment_defect, norm(row_.moment_defect), row_.moment_scale);
  sums_.moments_lost += norm(row_.moment_defect) > tolerance * row_.moment_scale;
  sums_.gap_most = std::max(sums_.gap_most, std::abs(row_.volume_gap));
}

std::optional<std::string> Ledger::close(std::span<const Vec3> x_end) {
  row_.impulse_defect = row_.solid.impulse - (row_.fluid.impulse + reference_impulse_);
  row_.moment_defect = row_.solid.moment - (row_.fluid.moment + reference_moment_);
  row_.work_fluid = row_.fluid.work + p_ref_ * row_.fluid.swept;
  row_.work_fluid_sum += row_.work_fluid;
  row_.work_solid_sum += row_.solid.work;
  if (!x_end.empty()) {
    BW_CHECK(x_end.size() == x_wall_.size());
    std::vector<Vec3> gap(x_wall_.size());
    for (size_t i = 0; i < gap.size(); ++i) gap[i] = x_end[i] - x_wall_[i];
    for (size_t f = 0; f < quads_.size(); ++f) row_.volume_gap += dot(area_[f], face_mean(gap, quads_[f]));
  }
  const double defect = norm(row_.impulse_defect);
  // a fluid that counts its own step instead of t1 - t0 is off by the rounding of t1: no loss
  const double rounding = 4 * std::numeric_limits<double>::epsilon() * row_.t1 / (row_.t1 - row_.t0);
  add_to_sums(tolerance_ + rounding);
  if (defect <= (tolerance_ + rounding) * row_.impulse_scale) return {};
  return fmt::format(
      "ledger: in window {} the solid received an impulse of ({:.15g}, {:.15g}, {:.15g}) N s, the fluid gave ({:.15g}, "
      "{:.15g}, "
      "{:.15g}) N s beyond the reference pressure; the defect {:.3g} N s is more than {:g} of sum |P A| dt = {:.6g} N "
      "s",
      row_.window, row_.solid.impulse.x, row_.solid.impulse.y, row_.solid.impulse.z,
      row_.fluid.impulse.x + reference_impulse_.x, row_.fluid.impulse.y + reference_impulse_.y,
      row_.fluid.impulse.z + reference_impulse_.z, defect, tolerance_, row_.impulse_scale);
}

}  // namespace bw::coupling
