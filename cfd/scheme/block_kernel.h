// SPDX-License-Identifier: Apache-2.0
// One MUSCL-Hancock step of one block: slopes and half step of a row of cells, HLLC at its lower faces, row after row,
// so that face states live for one row (i, j) or one plane (k) only. Result: dt times the rate of change, undivided by
// volume.
#pragma once
#include <algorithm>
#include <cstdint>

#include "cfd/amr/patch.h"
#include "cfd/scheme/carbuncle.h"
#include "cfd/scheme/cut_faces.h"
#include "cfd/scheme/lane.h"
#include "cfd/scheme/limiter.h"
#include "cfd/scheme/positivity.h"

namespace bw::cfd {

/// Change of a block over one step, and what was noticed on the way. One per thread.
struct BlockChange {
  explicit BlockChange(const BlockShape& s, int materials = 2)
      : shape(s), rows(Cons::rows(materials)), pitch((s.n[0] + 7) / 8 * 8 + 8) {
    data.assign(size_t(rows) * s.n[2] * s.n[1] * pitch, 0.0);
  }
  BlockChange() = default;
  /// U_new - U_old of row (k, j), from i = 0; rows have room for hanging packs.
  double* row(int variable, int k, int j) {
    return data.data() + ((size_t(variable) * shape.n[2] + k) * shape.n[1] + j) * pitch;
  }
  const double* row(int variable, int k, int j) const { return const_cast<BlockChange*>(this)->row(variable, k, j); }

  BlockShape shape;
  int rows = 0;  ///< variables
  int pitch = 0;
  Aligned<double> data;
  int64_t scaled_cells = 0;          ///< cells whose face states were scaled (positivity.h)
  unsigned book_sides = 0;           ///< in: bit 2d + upper of the sides whose fluxes are wanted
  double side[6][Cons::most] = {};   ///< out: sum over the side's faces of flux * dt/h_d, for book_sides
  unsigned keep_sides = 0;           ///< in: bit 2d + upper of the sides whose fluxes are wanted face by face
  /// Out, for keep_sides: flux * dt/h_d, then face velocity * dt/h_d. [variable][faces], j + n_j k, i + n_i k or i +
  /// n_i j, with room for hanging packs. Rows that the flow does not own are left alone.
  Aligned<double> side_flux[6];
  int side_rows() const { return rows + 1; }

  size_t side_pitch(int d) const { return size_t(shape.cells() / shape.n[size_t(d)]) + 8; }
  double* side_row(int side, int variable) { return side_flux[side].data() + side_pitch(side / 2) * size_t(variable); }
  const double* side_row(int side, int variable) const {
    return const_cast<BlockChange*>(this)->side_row(side, variable);
  }
  /// Room for the fluxes of the sides in keep_sides, zero.
  void make_sides() {
    for (int side = 0; side < 6; ++side)
      if (keep_sides >> side & 1) side_flux[side].assign(side_pitch(side / 2) * size_t(side_rows()), 0.0);
  }
};

template <class Flow, class T>
class BlockKernel {
  static constexpr int n = Flow::n, n_flux = Flow::n_flux, w = Lane<T>::width, room = 4;

 public:
  explicit BlockKernel(const BlockShape& shape) : shape_(shape), pitch_(shape.n[0] + room + 14) {
    for (auto* rows : {&minus_[0], &plus_[0], &minus_[1], &plus_[1], &old_y_, &minus_[2], &plus_[2]})
      rows->assign(size_t(n) * pitch_, 0.0);
    flux_.assign(size_t(n_flux + 1) * pitch_, 0.0);
    open_.assign(pitch_, 1.0);
    old_z_.resize(size_t(shape.n[1]), Aligned<double>(size_t(n) * pitch_, 0.0));
  }

