// SPDX-License-Identifier: Apache-2.0
#include "cfd/cut/cells.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/app/error.h"

namespace bw::cfd {

namespace {

constexpr double whole_enough = 0.5;  // cells of less share their content with neighbours

/// Direction across the walls of a cell, into the fluid; zero if they cancel.
Vec3 inward_of(const Vec3& area, const Lattice& lattice) {
  const Vec3& h = lattice.h;
  const Vec3 n{-area.x * h.y * h.z, -area.y * h.z * h.x, -area.z * h.x * h.y};
  return norm(n) > 0 ? unit(n) : Vec3{};
}

}  // namespace

CutCells::CutCells(const Lattice& lattice, const GhostRules& rules, const Index3& block)
    : lattice_(lattice), rules_(rules), block_(block) {
  for (size_t d = 0; d < 3; ++d) blocks_[d] = lattice.n[d] / block[d];
  near_.assign(size_t(blocks_[0]) * size_t(blocks_[1]) * size_t(blocks_[2]), 0);
  row_.assign(size_t(lattice.n[1]) * size_t(lattice.n[2]), 0);
}

bool CutCells::wrap(Index3& c) const {
  for (size_t d = 0; d < 3; ++d) {
    const int n = lattice_.n[d];
    if (c[d] >= 0 && c[d] < n) continue;
    if (rules_[2 * d] != GhostRule::periodic) return false;
    c[d] = (c[d] + n) % n;
  }
  return true;
}

int CutCells::find(Index3 cell) const {
  if (!wrap(cell)) return -2;
  if (!row_[size_t(cell[2]) * size_t(lattice_.n[1]) + size_t(cell[1])]) return -1;
  const auto at = place_.find(key(cell));
  return at == place_.end() ? -1 : at->second;
}

double CutCells::volume(const Index3& cell) const {
  const auto at = volumes_.find(key(cell));
  return at != volumes_.end() ? at->second : begin_.open(cell) ? 1 : 0;
}

template <class Visit>
void CutCells::for_each_around(const Index3& cell, const Visit& visit) const {
  const int r[3] = {lattice_.active(0), lattice_.active(1), lattice_.active(2)};
  for (int k = -r[2]; k <= r[2]; ++k)
    for (int j = -r[1]; j <= r[1]; ++j)
      for (int i = -r[0]; i <= r[0]; ++i)
        if (i || j || k) visit(Index3{cell[0] + i, cell[1] + j, cell[2] + k}, Vec3{double(i), double(j), double(k)});
}

void CutCells::place(const coupling::WetSurface& surface, const std::vector<Vec3>& x) {
  begin_.build(surface, x, std::vector<Vec3>(x.size()), lattice_);
  if (volumes_.empty())
    for (const CutVolume& c : begin_.cells()) volumes_[key(c.cell)] = c.volume;
  x_.clear();
  begin(surface, x, std::vector<Vec3>(x.size()), x, 0);
}

void CutCells::begin(const coupling::WetSurface& surface, const std::vector<Vec3>& x, const std::vector<Vec3>& v,
                     const std::vector<Vec3>& x_end, double dt) {
  const bool still = x == x_end;
  contents_.assign(contents_.size(), Content{});
  if (still && still_ && x == x_) return;
  if (x != x_) begin_.build(surface, x, v, lattice_);
  if (still) {
    mid_ = end_ = begin_;
  } else {
    std::vector<Vec3> middle(x.size());
    for (size_t i = 0; i < x.size(); ++i) middle[i] = 0.5 * (x[i] + x_end[i]);
    mid_.build(surface, middle, v, lattice_);
    end_.build(surface, x_end, v, lattice_);
  }
  check_room(mid_);
  x_ = x, x_end_ = x_end, dt_ = dt;
  still_ = still;
  list();
}

/// Walls that face each other within a cell or two would need two states in a cell, or neighbours that are not there.
void CutCells::check_room(const CutGeometry& g) const {
  const auto fail = [&](const CutVolume& c) {
    const Vec3 x = lattice_.centre(c.cell);
    throw PhysicsError(
        fmt::format("bodies and gaps between walls with treatment = \"cut_cell\" are wider than two cells; near "
                    "({:.6g}, {:.6g}, {:.6g}) m one is not: use finer cells, or "
                    "\"half_riemann\"",
                    x.x, x.y, x.z));
  };
  for (const CutVolume& c : g.cells()) {
    const Vec3 n = inward_of(c.area, lattice_);
    for (int32_t f = c.first; f < c.last; ++f) {
      const Vec3& area = g.facets()[size_t(f)].area;
      if (norm(area) > 1e-4 && dot(inward_of(area, lattice_), n) < -0.5) fail(c);
    }
    if (norm(c.area) < 1e-4) continue;
    size_t d = 0;
    for (size_t e = 1; e < 3; ++e)
      if (std::abs(n[int(e)]) > std::abs(n[int(d)])) d = e;
    for (int by : {-2, -1, 1, 2}) {
      Index3 at = c.cell;
      at[d] += by;
      const CutVolume* other = wrap(at) ? g.find(at) : nullptr;
      if (other && norm(other->area) > 1e-4 && dot(inward_of(other->area, lattice_), n) < -0.8) fail(c);
    }
  }
}

void CutCells::add(const Index3& cell, bool cut) {
  const auto [at, is_new] = place_.emplace(key(cell), int32_t(list_.size()));
  if (is_new) {
    list_.emplace_back();
    list_.back().cell = cell;
  }
  list_[size_t(at->second)].cut |= cut;
}

void CutCells::list() {
  list_.clear();
  place_.clear();
  for (const CutGeometry* g : {&begin_, &mid_, &end_})
    for (const CutVolume& c : g->cells()) add(c.cell, true);
  std::vector<int64_t> kept;
  for (const auto& [k, volume] : volumes_) kept.push_back(k);
  std::sort(kept.begin(), kept.end());
  for (const int64_t k : kept)
    add({int(k % lattice_.n[0]), int(k / lattice_.n[0] % lattice_.n[1]), int(k / lattice_.n[0] / lattice_.n[1])}, true);
  for (size_t i = 0, cut = list_.size(); i < cut; ++i)
    for_each_around(Index3(list_[i].cell), [&](Index3 c, const Vec3&) {
      if (wrap(c)) add(c, false);
    });
  std::sort(list_.begin(), list_.end(), [&](const CutCell& a, const CutCell& b) { return key(a.cell) < key(b.cell); });
  std::fill(near_.begin(), near_.end(), uint8_t(0));
  std::fill(row_.begin(), row_.end(), uint8_t(0));
  for (size_t i = 0; i < list_.size(); ++i) {
    CutCell& c = list_[i];
    place_[key(c.cell)] = int32_t(i);
    row_[size_t(c.cell[2]) * size_t(lattice_.n[1]) + size_t(c.cell[1])] = 1;
    const CutVolume *first = begin_.find(c.cell), *last = end_.find(c.cell);
    c.mid = mid_.find(c.cell);
    c.open_mid = c.mid || mid_.open(c.cell);
    c.volume0 = volume(c.cell);
    c.volume_end = last ? last->volume : end_.open(c.cell) ? 1 : 0;
    c.centroid0 = first ? first->centroid : Vec3{0.5, 0.5, 0.5};
    c.centroid1 = last ? last->centroid : Vec3{0.5, 0.5, 0.5};
    c.inward = last ? inward_of(last->area, lattice_) : Vec3{};
    for (const int by : {-2, 2})
      for (int corner = 0; corner < 8; ++corner) {
        Index3 at = c.cell;
        for (size_t d = 0; d < 3; ++d)
          if (lattice_.active(int(d)) && (corner >> d & 1)) at[d] += by;
        if (wrap(at)) near_[block_number(at)] = 1;
      }
  }
  contents_.assign(list_.size(), Content{});
}

void CutCells::mix(const Comm& comm, const std::function<bool(const double*)>& usable) {
  std::vector<Content> all = contents_;
  if (comm.size() > 1) comm.sum(std::span<double>(all.data()->U, all.size() * sizeof(Content) / sizeof(double)));
  inside_.resize(list_.size());
  for (size_t i = 0; i < list_.size(); ++i) {
    CutCell& c = list_[i];
    std::copy_n(all[i].U, int(GasCons::count), inside_[i].begin());
    c.volume1 = c.volume0;
    if (!c.mid) continue;
    for (int32_t f = c.mid->first; f < c.mid->last; ++f) {
      const CutFacet& part = mid_.facets()[size_t(f)];
      for (int d = 0; d < 3; ++d) c.volume1 += dt_ * part.v[d] * part.area[d] / lattice_.h[d];
    }
  }
  if (!still_) settle();
  choose_groups();
  redistribute(all, usable);
}

/// Volumes that can't stay as they came: cells that closed, are whole again or lost almost all give or take what is
/// over, with the gas in it, to or from the largest cut cell beside them; a whole one without any keeps it.
void CutCells::settle() {
  const auto is_free = [&](const CutCell& c) {
    return norm(c.inward) > 0 && c.volume_end > 1e-6 && c.volume1 > 0.5 * c.volume_end &&
           c.volume1 < 0.5 * (1 + c.volume_end);
  };
  for (size_t i = 0; i < list_.size(); ++i) {
    CutCell& c = list_[i];
    if (!c.cut || is_free(c)) continue;
    const double goal = c.volume_end > 1e-6 ? c.volume_end : 0, lacks = goal - c.volume1;
    if (lacks == 0 && goal > 0) continue;
    int best = -1;
    double most = 0;
    for_each_around(c.cell, [&](const Index3& at, const Vec3& offset) {
      const int n = find(at);
      if (n < 0) return;
      const CutCell& other = list_[size_t(n)];
      if (goal > 0 && c.volume1 > 0.1 && !is_free(other)) return;  // it can wait
      const double size = other.volume1 / dot(offset, offset) * (is_free(other) ? 100 : 1);
      if (other.volume1 > std::max(lacks, 1e-3) && size > most) most = size, best = n;
    });
    if (best < 0) continue;
    CutCell& other = list_[size_t(best)];
    Mean &mine = inside_[i], &its = inside_[size_t(best)];
    for (size_t q = 0; q < mine.size(); ++q) {
      const double moved = goal == 0   ? -mine[q]
                           : lacks > 0 ? lacks * its[q] / other.volume1
                                       : lacks * mine[q] / c.volume1;
      mine[q] += moved, its[q] -= moved;
    }
    c.volume1 = goal, other.volume1 -= lacks;
  }
}

void CutCells::choose_groups() {
  groups_.clear();
  groups_with_.assign(list_.size(), 1);
  for (size_t i = 0; i < list_.size(); ++i) {
    const CutCell& c = list_[i];
    if (!(c.volume1 > 0) || c.volume1 >= whole_enough || norm(c.inward) == 0) continue;
    size_t order[3] = {0, 1, 2};
    std::stable_sort(order, order + 3,
                     [&](size_t a, size_t b) { return std::abs(c.inward[int(a)]) > std::abs(c.inward[int(b)]); });
    std::vector<Member> group{{int32_t(i), {}}};
    double volume = c.volume1;
    for (const size_t d : order) {
      if (!lattice_.active(int(d)) || volume >= whole_enough) continue;
      for (size_t m = 0, before = group.size(); m < before; ++m) {
        Vec3 offset = group[m].offset;
        offset[int(d)] += c.inward[int(d)] >= 0 ? 1 : -1;
        const int n = find({c.cell[0] + int(offset.x), c.cell[1] + int(offset.y), c.cell[2] + int(offset.z)});
        if (n < 0 || !(list_[size_t(n)].volume1 > 0)) continue;
        group.push_back({n, offset});
        volume += list_[size_t(n)].volume1;
      }
    }
    if (group.size() == 1) continue;
    groups_with_[i] = 0;  // not alone
    groups_.push_back(std::move(group));
  }
  for (const auto& group : groups_)
    for (const Member& m : group) ++groups_with_[size_t(m.place)];
}

/// U_j = 1/N_j sum over the neighbourhoods with j of (their mean + their slope (x_j - x)); means weighted by V_j/N_j.
void CutCells::redistribute(const std::vector<Content>& all, const std::function<bool(const double*)>& usable) {
  means_.assign(list_.size(), Mean{});
  std::vector<uint8_t> has_own(list_.size(), 1);
  for (const auto& group : groups_) has_own[size_t(group[0].place)] = 0;
  for (size_t i = 0; i < list_.size(); ++i) {
    const CutCell& c = list_[i];
    means_[i] = Mean{};
    if (!(c.volume1 > 0) || !has_own[i]) continue;
    for (size_t q = 0; q < means_[i].size(); ++q) means_[i][q] = inside_[i][q] / c.volume1 / groups_with_[i];
  }
  for (const auto& group : groups_) {
    double volume = 0;
    Vec3 centre;
    Mean mean{};
    size_t largest = 0;
    for (size_t m = 0; m < group.size(); ++m) {
      const size_t j = size_t(group[m].place);
      const double share = list_[j].volume1 / groups_with_[j];
      volume += share;
      centre += share * (list_[j].centroid1 + group[m].offset);
      for (size_t q = 0; q < mean.size(); ++q) mean[q] += inside_[j][q] / groups_with_[j];
      if (list_[j].volume1 > list_[size_t(group[largest].place)].volume1) largest = m;
    }
    centre = centre / volume;
    for (double& u : mean) u /= volume;
    const Content& from = all[size_t(group[largest].place)];
    std::vector<Mean> at(group.size(), mean);
    bool fine = true;
    for (size_t m = 0; m < group.size(); ++m) {
      const Vec3 x = list_[size_t(group[m].place)].centroid1 + group[m].offset - centre;
      for (size_t q = 0; q < mean.size(); ++q)
        for (int d = 0; d < 3; ++d) at[m][q] += from.slope[d][q] * x[d];
      fine = fine && usable(at[m].data()) && at[m][GasCons::rho] > 0.5 * mean[GasCons::rho];
    }
    for (size_t m = 0; m < group.size(); ++m) {
      const size_t j = size_t(group[m].place);
      for (size_t q = 0; q < mean.size(); ++q) means_[j][q] += (fine ? at[m] : mean)[q] / groups_with_[j];
    }
  }
}

void CutCells::commit() {
  if (still_) return;
  volumes_.clear();
  for (const CutCell& c : list_)
    if (end_.find(c.cell) || c.volume1 != c.volume_end) volumes_[key(c.cell)] = c.volume1;
  begin_ = std::move(end_);
  x_ = x_end_;
}

void CutCells::save(const Saved& to) const {
  std::vector<std::pair<int64_t, double>> kept(volumes_.begin(), volumes_.end());
  std::sort(kept.begin(), kept.end());
  std::vector<int64_t> keys;
  std::vector<double> volumes;
  for (const auto& [k, volume] : kept) keys.push_back(k), volumes.push_back(volume);
  to.same("cut_cells", keys);
  to.same("volumes", volumes);
}

void CutCells::restore(const Restored& from) {
  const std::vector<int64_t> keys = from.same<int64_t>("cut_cells");
  const std::vector<double> volumes = from.same<double>("volumes");
  for (size_t i = 0; i < keys.size(); ++i) volumes_[keys[i]] = volumes[i];
}

}  // namespace bw::cfd
