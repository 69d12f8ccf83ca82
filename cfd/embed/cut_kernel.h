// SPDX-License-Identifier: Apache-2.0
// The step of a block with walls in it: cells that a wall cuts off from a neighbour get one-sided slopes here, the block
// kernel (cfd/scheme/block_kernel.h) takes their face states as it finds them and lets nothing through the faces of cut
// links, and what the wall gives there is added.
//
// Along a grid line with the wall at distance s (in cells) from centre 0 and neighbour 1 on the other side [1-D: the
// linear half-Riemann wall]:
//   W_w = W_0 + s (W_0 - W_1),  W* = half-Riemann(W_w, wall),  line through W* (at the wall) and W_1, skipping W_0: any
//   s in [0, 1]
// gives the ghost value for the limited slope of cell 0. Half a step later cell 0's state goes along that slope to the
// wall, meets it there, and comes back to the cell face next to it.
// That holds for a wall straight across the line. What passes a cell face along a slanted wall belongs to a wave that
// comes in, and such a wave must not be prolonged from inside: at 45 degrees sound between wall and gas would grow. So
// the slope counts by the cosine of twice the angle between line and normal, and nothing from 45 degrees on (first
// order, stable).
// Two other treatments (WallTreatment) take the ghost value and the state beyond the cell face from the mirror instead.
// Both sides of a thin wall do this on their own; what is not conserved by it is booked in WallExchange.
#pragma once
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <vector>

#include "cfd/embed/cut_scheme.h"
#include "cfd/embed/mirror.h"
#include "cfd/embed/jet_flux.h"
#include "cfd/embed/wall_gas.h"
#include "cfd/scheme/beside_walls.h"

namespace bw::cfd {

/// One per thread.
template <class Eos>
class CutKernel {
 public:
  /// A wall pressure above this share of the next cell's means a shock between them: the cell's own state goes to the
  /// wall. A line across the shock would make gas of wrong entropy, which stays at the wall.
  static constexpr double shock_ratio = 1.5;
  /// Cosine between the walls around a cell below which it is a pocket: there its mirror image stands beyond each wall,
  /// at first order. Lines prolonged through walls that disagree feed each other: gas at rest in a corner blew up.
  static constexpr double pocket_cosine = 0.8;
  using Flow = typename Eos::Flow;
  using Gas = WallGas<Eos>;
  using State = typename Gas::State;
  static constexpr int n = Flow::n, n_flux = Flow::n_flux;

  explicit CutKernel(const BlockShape& shape, WallTreatment treatment = WallTreatment::half_riemann)
      : shape_(shape), treatment_(treatment) {}

  /// CutScheme::prepare.
  const CutFaces& prepare(Patch& patch, const PatchCuts& cuts, const Flow& flow, const Eos& eos, double dt) {
    begin(patch, cuts, flow, eos, dt);
    faces_.clear(shape_, n);
    beside_.clear();
    const int g[3] = {shape_.used[0], shape_.used[1], shape_.used[2]};
    for (int k = -g[2]; k < shape_.n[2] + g[2]; ++k)
      for (int j = -g[1]; j < shape_.n[1] + g[1]; ++j) {
        const bool in_k = k >= 0 && k < shape_.n[2], in_j = j >= 0 && j < shape_.n[1], inside = in_k && in_j;
        if (!in_k && !in_j) continue;
        const int first = inside ? -g[0] : 0, end = shape_.n[0] - first;
        const uint8_t* const row = cuts.touched() + cell_at(k, j, 0).c;
        for (const uint8_t *at = row + first, *last = row + end;
             at != last && (at = static_cast<const uint8_t*>(std::memchr(at, 1, size_t(last - at)))); ++at) {
          const int i = int(at - row);
          const Cell x = cell_at(k, j, i);
          if (patch.shocked) patch.row(Prim::shock, k, j)[i] = no_damping;
          const bool in_block = inside && i >= 0 && i < shape_.n[0];
          if (cuts.blocked(x.c)) {
            if (in_block) shut_sides(k, j, i);
            continue;
          }
          const Predicted& own = predicted(x);
          faces_.give(k, j, i, own.half.data(), own.slope[0]);
          shut_faces(x, k, j, i);
          if (in_block) beside_.push_back({x, {i, j, k}});
        }
      }
    return faces_;
  }