  /// Reads patch (filled, ghosts too); writes change (all rows of the flow's own variables; the others are left alone).
  /// cut: of the walls in the patch; nullptr: none.
  void advance(const Patch& patch, const Flow& flow, double dt, BlockChange& change, const CutFaces* cut = nullptr) {
    patch_ = &patch, flow_ = &flow, change_ = &change, cut_ = cut;
    for (int d = 0; d < 3; ++d) lambda_[d] = shape_.used[d] ? dt / patch.shape().h[d] : 0;
    change.scaled_cells = 0;
    for (auto& side : change.side) std::fill(side, side + change.rows, 0.0);
    const int ky = shape_.used[1] ? 1 : 0, kz = shape_.used[2] ? 1 : 0;
    for (int k = -kz; k < shape_.n[2] + kz; ++k)
      for (int j = -ky; j < shape_.n[1] + ky; ++j) {
        const bool in_k = k >= 0 && k < shape_.n[2], in_j = j >= 0 && j < shape_.n[1];
        if (!in_k && !in_j) continue;
        predict_row(k, j, in_k, in_j);
        if (in_k && in_j) faces_x(k, j);
        if (ky && in_k && j >= 0) faces_across<1>(k, j, old_y_);
        if (ky) std::swap(old_y_, plus_[1]);
        if (kz && in_j && k >= 0) faces_across<2>(k, j, old_z_[size_t(j)]);
        if (kz && in_j) std::swap(old_z_[size_t(j)], plus_[2]);
      }
  }

 private:
  double* face(Aligned<double>& rows, int q) const { return rows.data() + size_t(q) * pitch_ + room; }

  static T limited(const double* a, ptrdiff_t step) {
    const T mean = Lane<T>::load(a);
    return MonotonizedCentral::slope(mean - Lane<T>::load(a - step), Lane<T>::load(a + step) - mean);
  }
  /// Is row q of the flux one of d alpha/dt + v.grad alpha = 0?
  static constexpr bool is_alpha(int q) { return Flow::mixed && Cons::is_alpha(q); }
  /// W(t + dt/2) at the six faces of the cells of row (k, j): minus_[d], plus_[d].
  void predict_row(int k, int j, bool in_k, bool in_j) {
    const bool inside = in_k && in_j,
               wanted[3] = {shape_.used[0] && inside, shape_.used[1] && in_k, shape_.used[2] && in_j};
    const int x = shape_.used[0] && inside ? 1 : 0;
    const ptrdiff_t step[3] = {shape_.used[0] ? 1 : 0, shape_.used[1] ? patch_->stride_j() : 0,
                               shape_.used[2] ? patch_->stride_k() : 0};
    const T half_lambda[3] = {T(0.5 * lambda_[0]), T(0.5 * lambda_[1]), T(0.5 * lambda_[2])};
    const double* W_row[n];
    for (int q = 0; q < n; ++q) W_row[q] = patch_->row(flow_->prim_row(q), k, j);
    const double* rho_c2 = patch_->row(Prim::rho_c2, k, j);
    const double* dPi = patch_->row(Prim::dPi, k, j);
    const double* order = patch_->limited ? patch_->row(Prim::order, k, j) : nullptr;
    double *minus[3], *plus[3];
    for (int d = 0; d < 3; ++d) minus[d] = face(minus_[d], 0), plus[d] = face(plus_[d], 0);
    const ptrdiff_t pitch = pitch_;
    const int end = shape_.n[0] + x;
    for (int i = -x; i < end; i += w) {
      T mean[n], half[n], slope[3][n];
      for (int q = 0; q < n; ++q) {
        const double* a = W_row[q] + i;
        mean[q] = half[q] = Lane<T>::load(a);
        for (int d = 0; d < 3; ++d) slope[d][q] = limited(a, step[d]);
      }
      if constexpr (Flow::materials > 2)
        for (int d = 0; d < 3; ++d)
          flow_->balance(slope[d], [&](int m) { return limited(patch_->row(Prim::part(m), k, j) + i, step[d]); });
      Flow::predict(half, slope, half_lambda, Lane<T>::load(rho_c2 + i), Lane<T>::load(dPi + i));
      if (order) {
        const T keep = Lane<T>::load(order + i);
        for (int q = 0; q < n; ++q) {
          half[q] = mean[q] + keep * (half[q] - mean[q]);
          for (int d = 0; d < 3; ++d) slope[d][q] = keep * slope[d][q];
        }
      }
      const auto scaled = keep_faces_positive(*flow_, mean, half, slope);
      if (inside && any(scaled)) count_scaled(scaled, i);
      if constexpr (Flow::materials == 2)
        if (flow_->interface.sharpness > 0 && any(min(mean[Prim::alpha1], T(1) - mean[Prim::alpha1]) > T(Interface::least))) {
          sharp_faces(W_row[Prim::alpha1] + i, step, mean, half, slope, half_lambda, Lane<T>::load(dPi + i),
                      order ? Lane<T>::load(order + i) : T(1), wanted, i);
          continue;
        }
      for (int d = 0; d < 3; ++d)
        if (wanted[d])
          for (int q = 0; q < n; ++q) {
            Lane<T>::store(minus[d] + q * pitch + i, half[q] - T(0.5) * slope[d][q]);
            Lane<T>::store(plus[d] + q * pitch + i, half[q] + T(0.5) * slope[d][q]);
          }
    }
    if (!cut_) return;
    cut_->for_each_given(k, j, [&](int i, const double* at_mid, const double* slope) {
      for (int d = 0; d < 3; ++d)
        if (wanted[d])
          for (int q = 0; q < n; ++q) {
            minus[d][q * pitch + i] = at_mid[q] - 0.5 * slope[d * n + q];
            plus[d][q * pitch + i] = at_mid[q] + 0.5 * slope[d * n + q];
          }
    });
  }
  /// The same with an interface in one of the cells at i; a: their alpha1; order: 0 where they are first order.
  void sharp_faces(const double* a, const ptrdiff_t (&step)[3], const T (&mean)[n], const T (&half)[n],
                   const T (&slope)[3][n], const T (&half_lambda)[3], T dPi, T order, const bool (&wanted)[3], int i) {
    T div(0), rise[3], steepest(1e-300);
    for (int d = 0; d < 3; ++d) {
      div = div + half_lambda[d] * slope[d][Flow::v + d];
      rise[d] = abs(Lane<T>::load(a + step[d]) - Lane<T>::load(a - step[d])) * half_lambda[d];  // ~ d alpha/dx_d
      steepest = steepest + rise[d] * rise[d];
    }
    const T over_norm = T(flow_->interface.sharpness) / sqrt(steepest);
    const SharpCell<T> cell(flow_->interface, mean, div, dPi);
    for (int d = 0; d < 3; ++d) {
      if (!wanted[d]) continue;
      T low[n], high[n];
      for (int q = 0; q < n; ++q) {
        low[q] = half[q] - T(0.5) * slope[d][q];
        high[q] = half[q] + T(0.5) * slope[d][q];
      }
      const T lambda = half_lambda[d] + half_lambda[d];
      sharpen(cell, Lane<T>::load(a - step[d]), Lane<T>::load(a + step[d]), rise[d] * over_norm + T(0.01),
              lambda * low[Flow::v + d], lambda * high[Flow::v + d], order > T(0), low, high);
      for (int q = 0; q < n; ++q) {
        Lane<T>::store(face(minus_[d], q) + i, low[q]);
        Lane<T>::store(face(plus_[d], q) + i, high[q]);
      }
    }
  }
  void count_scaled(Mask m, int i) {
    for (int l = 0; l < Pack::size; ++l) change_->scaled_cells += m[l] && i + l >= 0 && i + l < shape_.n[0];
  }
  void count_scaled(bool m, int i) { change_->scaled_cells += m && i >= 0 && i < shape_.n[0]; }

