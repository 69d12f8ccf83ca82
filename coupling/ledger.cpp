// SPDX-License-Identifier: Apache-2.0
#include "coupling/ledger.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "common/app/error.h"
#include "common/parallel/exact_sums.h"

namespace bw::coupling {
namespace {

/// Entries that two lists of distinct ones have in common.
int64_t common_entries(const std::vector<int64_t>& a, const std::vector<int64_t>& b) {
  const auto [a_rest, b_rest] = std::mismatch(a.begin(), a.end(), b.begin(), b.end());
  int64_t count = a_rest - a.begin();
  std::vector<int64_t> rest_of_a(a_rest, a.end()), rest_of_b(b_rest, b.end());  // often none: new faces follow the old
  std::sort(rest_of_a.begin(), rest_of_a.end());
  std::sort(rest_of_b.begin(), rest_of_b.end());
  for (auto x = rest_of_a.begin(), y = rest_of_b.begin(); x != rest_of_a.end() && y != rest_of_b.end();) {
    const bool ahead = *y < *x, behind = *x < *y;
    count += !ahead && !behind;
    x += !ahead, y += !behind;
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
  enum { impulse, moment = 3, work = 6, sums };
  const auto add_node = [&](size_t i, std::array<double, sums>& s) {
    add_at(s, impulse, f[i]), add_at(s, moment, cross(x_window[i], f[i]));
    s[work] += dot(f[i], x_after[i] - x_before[i]);
  };
  const auto sum = exact_sums<sums>(f.size(), add_node);
  return {
      .impulse = h * vector_at(sum, impulse), .moment = h * vector_at(sum, moment), .work = sum[work], .substeps = 1};
}

void Ledger::begin(const WetSurface& surface) {
  surface_ = &surface;
  born_ = dead_ = 0;
  if (first_ || surface.topo_version != topo_version_) {
    if (!first_) {
      const int64_t kept = common_entries(surface.face_id, face_id_);
      born_ = int64_t(surface.face_id.size()) - kept;
      dead_ = int64_t(face_id_.size()) - kept;
    }
    face_id_ = surface.face_id;
    topo_version_ = surface.topo_version;
    first_ = false;
  }
  area_.resize(surface.quads.size()), size_.resize(area_.size()), lever_.resize(area_.size());
  enum { area, moment = 3, size = 6, sums };
  const auto add_face = [&](size_t f, std::array<double, sums>& s) {
    area_[f] = area_vector(surface.x, surface.quads[f]);
    const Vec3 centre = face_mean(surface.x, surface.quads[f]);
    size_[f] = norm(area_[f]), lever_[f] = norm(centre);
    add_at(s, area, area_[f]), add_at(s, moment, cross(centre, area_[f]));
    s[size] += size_[f];
  };
  const int64_t alone = std::numeric_limits<int64_t>::max();  // the other cores are the fluid's, which receives
  const auto sum = exact_sums<sums>(area_.size(), add_face, alone);
  area_sum_ = vector_at(sum, area), moment_sum_ = vector_at(sum, moment), size_sum_ = sum[size];
}

void Ledger::open(const Window& window, const Loads& loads) {
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
  row_.born = born_, row_.dead = dead_;
  const double dt = loads.t1 - window.t0;
  enum { scale, lever, sums };
  const auto sum = exact_sums<sums>(area_.size(), [&](size_t f, std::array<double, sums>& s) {
    double force = std::abs(loads.p[f]) * size_[f];
    if (!loads.traction.empty()) force += norm(loads.traction[f]) * size_[f];
    s[scale] += force, s[lever] += force * lever_[f];
  });
  row_.area = size_sum_;
  row_.impulse_scale = sum[scale] * dt;
  row_.moment_scale = sum[lever] * dt;
  reference_impulse_ = (p_ref_ * dt) * area_sum_;
  reference_moment_ = (p_ref_ * dt) * moment_sum_;
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
    const std::vector<Vec3>&x = surface_->x, &v = surface_->v;
    BW_CHECK(x_end.size() == x.size());
    std::vector<Vec3> gap(x.size());  // beyond where the announced velocity took the fluid's wall
    const double dt = row_.t1 - row_.t0;
    for (size_t i = 0; i < gap.size(); ++i) gap[i] = x_end[i] - (x[i] + dt * v[i]);
    const auto add_face = [&](size_t f, std::array<double, 1>& s) {
      s[0] += dot(area_[f], face_mean(gap, surface_->quads[f]));
    };
    row_.volume_gap = exact_sums<1>(area_.size(), add_face)[0];
  }
  const double defect = norm(row_.impulse_defect);
  // a fluid that counts its own step instead of t1 - t0 is off by the rounding of t1: no loss
  const double dt = row_.t1 - row_.t0, epsilon = 4 * std::numeric_limits<double>::epsilon();
  const double rounding = epsilon * row_.t1 / dt;
  add_to_sums(tolerance_ + rounding);
  const double reference = epsilon * std::abs(p_ref_) * row_.area * dt;  // each side adds it up in its own order
  if (defect <= (tolerance_ + rounding) * row_.impulse_scale + reference) return {};
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