  /// CutScheme::correct.
  void correct(BlockChange& change, WallExchange& exchange, std::vector<LinkLoad>* links = nullptr) {
    change_ = &change, exchange_ = &exchange, links_ = links;
    for (const auto& [x, at] : beside_)
      for (int d = 0; d < 3; ++d) {
        if (!shape_.used[size_t(d)]) continue;
        for (int side = 0; side < 2; ++side) {
          if (cuts_->narrow(x.c, d, side))
            add(x, at, side ? narrow_face(x, moved(x, d, 1), d, 1) : narrow_face(moved(x, d, -1), x, d, 0), side ? -1 : 1);
          else if (cuts_->cut(x.c, d, side))
            add(x, at, wall_face(x, d, side), side ? -1 : 1);
        }
      }
  }

  /// CutScheme::load.
  WallLoad load(const Index3& cell, const Vec3& x, const Vec3& normal, const Vec3& v_wall) {
    const Cell c = cell_at(cell[2], cell[1], cell[0]);
    const Predicted& own = predicted(c);
    State near = own.half;
    if (treatment_ != WallTreatment::first_order) {
      const State mean = read(c), change = reached(c, mean, x - centre_of(cell));
      State sum = own.half;
      for (size_t q = 0; q < size_t(n); ++q) sum[q] += change[q] - mean[q];
      near = sum[Gas::p] > 0 && Gas::rho(sum) > 0 ? sum : mean;
    }
    const typename Gas::AtWall star = gas_->at_wall(near, normal, v_wall);
    return {star.w[Gas::p], std::sqrt(star.rho_c2 * Gas::rho(star.w))};
  }

  void begin(const Patch& patch, const PatchCuts& cuts, const Flow& flow, const Eos& eos, double dt) {
    patch_ = &patch, cuts_ = &cuts, flow_ = &flow;
    gas_.emplace(Gas{eos});
    dt_ = dt;
    for (int d = 0; d < 3; ++d) {
      lambda_[d] = shape_.used[size_t(d)] ? dt / shape_.h[d] : 0;
      half_lambda_[d] = 0.5 * lambda_[d];
    }
    stride_[0] = 1, stride_[1] = patch.stride_j(), stride_[2] = patch.stride_k();
    for (int q = 0; q < n; ++q) row_[q] = patch.row(flow.prim_row(q), 0, 0);
    slot_.resize(size_t(cuts.size()), -1);
    for (const int32_t c : predicted_cells_) slot_[size_t(c)] = -1;
    predicted_cells_.clear();
    predicted_.clear();
  }

 private:
  /// A patch cell: its number in PatchCuts and its offset in the patch's rows.
  struct Cell {
    int c;
    ptrdiff_t p;
  };
  struct Predicted {
    State half;                ///< W(t + dt/2)
    double slope[3][Flow::n];  ///< limited, one-sided at walls
    bool pocket;               ///< or all is first order
  };
  struct Face {
    double F[Flow::n_flux];  ///< flux dt/h
    double v;                ///< face velocity dt/h
  };

  Vec3 centre_of(const Index3& cell) const {
    Vec3 x;
    for (int e = 0; e < 3; ++e) x[e] = patch_->lower[e] + (cell[size_t(e)] + 0.5) * shape_.h[e];
    return x;
  }
  Cell cell_at(int k, int j, int i) const { return {cuts_->at(k, j, i), k * stride_[2] + j * stride_[1] + i}; }
  Cell moved(Cell x, int d, int by) const { return {x.c + by * cuts_->step(d), x.p + by * stride_[d]}; }
  State read(Cell x) const {
    State w;
    for (int q = 0; q < n; ++q) w[size_t(q)] = row_[q][x.p];
    return w;
  }