  /// What a row of faces is solved from; a copy on the stack, which stores through pointers can't change.
  struct Faces {
    const double *low, *high, *c_low, *c_high, *z_low,
        *z_high;                           ///< upper states of the cells before, lower of the cells at i
    const double *arho1_low, *arho1_high;  ///< of the cells; arho2 lies one variable further
    const double *shock_low, *shock_high;  ///< nullptr: no shock in the patch
    ptrdiff_t pitch, variable;
    T lambda;
    Flow flow;
    Sound<T> sound(const double* c, const double* arho1, int i) const {
      if constexpr (!Flow::mixed) return {Lane<T>::load(c + i), T(0)};
      T rho = Lane<T>::load(arho1 + i) + Lane<T>::load(arho1 + variable + i);
      for (int m = 2; m < Flow::materials; ++m) rho += Lane<T>::load(arho1 + Prim::arho(m) * variable + i);
      return {Lane<T>::load(c + i), rho};
    }
  };
  Faces faces_of(int axis, Aligned<double>& low, int shift, ptrdiff_t step, int k, int j) {
    const double* c = patch_->row(Prim::c, k, j);
    const double* z = Flow::mixed && patch_->burns ? patch_->row(Prim::stored_energy, k, j) : nullptr;
    const double* arho1 = patch_->row(Prim::arho1, k, j);
    const double* shock = patch_->shocked ? patch_->row(Prim::shock, k, j) : nullptr;
    return {face(low, 0) - shift,
            face(minus_[axis], 0),
            c - step,
            c,
            z ? z - step : nullptr,
            z,
            arho1 - step,
            arho1,
            shock ? shock - step : nullptr,
            shock,
            pitch_,
            patch_->stride_variable(),
            T(lambda_[axis]),
            *flow_};
  }
  /// Flux times dt/h and face velocity times dt/h.
  template <int axis>
  static T solve(const Faces& f, int i, T (&F)[n_flux]) {
    T L[n], R[n];
    for (int q = 0; q < n; ++q) {
      L[q] = Lane<T>::load(f.low + q * f.pitch + i);
      R[q] = Lane<T>::load(f.high + q * f.pitch + i);
    }
    const T v_face =
        f.flow.template flux<axis>(L, R, f.sound(f.c_low, f.arho1_low, i), f.sound(f.c_high, f.arho1_high, i), F);
    if constexpr (Flow::mixed)
      if (f.z_low)
        F[Cons::rhoE] += F[Cons::arho1] * (T(0.5) * (Lane<T>::load(f.z_low + i) + Lane<T>::load(f.z_high + i)));
    if constexpr (!Flow::mixed)
      if (f.shock_low) {
        const T in_shock = in_shock_between(Lane<T>::load(f.shock_low + i), Lane<T>::load(f.shock_high + i));
        if (any(in_shock > T(0)))
          damp_along_shock<axis, Flow>(L, R, max(Lane<T>::load(f.c_low + i), Lane<T>::load(f.c_high + i)), in_shock, F);
      }
    for (int q = 0; q < n_flux; ++q) F[q] = f.lambda * F[q];
    return f.lambda * v_face;
  }

