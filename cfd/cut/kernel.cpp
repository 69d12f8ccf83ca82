// SPDX-License-Identifier: Apache-2.0
#include "cfd/cut/kernel.h"

#include <algorithm>
#include <cmath>

#include "cfd/scheme/beside_walls.h"

namespace bw::cfd {

namespace {

constexpr double empty = 1e-9;        // volumes below hold no gas to speak of
constexpr double least_open = 1e-12;  // apertures

/// Solves the symmetric A x = b of m unknowns in place; unknowns that the data leave open become 0.
void solve(double (&A)[3][3], double (&b)[3][CutCellKernel::n], int m) {
  double scale = 0;
  for (int i = 0; i < m; ++i) scale = std::max(scale, A[i][i]);
  bool known[3] = {};
  for (int i = 0; i < m; ++i) {
    known[i] = A[i][i] > 1e-3 * scale;
    if (!known[i]) continue;
    for (int k = i + 1; k < m; ++k) {
      const double f = A[k][i] / A[i][i];
      for (int l = i; l < m; ++l) A[k][l] -= f * A[i][l];
      for (int q = 0; q < CutCellKernel::n; ++q) b[k][q] -= f * b[i][q];
    }
  }
  for (int i = m - 1; i >= 0; --i)
    for (int q = 0; q < CutCellKernel::n; ++q) {
      for (int l = i + 1; l < m; ++l) b[i][q] -= A[i][l] * b[l][q];
      b[i][q] = known[i] ? b[i][q] / A[i][i] : 0;
    }
}

/// A connected neighbour along the grid.
struct Beside {
  Vec3 away;  // centroid to centroid, in cells
  double differs[CutCellKernel::n];
  bool is_there = false;
};

/// Along each direction not more than twice what leads to either neighbour, and nothing where these disagree.
void limit(const Beside (&beside)[3][2], double (&slope)[3][CutCellKernel::n]) {
  double limited[3][CutCellKernel::n];
  for (int d = 0; d < 3; ++d)
    for (int q = 0; q < CutCellKernel::n; ++q) {
      double s = slope[d][q];
      for (const Beside& known : beside[d]) {
        if (!known.is_there) continue;
        double differs = known.differs[q];
        for (int e = 0; e < 3; ++e)
          if (e != d) differs -= slope[e][q] * known.away[e];
        const double most = 2 * differs / known.away[d];
        s = s > 0 ? std::clamp(most, 0.0, s) : std::clamp(most, s, 0.0);
      }
      limited[d][q] = s;
    }
  for (int d = 0; d < 3; ++d) std::copy_n(limited[d], CutCellKernel::n, slope[d]);
}

}  // namespace

CutCellKernel::CutCellKernel(const BlockShape& shape) : shape_(shape) {
  for (int d = 0; d < 3; ++d) g_[d] = shape.ghost(d), e_[d] = shape.n[size_t(d)] + 2 * g_[d];
  step_[0] = 1, step_[1] = e_[0], step_[2] = e_[0] * e_[1];
}

double CutCellKernel::volume(const Cell& x) const {
  const CutCell* c = listed(x);
  return c ? c->volume0 : slot_[size_t(x.c)] == plain ? 1 : 0;
}

/// Open part, at mid-step, of the face above cell `low`.
double CutCellKernel::open(const Cell& low, int d) const {
  const CutCell *a = listed(low), *b = listed(moved(low, d, 1));
  if (a && a->mid) return a->mid->open[d][1];
  if (b && b->mid) return b->mid->open[d][0];
  if (a) return a->open_mid;
  if (b) return b->open_mid;
  return slot_[size_t(low.c)] == plain || slot_[size_t(low.c) + size_t(step_[d])] == plain;
}

bool CutCellKernel::in_patch(const Cell& x, int margin) const {
  for (int d = 0; d < 3; ++d)
    if (shape_.used[size_t(d)] &&
        (x.at[size_t(d)] < margin - g_[d] || x.at[size_t(d)] >= shape_.n[size_t(d)] + g_[d] - margin))
      return false;
  return true;
}

void CutCellKernel::look_up(const Index3& first_cell) {
  slot_.resize(size_t(e_[0]) * size_t(e_[1]) * size_t(e_[2]));
  for (int k = -g_[2]; k < shape_.n[2] + g_[2]; ++k)
    for (int j = -g_[1]; j < shape_.n[1] + g_[1]; ++j) {
      int32_t before = beyond;  // cells side by side that are not listed are all open or all closed
      for (int i = -g_[0]; i < shape_.n[0] + g_[0]; ++i) {
        const Index3 c{first_cell[0] + i, first_cell[1] + j, first_cell[2] + k};
        int32_t& slot = slot_[size_t(cell_at(k, j, i).c)];
        slot = cells_->find(c);
        if (slot == plain)
          slot = before == plain || before == closed ? before : cells_->closed(c) ? int32_t(closed) : int32_t(plain);
        before = slot;
      }
    }
}

/// Cells without gas, and those whose neighbours along the grid can't make their slopes.
void CutCellKernel::mark() {
  special_.assign(slot_.size(), 0);
  const auto odd = [&](const Cell& x) {
    const CutCell* c = listed(x);
    return slot_[size_t(x.c)] == closed || (c && (c->cut || !(c->volume0 > 0)));
  };
  for (int k = -g_[2] / 2; k < shape_.n[2] + g_[2] / 2; ++k)
    for (int j = -g_[1] / 2; j < shape_.n[1] + g_[1] / 2; ++j)
      for (int i = -g_[0] / 2; i < shape_.n[0] + g_[0] / 2; ++i) {
        const Cell x = cell_at(k, j, i);
        bool is = odd(x);
        for (int d = 0; d < 3 && !is; ++d)
          if (shape_.used[size_t(d)]) is = odd(moved(x, d, -1)) || odd(moved(x, d, 1));
        special_[size_t(x.c)] = is;
      }
}

void CutCellKernel::slopes_on_grid(const Cell& x, Predicted& r) const {
  for (int d = 0; d < 3; ++d)
    for (int q = 0; q < n; ++q) {
      const double *w = row_[q] + x.p, step_low = shape_.used[size_t(d)] ? w[0] - w[-stride_[d]] : 0,
                   step_high = shape_.used[size_t(d)] ? w[stride_[d]] - w[0] : 0;
      r.slope[d][q] = MonotonizedCentral::slope(step_low, step_high);
    }
}

void CutCellKernel::slopes_of_squares(const Cell& x, Predicted& r) const {
  for (auto& slope : r.slope) std::fill(slope, slope + n, 0.0);
  if (!(volume(x) > 0) || !in_patch(x, 1)) return;
  const State own = read(x);
  Beside beside[3][2];
  double A[3][3] = {}, b[3][n] = {};
  int used[3], m = 0;
  for (int d = 0; d < 3; ++d)
    if (shape_.used[size_t(d)]) used[m++] = d;
  // cells that open faces lead to, on the shortest way in any order of directions
  const auto opens = [&](const Cell& from, int d, int by) {
    return open(by > 0 ? from : moved(from, d, -1), d) > least_open;
  };
  const auto reached = [&](const auto& self, const Cell& from, const int(&by)[3]) -> bool {
    bool arrived = true;
    for (int d = 0; d < 3; ++d) {
      if (!by[d]) continue;
      arrived = false;
      int rest[3] = {by[0], by[1], by[2]};
      rest[d] = 0;
      if (opens(from, d, by[d]) && self(self, moved(from, d, by[d]), rest)) return true;
    }
    return arrived;
  };
  for (int k = -int(shape_.used[2]); k <= int(shape_.used[2]); ++k)
    for (int j = -int(shape_.used[1]); j <= int(shape_.used[1]); ++j)
      for (int i = -int(shape_.used[0]); i <= int(shape_.used[0]); ++i) {
        const int by[3] = {i, j, k}, steps = std::abs(i) + std::abs(j) + std::abs(k);
        if (steps == 0) continue;
        const Cell y = cell_at(x.at[2] + k, x.at[1] + j, x.at[0] + i);
        const CutCell* other = listed(y);
        const double share = volume(y);
        if (slot_[size_t(y.c)] == beyond || !(share > empty) || !reached(reached, x, by)) continue;
        const Vec3 at = other ? other->centroid0 : Vec3{0.5, 0.5, 0.5};
        const Vec3 away = at + Vec3{double(i), double(j), double(k)} - r.centre;
        const double square = dot(away, away);
        if (square < 1e-4) continue;
        const double weight = std::min(share, 1.0) / square;
        const State w = read(y);
        for (int a = 0; a < m; ++a) {
          for (int c = 0; c < m; ++c) A[a][c] += weight * away[used[a]] * away[used[c]];
          for (int q = 0; q < n; ++q) b[a][q] += weight * away[used[a]] * (w[size_t(q)] - own[size_t(q)]);
        }
        if (steps == 1)
          for (int d = 0; d < 3; ++d)
            if (by[d]) {
              Beside& known = beside[d][by[d] > 0];
              known.away = away, known.is_there = std::abs(away[d]) > 0.2;
              for (int q = 0; q < n; ++q) known.differs[q] = w[size_t(q)] - own[size_t(q)];
            }
      }
  solve(A, b, m);
  for (int a = 0; a < m; ++a)
    for (int q = 0; q < n; ++q) r.slope[used[a]][q] = b[a][q];
  limit(beside, r.slope);
}

/// A cell that held no gas yet: the line of the nearest connected cell that does.
bool CutCellKernel::borrow(const Cell& x, Predicted& r) const {
  double most = 0;
  for (int d = 0; d < 3; ++d)
    for (int by = -1; by <= 1; by += 2) {
      if (!shape_.used[size_t(d)]) continue;
      const Cell y = moved(x, d, by);
      if (!in_patch(y, 0) || slot_[size_t(y.c)] == beyond || !(volume(y) > empty)) continue;
      const double size = std::min(volume(y), 1.0) * open(by > 0 ? x : y, d);
      if (!(size > most)) continue;
      most = size;
      const CutCell* other = listed(y);
      r.centre = other ? other->centroid0 : Vec3{0.5, 0.5, 0.5};
      slopes_of_squares(y, r);
      r.centre[d] += by;
      r.half = read(y);
      double half[n];
      for (int q = 0; q < n; ++q) half[q] = r.half[size_t(q)];
      GasFlow::predict(half, r.slope, half_lambda_, patch_->row(Prim::rho_c2, 0, 0)[y.p], 0.0);
      for (int q = 0; q < n; ++q) r.half[size_t(q)] = half[q];
    }
  return most > 0;
}

const CutCellKernel::Predicted& CutCellKernel::predicted(const Cell& x) {
  if (const int32_t s = known_[size_t(x.c)]; s >= 0) return predicted_[size_t(s)];
  known_[size_t(x.c)] = int32_t(predicted_.size());
  Predicted r;
  const CutCell* c = listed(x);
  r.centre = c ? c->centroid0 : Vec3{0.5, 0.5, 0.5};
  r.half = read(x);
  r.special = special_[size_t(x.c)];
  State mean = r.half;
  if (volume(x) <= empty && slot_[size_t(x.c)] != beyond && special_[size_t(x.c)]) {
    if (borrow(x, r)) mean = r.half;
  } else {
    if (special_[size_t(x.c)])
      slopes_of_squares(x, r);
    else
      slopes_on_grid(x, r);
    double half[n];
    std::copy(mean.begin(), mean.end(), half);
    GasFlow::predict(half, r.slope, half_lambda_, patch_->row(Prim::rho_c2, 0, 0)[x.p], 0.0);
    std::copy(half, half + n, r.half.begin());
  }
  double half[n], mean_w[n];
  std::copy(r.half.begin(), r.half.end(), half);
  std::copy(mean.begin(), mean.end(), mean_w);
  limit_cell(*patch_, x.p, *flow_, mean_w, half, r.slope);
  std::copy(half, half + n, r.half.begin());
  predicted_.push_back(r);
  return predicted_.back();
}

CutCellKernel::State CutCellKernel::on_lines(const Predicted& own, const Vec3& at) const {
  State w = own.half;
  for (int d = 0; d < 3; ++d)
    for (int q = 0; q < n; ++q) w[size_t(q)] += own.slope[d][q] * (at[d] - own.centre[d]);
  const bool gas = !own.special || (w[Gas::p] > 0.2 * own.half[Gas::p] && w[0] > 0.2 * own.half[0]);
  return gas ? w : own.half;
}

/// Flux dt/h through the face between two cells, times its open part; upper: `high` is the one beyond the block, if one
/// is.
CutCellKernel::Flux CutCellKernel::face(const Cell& low, const Cell& high, int d, bool upper) {
  Flux F{};
  const double part = open(low, d);
  if (!(part > least_open)) return F;
  const CutCell *a = listed(low), *b = listed(high);
  Vec3 at{0.5, 0.5, 0.5};
  at[d] = 1;
  if (a && a->mid)
    at = a->mid->face_at[d][1];
  else if (b && b->mid)
    at = b->mid->face_at[d][0], at[d] = 1;
  Vec3 from_high = at;
  from_high[d] = 0;
  State L, R;
  const bool special = special_[size_t(low.c)] || special_[size_t(high.c)];
  const Cell& outer = upper ? high : low;
  if (slot_[size_t(outer.c)] == beyond && special) {
    State inner = upper ? on_lines(predicted(low), at) : on_lines(predicted(high), from_high), other = read(outer);
    if (rules_[size_t(2 * d + upper)] == GhostRule::mirror)
      other = inner, other[size_t(Gas::v + d)] = -inner[size_t(Gas::v + d)];
    L = upper ? inner : other, R = upper ? other : inner;
  } else {
    L = on_lines(predicted(low), at);
    R = on_lines(predicted(high), from_high);
  }
  double l[n], r[n], f[GasCons::count] = {};
  std::copy(L.begin(), L.end(), l), std::copy(R.begin(), R.end(), r);
  const auto sound = [&](const Cell& x, const State& w) {  // a cell that held nothing has no speed of its own
    const double c = patch_->row(Prim::c, 0, 0)[x.p];
    return volume(x) > empty || slot_[size_t(x.c)] == beyond ? c : std::sqrt(gas_->stiffness(w) / w[0]);
  };
  const Sound<double> low_c{sound(low, L), 0}, high_c{sound(high, R), 0};
  if (d == 0) flow_->flux<0>(l, r, low_c, high_c, f);
  if (d == 1) flow_->flux<1>(l, r, low_c, high_c, f);
  if (d == 2) flow_->flux<2>(l, r, low_c, high_c, f);
  if (patch_->shocked && !special) {
    const double* shock = patch_->row(Prim::shock, 0, 0);
    const double in_shock = std::max(shock[low.p], shock[high.p]), c = std::max(low_c.c, high_c.c);
    if (in_shock > 0) {
      if (d == 0) damp_along_shock<0, GasFlow>(l, r, c, in_shock, f);
      if (d == 1) damp_along_shock<1, GasFlow>(l, r, c, in_shock, f);
      if (d == 2) damp_along_shock<2, GasFlow>(l, r, c, in_shock, f);
    }
  }
  for (size_t q = 0; q < F.size(); ++q) F[q] = part * lambda_[d] * f[q];
  return F;
}

/// The facets' part of a listed cell's sum, and its content and slopes.
void CutCellKernel::finish(const Cell& x, const double* U, const Flux& sum, const GasFlow& flow) {
  const size_t place = size_t(slot_[size_t(x.c)]);
  const CutCell& c = cells_->cells()[place];
  CutCells::Content& content = cells_->contents()[place];
  const size_t cells = size_t(shape_.cells()), at = shape_.at(x.at[2], x.at[1], x.at[0]);
  for (size_t q = 0; q < sum.size(); ++q)
    content.U[q] = (c.volume0 > 0 ? c.volume0 * U[size_t(flow.cons_row(int(q))) * cells + at] : 0) + sum[q];
  const Predicted own = predicted(x);
  const Vec3 h = shape_.h, face{h.y * h.z, h.z * h.x, h.x * h.y};
  if (c.mid)
    for (int32_t f = c.mid->first; f < c.mid->last; ++f) {
      const CutFacet& part = cells_->facets()[size_t(f)];
      Vec3 area;
      for (int d = 0; d < 3; ++d) area[d] = part.area[d] * face[d];
      const State near = on_lines(own, part.at);
      const auto wall = gas_->at_wall(near, unit(-area), part.v);
      const double p = wall.w[Gas::p];
      const Vec3 impulse = p * dt_ * area;
      const double work = dot(impulse, part.v), over = 1 / shape_.cell_volume();
      for (int d = 0; d < 3; ++d) content.U[GasCons::mom + d] -= over * impulse[d];
      content.U[GasCons::rhoE] -= over * work;
      exchange_->momentum += impulse;
      exchange_->energy += work;
      ++exchange_->links;
      LinkLoad load{part.face, impulse, dt_ * area, patch_->lower, std::sqrt(Gas::rho(wall.w) * wall.rho_c2)};
      for (int d = 0; d < 3; ++d) load.at[d] += (x.at[size_t(d)] + part.at[d]) * h[d];
      links_->push_back(load);
    }
  const State w = own.half;
  const Vec3 v = Gas::velocity(w);
  for (int d = 0; d < 3; ++d) {
    const double* s = own.slope[d];
    const Vec3 dv{s[GasPrim::v], s[GasPrim::v_y], s[GasPrim::v_z]};
    content.slope[d][GasCons::rho] = s[0];
    for (int e = 0; e < 3; ++e) content.slope[d][GasCons::mom + e] = v[e] * s[0] + w[0] * dv[e];
    content.slope[d][GasCons::rhoE] = flow.over_G * s[GasPrim::p] + 0.5 * dot(v, v) * s[0] + w[0] * dot(v, dv);
  }
}

void CutCellKernel::correct(const Patch& patch, const GasFlow& flow, double dt, const Index3& first_cell,
                            const double* U, CutCells& cells, const GhostRules& rules, BlockChange& change,
                            WallExchange& exchange, std::vector<LinkLoad>& links, std::vector<uint8_t>& skipped) {
  patch_ = &patch, flow_ = &flow, cells_ = &cells, exchange_ = &exchange, links_ = &links;
  rules_ = rules, dt_ = dt;
  gas_.emplace(Gas{{flow.over_G, flow.Pi}});
  for (int d = 0; d < 3; ++d) {
    lambda_[d] = shape_.used[size_t(d)] ? dt / shape_.h[d] : 0;
    half_lambda_[d] = 0.5 * lambda_[d];
  }
  stride_[0] = 1, stride_[1] = patch.stride_j(), stride_[2] = patch.stride_k();
  for (int q = 0; q < n; ++q) row_[q] = patch.row(flow.prim_row(q), 0, 0);
  look_up(first_cell);
  mark();
  known_.assign(slot_.size(), -1);
  predicted_.clear();
  skipped.assign(size_t(shape_.cells()), 0);
  for (int k = 0; k < shape_.n[2]; ++k)
    for (int j = 0; j < shape_.n[1]; ++j)
      for (int i = 0; i < shape_.n[0]; ++i) {
        const Cell x = cell_at(k, j, i);
        const int32_t slot = slot_[size_t(x.c)];
        bool again = slot >= 0 || special_[size_t(x.c)];
        for (int d = 0; d < 3 && !again; ++d)
          if (shape_.used[size_t(d)]) again = special_[size_t(moved(x, d, -1).c)] || special_[size_t(moved(x, d, 1).c)];
        skipped[shape_.at(k, j, i)] = slot >= 0 || slot == closed;
        if (!again && slot != closed) continue;
        Flux sum{};
        if (slot != closed)
          for (int d = 0; d < 3; ++d) {
            if (!shape_.used[size_t(d)]) continue;
            const Flux in = face(moved(x, d, -1), x, d, false), out = face(x, moved(x, d, 1), d, true);
            for (size_t q = 0; q < sum.size(); ++q) sum[q] += in[q] - out[q];
          }
        for (size_t q = 0; q < sum.size(); ++q) change.row(flow.cons_row(int(q)), k, j)[i] = slot >= 0 ? 0 : sum[q];
        if (slot >= 0) finish(x, U, sum, flow);
      }
  if (change.book_sides) book_sides(change);
}

void CutCellKernel::book_sides(BlockChange& change) {
  for (int d = 0; d < 3; ++d)
    for (int upper = 0; upper < 2; ++upper) {
      if (!shape_.used[size_t(d)] || !(change.book_sides >> (2 * d + upper) & 1)) continue;
      double(&sum)[Cons::most] = change.side[2 * d + upper];
      std::fill(sum, sum + change.rows, 0.0);
      Index3 first{0, 0, 0}, last = shape_.n;
      (upper ? first : last)[size_t(d)] = upper ? shape_.n[size_t(d)] - 1 : 1;
      for (int k = first[2]; k < last[2]; ++k)
        for (int j = first[1]; j < last[1]; ++j)
          for (int i = first[0]; i < last[0]; ++i) {
            const Cell x = cell_at(k, j, i);
            if (slot_[size_t(x.c)] == closed) continue;
            const Flux F = upper ? face(x, moved(x, d, 1), d, true) : face(moved(x, d, -1), x, d, false);
            for (size_t q = 0; q < F.size(); ++q) sum[flow_->cons_row(int(q))] += F[q];
          }
    }
}

}  // namespace bw::cfd