  /// The state of cell x, `mean`, prolonged by `offset` [m] along differences with its open neighbours.
  State reached(Cell x, const State& mean, const Vec3& offset) const {
    State slope{};
    for (int d = 0; d < 3; ++d) {
      if (!shape_.used[size_t(d)]) continue;
      const bool low = !cuts_->cut(x.c, d, 0), high = !cuts_->cut(x.c, d, 1);
      if (!low && !high) continue;
      const State a = low ? read(moved(x, d, -1)) : mean, b = high ? read(moved(x, d, 1)) : mean;
      const double share = std::clamp(offset[d] / shape_.h[d], -2.0, 2.0) * (low && high ? 0.5 : 1.0);
      for (size_t q = 0; q < size_t(n); ++q) slope[q] += share * (b[q] - a[q]);
    }
    State other = mean;
    for (size_t q = 0; q < size_t(n); ++q) other[q] -= slope[q];
    return Gas::beyond(mean, other, 1);
  }

  /// Those of the faces of cell (k, j, i) that walls shut wholly or in part, where the block kernel has them.
  void shut_faces(Cell x, int k, int j, int i) {
    const int at[3] = {i, j, k};
    for (int d = 0; d < 3; ++d) {
      if (!shape_.used[size_t(d)]) continue;
      bool of_block = true;  // a ghost beside a side along another direction has no such face
      for (int e = 0; e < 3; ++e) of_block = of_block && (e == d || (at[e] >= 0 && at[e] < shape_.n[size_t(e)]));
      if (!of_block) continue;
      for (int side = 0; side < 2; ++side) {
        const int face = at[d] + side;
        if (face < 0 || face > shape_.n[size_t(d)] || !(cuts_->cut(x.c, d, side) || cuts_->narrow(x.c, d, side))) continue;
        faces_.shut(d, d == 2 ? face : k, d == 1 ? face : j, d == 0 ? face : i);
      }
    }
  }

  /// Those of the faces of the blocked cell (k, j, i) that lie on the block's sides: nothing is booked there.
  void shut_sides(int k, int j, int i) {
    const int at[3] = {i, j, k};
    for (int d = 0; d < 3; ++d)
      for (const int face : {0, shape_.n[size_t(d)]})
        if (shape_.used[size_t(d)] && at[d] + (face > 0) == face)
          faces_.shut(d, d == 2 ? face : k, d == 1 ? face : j, d == 0 ? face : i);
  }

  /// sign: 1 through the lower face of cell x, which is (i, j, k) of the block, -1 through its upper one.
  void add(Cell x, const Index3& at, const Face& f, double sign) {
    for (int q = 0; q < n_flux; ++q) {
      double change = f.F[q];
      if constexpr (Flow::mixed)
        if (Cons::is_alpha(q)) change -= row_[q == Cons::alpha1 ? int(Prim::alpha1) : q + 1][x.p] * f.v;
      change_->row(flow_->cons_row(q), at[2], at[1])[at[0]] += sign * change;
    }
  }

  /// Do the walls cut from cell c agree with the first one seen?
  bool walls_agree(int c, const Vec3*& first) const {
    for (unsigned sides = cuts_->cut_sides(c); sides != 0; sides &= sides - 1) {
      const int side = std::countr_zero(sides);
      const Vec3& n = cuts_->wall(c, side / 2, side % 2).n;
      if (!first) first = &n;
      if (dot(*first, n) < pocket_cosine) return false;
    }
    return true;
  }

  /// Is this cell next to an edge: do the walls around it, seen from it and from its open neighbours, disagree?
  bool is_pocket(Cell x) const {
    const Vec3* first = nullptr;
    if (!walls_agree(x.c, first)) return true;
    if (!first) return false;
    for (int d = 0; d < 3; ++d)
      for (int side = 0; side < 2; ++side)
        if (shape_.used[size_t(d)] && !cuts_->cut(x.c, d, side) &&
            !walls_agree(x.c + (side ? 1 : -1) * cuts_->step(d), first))
          return true;
    return false;
  }