  void faces_x(int k, int j) {
    double* out[n_flux];
    for (int q = 0; q < n_flux; ++q) out[q] = change_->row(flow_->cons_row(q), k, j);
    const int n0 = shape_.n[0];
    if (!shape_.used[0]) {
      for (int q = 0; q < n_flux; ++q) std::fill(out[q], out[q] + n0, 0.0);
      return;
    }
    const Faces f = faces_of(0, plus_[0], 1, 1, k, j);
    double* flux = face(flux_, 0);
    for (int i = 0; i <= n0; i += w) {
      T F[n_flux];
      const T v_face = solve<0>(f, i, F);
      for (int q = 0; q < n_flux; ++q) Lane<T>::store(flux + q * f.pitch + i, F[q]);
      if constexpr (Flow::mixed) Lane<T>::store(flux + n_flux * f.pitch + i, v_face);
    }
    if (cut_)
      cut_->for_each_shut(0, k, j, [&](int i) {
        for (int q = 0; q <= n_flux; ++q) flux[q * f.pitch + i] = 0;
      });
    for (int q = 0; q < n_flux; ++q) {
      const double* alpha = patch_->row(is_alpha(q) ? Prim::alpha_of(q) : int(Prim::alpha1), k, j);
      const double *F = flux + q * f.pitch, *v_face = flux + n_flux * f.pitch;
      for (int upper = 0; upper < 2; ++upper)
        if (change_->book_sides >> upper & 1) change_->side[upper][flow_->cons_row(q)] += F[upper * n0];
      for (int upper = 0; upper < 2; ++upper)
        if (change_->keep_sides >> upper & 1) {
          const int face = k * shape_.n[1] + j;
          change_->side_row(upper, flow_->cons_row(q))[face] = F[upper * n0];
          if (q == Cons::alpha1 && Flow::mixed) change_->side_row(upper, change_->rows)[face] = v_face[upper * n0];
        }
      for (int i = 0; i < n0; i += w) {
        T d = Lane<T>::load(F + i) - Lane<T>::load(F + i + 1);
        if (is_alpha(q))
          d -= Lane<T>::load(alpha + i) * (Lane<T>::load(v_face + i) - Lane<T>::load(v_face + i + 1));
        Lane<T>::store(out[q] + i, d);
      }
    }
  }