  const Predicted& predicted(Cell x) {
    if (const int32_t s = slot_[size_t(x.c)]; s >= 0) return predicted_[size_t(s)];
    slot_[size_t(x.c)] = int32_t(predicted_.size());
    predicted_cells_.push_back(x.c);
    predicted_.emplace_back();
    Predicted& r = predicted_.back();
    const State mean = read(x);
    r.pocket = treatment_ == WallTreatment::first_order || is_pocket(x);
    double half[n], mean_w[n];
    for (int q = 0; q < n; ++q) half[q] = mean_w[q] = mean[size_t(q)];
    for (int d = 0; d < 3; ++d) {
      const bool low = cuts_->cut(x.c, d, 0), high = cuts_->cut(x.c, d, 1);
      if (!shape_.used[size_t(d)] || (r.pocket && (low || high))) {
        for (double& s : r.slope[d]) s = 0;
        continue;
      }
      const State a = low ? ghost(x, mean, d, 0) : read(moved(x, d, -1)),
                  b = high ? ghost(x, mean, d, 1) : read(moved(x, d, 1));
      for (size_t q = 0; q < size_t(n); ++q) r.slope[d][q] = MonotonizedCentral::slope(mean[q] - a[q], b[q] - mean[q]);
      if constexpr (Flow::materials > 2)
        flow_->balance(r.slope[d], [&](int k) {
          const auto part = [&](const State& w) { return gas_->eos.part(w, k).pi; };
          return MonotonizedCentral::slope(part(mean) - part(a), part(b) - part(mean));
        });
    }
    Flow::predict(half, r.slope, half_lambda_, patch_->row(Prim::rho_c2, 0, 0)[x.p], patch_->row(Prim::dPi, 0, 0)[x.p]);
    limit_cell(*patch_, x.p, *flow_, mean_w, half, r.slope);
    for (int q = 0; q < n; ++q) r.half[size_t(q)] = half[q];
    return r;
  }

  /// The value that the wall line has one cell beyond x, at t.
  State ghost(Cell x, const State& mean, int d, int side) const {
    const WallSide& w = cuts_->wall(x.c, d, side);
    if (treatment_ == WallTreatment::mirror) {
      if (shock_before(x, d, side, gas_->at_wall(mean, w.n, w.v).w[Gas::p]))
        return mirrored(*gas_, mean, w, 0, 0.5 * dt_);
      const Behind at = behind(w, d, side ? 1 : -1, w.s, 1);
      return mirrored(*gas_, reached(x, mean, at.image), w, at.height, 0.5 * dt_);
    }
    const State other = read(moved(x, d, side ? -1 : 1));
    const State star = gas_->at_wall(Gas::beyond(mean, other, w.s), w.n, w.v).w;
    return Gas::on_line(star, other, mean, (w.s - 1) / (1 + w.s));
  }

  /// Where a point behind a wall, `cells` along the link from the centre, has its mirror image [m, from the centre].
  struct Behind {
    Vec3 image;
    double height;  ///< of the image above the wall
  };
  Behind behind(const WallSide& w, int d, double out, double s, double cells) const {
    Vec3 point, on_wall;
    point[d] = out * cells * shape_.h[d], on_wall[d] = out * s * shape_.h[d];
    const Vec3 image = image_of(point, on_wall, w.n);
    return {image, dot(image - on_wall, w.n)};
  }

  Face open_face(Cell low, Cell high, int d) {
    const Predicted& a = predicted(low);  // a and b: predicted() may move what it returned before
    double L[n], R[n];
    for (int q = 0; q < n; ++q) L[q] = a.half[size_t(q)] + 0.5 * a.slope[d][q];
    const Predicted& b = predicted(high);
    for (int q = 0; q < n; ++q) R[q] = b.half[size_t(q)] - 0.5 * b.slope[d][q];
    double stored = 0;
    if (Flow::mixed && patch_->burns) {
      const double* z = patch_->row(Prim::stored_energy, 0, 0);
      stored = 0.5 * (z[low.p] + z[high.p]);
    }
    return solve(L, R, sound(low), sound(high), d, stored);
  }

  Sound<double> sound(Cell x) const {
    double rho = patch_->row(Prim::arho1, 0, 0)[x.p] + patch_->row(Prim::arho2, 0, 0)[x.p];
    for (int k = 2; k < Flow::materials; ++k) rho += patch_->row(Prim::arho(k), 0, 0)[x.p];
    return {patch_->row(Prim::c, 0, 0)[x.p], rho};
  }

  Face solve(const double (&L)[Flow::n], const double (&R)[Flow::n], const Sound<double>& sound_L,
             const Sound<double>& sound_R, int d, double stored) const {
    Face f;
    f.v = lambda_[d] * (d == 0   ? flow_->template flux<0>(L, R, sound_L, sound_R, f.F)
                        : d == 1 ? flow_->template flux<1>(L, R, sound_L, sound_R, f.F)
                                 : flow_->template flux<2>(L, R, sound_L, sound_R, f.F));
    if constexpr (Flow::mixed) f.F[Cons::rhoE] += f.F[Cons::arho1] * stored;
    for (double& F : f.F) F *= lambda_[d];
    return f;
  }

  /// w further along the slope of its cell in direction d; w itself where that is no gas.
  static State on_slope(const State& w, const Predicted& own, int d, double share) {
    State out = w;
    for (size_t q = 0; q < size_t(n); ++q) out[q] += share * own.slope[d][q];
    return if_gas(out, w);
  }
  /// Half a step later, `offset` [m] from the centre.
  State on_slopes(const Predicted& own, const Vec3& offset) const {
    State out = own.half;
    for (int d = 0; d < 3; ++d)
      if (shape_.used[size_t(d)])
        for (size_t q = 0; q < size_t(n); ++q) out[q] += offset[d] / shape_.h[d] * own.slope[d][q];
    return if_gas(out, own.half);
  }
  static State if_gas(const State& out, const State& w) {
    const bool physical = out[Gas::p] > 0.2 * w[Gas::p] && Gas::rho(out) > 0.2 * Gas::rho(w);
    return physical ? out : w;
  }

  /// Flux at a face that a wall blocks in part, as the cell on `side` of the link's lower (1) or upper (0) end feels
  /// it.
  Face narrow_face(Cell low, Cell high, int d, int side) {
    const Cell x = side ? low : high;
    const double open = cuts_->open(x.c, d, side);
    Face f = wall_face(x, d, side, 1 - open);
    const auto blend = [&](const Face& other, double share) {
      for (int q = 0; q < n_flux; ++q) f.F[q] += share * (other.F[q] - f.F[q]);
      f.v += share * (other.v - f.v);
    };
    if (open == 0) return f;
    Face through = open_face(low, high, d);
    // where a cell does not see the opening's width, the flow through it has the time to become steady
    // two sides of a thin body may move differently: both cells see one flux
    const Vec3 v_wall = 0.5 * (cuts_->wall(low.c, d, 1).v + cuts_->wall(high.c, d, 0).v);
    const Face jet = jet_face(low, high, d, v_wall, open);
    for (int q = 0; q < n_flux; ++q) through.F[q] = jet.F[q] + open * (through.F[q] - jet.F[q]);
    through.v = jet.v + open * (through.v - jet.v);
    blend(through, open);
    return f;
  }

  /// Flux through a narrow opening that moves with v_wall.
  Face jet_face(Cell low, Cell high, int d, const Vec3& v_wall, double open) {
    const State w[2] = {predicted(low).half, predicted(high).half};
    double stored[2] = {0, 0};
    if (patch_->burns)
      for (const int i : {0, 1}) stored[i] = patch_->row(Prim::stored_energy, 0, 0)[(i ? high : low).p];
    Face f;
    f.v = lambda_[d] * jet_flux(*gas_, w, d, v_wall, open, lambda_[d], stored, f.F);
    for (double& F : f.F) F *= lambda_[d];
    return f;
  }