  /// Faces between row (k, j) and the row before it along axis.
  template <int axis>
  void faces_across(int k, int j, Aligned<double>& low) {
    const int at = axis == 1 ? j : k, end = shape_.n[axis];
    const int j0 = axis == 1 ? j - 1 : j, k0 = axis == 2 ? k - 1 : k;
    const ptrdiff_t step = axis == 1 ? patch_->stride_j() : patch_->stride_k();
    const Faces f = faces_of(axis, low, 0, step, k, j);
    const double* alpha1 = patch_->row(Prim::alpha1, k, j);
    double *above[n_flux], *below[n_flux];
    for (int q = 0; q < n_flux; ++q) {
      above[q] = at < end ? change_->row(flow_->cons_row(q), k, j) : nullptr;
      below[q] = at > 0 ? change_->row(flow_->cons_row(q), k0, j0) : nullptr;
    }
    const int side = 2 * axis + (at == 0 ? 0 : 1);
    const bool booked = (at == 0 || at == end) && (change_->book_sides >> side & 1),
               kept = (at == 0 || at == end) && (change_->keep_sides >> side & 1);
    const double* open = cut_ && cut_->any_shut(axis, k, j) ? open_faces(axis, k, j) : nullptr;
    for (int i = 0; i < shape_.n[0]; i += w) {
      T F[n_flux];
      T v_face = solve<axis>(f, i, F);
      if (open) {
        const auto is_open = Lane<T>::load(open + i) > T(0);
        for (int q = 0; q < n_flux; ++q) F[q] = select(is_open, F[q], T(0));
        v_face = select(is_open, v_face, T(0));
      }
      if (booked) book(side, F, std::min(w, shape_.n[0] - i));
      if (kept) keep(side, (axis == 1 ? k : j) * shape_.n[0] + i, F, v_face, std::min(w, shape_.n[0] - i));
      if (at < end) add(above, i, F, v_face, alpha1, T(1));
      if (at > 0) add(below, i, F, v_face, alpha1 - step, T(-1));
    }
  }
  /// 1; 0 where cut_ shuts the face.
  const double* open_faces(int axis, int k, int j) {
    std::fill(open_.begin(), open_.end(), 1.0);
    cut_->for_each_shut(axis, k, j, [&](int i) { open_[size_t(i)] = 0; });
    return open_.data();
  }
  void add(double* const (&out)[n_flux], int i, const T (&F)[n_flux], T v_face, const double* alpha1, T sign) const {
    const ptrdiff_t variable = Flow::materials > 2 ? patch_->stride_variable() : 0;
    for (int q = 0; q < n_flux; ++q) {
      T d = F[q];
      if (is_alpha(q)) {
        const ptrdiff_t further = q == Cons::alpha1 ? 0 : (Prim::alpha_of(q) - Prim::alpha1) * variable;
        d -= Lane<T>::load(alpha1 + further + i) * v_face;
      }
      Lane<T>::store(out[q] + i, Lane<T>::load(out[q] + i) + sign * d);
    }
  }
  void book(int side, const T (&F)[n_flux], int count) {
    for (int q = 0; q < n_flux; ++q) {
      double lane[w];
      Lane<T>::store(lane, F[q]);
      for (int l = 0; l < count; ++l) change_->side[side][flow_->cons_row(q)] += lane[l];
    }
  }
  void keep(int side, int face, const T (&F)[n_flux], T v_face, int count) {
    double lane[w];
    for (int q = 0; q < n_flux + (Flow::mixed ? 1 : 0); ++q) {
      Lane<T>::store(lane, q < n_flux ? F[q] : v_face);
      std::copy_n(lane, count, change_->side_row(side, q < n_flux ? flow_->cons_row(q) : change_->rows) + face);
    }
  }

  BlockShape shape_;
  int pitch_;
  double lambda_[3] = {};
  const Patch* patch_ = nullptr;
  const Flow* flow_ = nullptr;
  BlockChange* change_ = nullptr;
  const CutFaces* cut_ = nullptr;
  Aligned<double> open_;  ///< open_faces()
  Aligned<double> minus_[3], plus_[3], old_y_, flux_;  ///< face states of one row: [variable][i]
  std::vector<Aligned<double>> old_z_;                 ///< upper z faces of the plane before, by j
};

}  // namespace bw::cfd