  /// What a slanted wall meets at a cut link, `here` in cell x. Where gas comes along the wall through the link, that is
  /// not the cell's own: fed with itself it would grow, in density and in speed. It comes past the neighbour away from
  /// the wall: that one's entropy, composition and speed along the wall, the cell's own pressure and speed off it.
  State along_wall(Cell x, const State& here, const WallSide& w, int d, double out, double share) const {
    if (treatment_ != WallTreatment::half_riemann || share >= 0.5 || out * (here[size_t(Gas::v + d)] - w.v[d]) >= 0) return here;
    int e = -1;
    for (int other = 0; other < 3; ++other)
      if (other != d && shape_.used[size_t(other)] && (e < 0 || std::abs(w.n[other]) > std::abs(w.n[e]))) e = other;
    if (e < 0 || w.n[e] == 0 || cuts_->cut(x.c, e, w.n[e] > 0)) return here;
    const State there = read(moved(x, e, w.n[e] > 0 ? 1 : -1));
    State come = there;
    const double off = dot(Gas::velocity(here) - Gas::velocity(there), w.n);
    for (int a = 0; a < 3; ++a) come[size_t(Gas::v + a)] += off * w.n[a];
    come[Gas::p] = here[Gas::p];
    // no more than a factor of two: mixtures that hardly resist have no isentrope to speak of
    const double ratio = std::clamp(gas_->on_isentrope(there, here[Gas::p]) / Gas::rho(there), 0.5, 2.0);
    for (int k = 0; k < Gas::densities; ++k) come[size_t(FaceRow::arho(k))] *= ratio;
    if constexpr (Flow::mixed) come[Prim::Pi] = gas_->pi(come);
    for (size_t q = 0; q < size_t(n); ++q) come[q] += (0.5 + share) * (here[q] - come[q]);
    return come;
  }

  /// Flux at the face of x whose link is cut; the wall stands where it will be at mid-step. share_of_face: what is
  /// booked.
  Face wall_face(Cell x, int d, int side, double share_of_face = 1) {
    const WallSide& w = cuts_->wall(x.c, d, side);
    const double out = side ? 1 : -1;
    double towards =
        out * w.n[d];  // < 0; a wall nearly along the line moves over it at no more than half a cell a step
    towards = std::min(towards, -0.1);
    const double shift = std::clamp(0.5 * dt_ * dot(w.v, w.n) / (towards * shape_.h[d]), -0.5, 0.5);
    const double s = std::max(w.s + shift, 0.0);
    const Predicted& own = predicted(x);
    const Sound<double> in = sound(x);
    Sound<double> wall = in;
    const double share = std::max(2 * w.n[d] * w.n[d] - 1, 0.0);
    const State met = along_wall(x, own.half, w, d, out, share);
    State face = met;
    if (own.pocket) {
      const Vec3 back = -2 * dot(Gas::velocity(face) - w.v, w.n) * w.n;
      for (int e = 0; e < 3; ++e) face[size_t(Gas::v + e)] += back[e];
    } else if (treatment_ == WallTreatment::mirror) {
      const Behind at = behind(w, d, out, s, 0.5);
      const bool shock = shock_before(x, d, side, gas_->at_wall(own.half, w.n, w.v).w[Gas::p]);
      face = shock ? mirrored(*gas_, own.half, w, 0) : mirrored(*gas_, on_slopes(own, share * at.image), w, at.height);
      wall = {std::sqrt(std::max(gas_->stiffness(face), 0.0) / Gas::rho(face)), Gas::rho(face)};
    } else {
      typename Gas::AtWall star = gas_->at_wall(on_slope(met, own, d, out * share * s), w.n, w.v);
      face = on_slope(star.w, own, d, out * share * (0.5 - s));
      if (shock_before(x, d, side, star.w[Gas::p])) {
        star = gas_->at_wall(met, w.n, w.v);
        face = star.w;
      }
      wall = {std::sqrt(star.rho_c2 / Gas::rho(star.w)), Gas::rho(star.w)};
    }
    double inner[n], beyond[n];
    for (size_t q = 0; q < size_t(n); ++q) {
      inner[q] = own.half[q] + 0.5 * out * own.slope[d][q];
      beyond[q] = face[q];
    }
    if (treatment_ == WallTreatment::half_riemann && !own.pocket && behind_fan(inner, face, w.n, wall.c))
      std::copy(beyond, beyond + n, inner);
    const double stored = Flow::mixed && patch_->burns ? patch_->row(Prim::stored_energy, 0, 0)[x.p] : 0;
    const Face f = side ? solve(inner, beyond, in, wall, d, stored) : solve(beyond, inner, wall, in, d, stored);
    const double volume = share_of_face * out * shape_.cell_volume();
    for (int k = 0; k < Gas::densities; ++k) exchange_->mass += volume * f.F[Cons::arho(k)];
    Vec3 impulse;
    for (int e = 0; e < 3; ++e) impulse[e] = volume * f.F[Flow::mixed ? Cons::mom + e : GasCons::mom + e];
    exchange_->momentum += impulse;
    if (links_) {
      // what a wall sweeps over belongs to covered and uncovered cells, not to its faces
      const double swept = volume * lambda_[d] * w.v[d] * Gas::rho(face);
      note_link(x, d, out, s, w.face, impulse - swept * Gas::velocity(face), volume * lambda_[d]);
    }
    exchange_->energy += volume * f.F[Flow::mixed ? int(Cons::rhoE) : int(GasCons::rhoE)];
    ++exchange_->links;
    return f;
  }

  /// Does the wall's pressure stand behind a shock that the next cell has not seen?
  bool shock_before(Cell x, int d, int side, double p_wall) const {
    return p_wall > shock_ratio * read(moved(x, d, side ? -1 : 1))[Gas::p];
  }

  void note_link(Cell x, int d, double out, double s, int32_t face, const Vec3& impulse, double area_time) {
    LinkLoad load{face, impulse, {}, {}};
    load.area_time[d] = area_time;
    const ptrdiff_t cell[3] = {x.p % stride_[2] % stride_[1], x.p % stride_[2] / stride_[1], x.p / stride_[2]};
    for (int e = 0; e < 3; ++e) load.at[e] = patch_->lower[e] + (double(cell[e]) + 0.5) * shape_.h[e];
    load.at[d] += out * s * shape_.h[d];
    links_->push_back(load);
  }

  /// Has the fan that a receding wall sends into the gas passed the cell face? Then the wall's gas is what goes through
  /// it; a flux between the two states would be that of a shock and leave gas of wrong entropy at the wall.
  static bool behind_fan(const double (&inner)[n], const State& at_wall, const Vec3& normal, double c) {
    const double v = dot(Gas::velocity(at_wall), normal);
    return v < dot(Vec3{inner[Gas::v], inner[Gas::v + 1], inner[Gas::v + 2]}, normal) && v + c >= 0;
  }

  BlockShape shape_;
  WallTreatment treatment_;
  const Patch* patch_ = nullptr;
  const PatchCuts* cuts_ = nullptr;
  const Flow* flow_ = nullptr;
  BlockChange* change_ = nullptr;
  WallExchange* exchange_ = nullptr;
  std::vector<LinkLoad>* links_ = nullptr;
  std::optional<Gas> gas_;
  double dt_ = 0, lambda_[3] = {}, half_lambda_[3] = {};
  ptrdiff_t stride_[3] = {};
  const double* row_[Flow::n] = {};
  CutFaces faces_;
  struct InBlock {
    Cell x;
    Index3 at;  ///< i, j, k
  };
  std::vector<InBlock> beside_;   ///< open cells of the block with a cut or narrow face
  std::vector<int32_t> slot_;     ///< by patch cell: into predicted_, -1: not yet
  std::vector<int32_t> predicted_cells_;  ///< patch cells, as predicted_
  std::vector<Predicted> predicted_;
};

}  // namespace bw::cfd
