// SPDX-License-Identifier: Apache-2.0
// One MUSCL-Hancock step of a row of shells (cylinders or spheres), second order on their true volumes and areas:
//   U_new = U - dt/V (A_+ F_+ - A_- F_-) + dt/V (A_+ - A_-) p (0, 1, 0),   d alpha/dt likewise with A v.
// Slopes lie between the shells' centroids, and the pressure of the source is that where the area's mean is, so gas
// whose pressure is uniform stays at rest to the last bit: what the faces and the source push is subtracted before it
// is multiplied with anything.
#pragma once
#include "cfd/scheme/block_kernel.h"

namespace bw::cfd {

/// What the scheme needs of the shells' shape, from the ghost before the first to the one after the last; Pack loads
/// may hang over. Shells at negative radius are those at positive radius in a mirror.
class ShellRow {
 public:
  ShellRow() = default;
  explicit ShellRow(int n) : n_(n), pitch_(n + 16) { data_.assign(size_t(rows) * size_t(pitch_), 1.0); }
  enum : int {
    area_low,   ///< h A/V of the face at the smaller radius
    area_high,  ///< and at the larger
    to_low,     ///< h/distance between the centroids of this shell and the one before
    back,       ///< from the lower face to the centroid, over `reach` h
    ahead,      ///< from the centroid to the upper face, over `reach` h
    reach,      ///< twice the larger distance between centroid and face, over h
    level,      ///< place between the faces, 0 to 1, where a linear field has its mean over the area
    rows
  };
  const double* row(int q) const { return data_.data() + size_t(q) * size_t(pitch_) + margin; }

  /// mirror: bit 0, 1: a wall at the lower, upper end, beyond which shells are images.
  void fill(Geometry geometry, double lower, double h, unsigned mirror) {
    const double upper = lower + n_ * h;
    const auto place = [&](int i) {
      if (mirror & 1 && i < 0) return 2 * lower - centroid(geometry, lower - (i + 0.5) * h, h);
      if (mirror & 2 && i >= n_) return 2 * upper - centroid(geometry, upper - (i - n_ + 0.5) * h, h);
      return centroid(geometry, lower + (i + 0.5) * h, h);
    };
    double before = place(-2);
    for (int i = -1; i <= n_ + 1; ++i) {
      const double m = lower + (i + 0.5) * h, c = place(i);
      const bool sphere = geometry == Geometry::spherical;
      const double low = lower + i * h, high = lower + (i + 1) * h, over_V = 1 / (sphere ? m * m + h * h / 12 : m);
      at(area_low, i) = (sphere ? low * low : low) * over_V;
      at(area_high, i) = (sphere ? high * high : high) * over_V;
      at(to_low, i) = h / (c - before);
      const double off = (c - m) / h, most = 1 + 2 * std::abs(off);
      at(back, i) = (0.5 + off) / most;
      at(ahead, i) = (0.5 - off) / most;
      at(reach, i) = most;
      at(level, i) = 0.5 + (sphere ? h / (12 * m) : 0.0);
      before = c;
    }
  }

 private:
  static constexpr int margin = 2;
  double& at(int q, int i) { return data_[size_t(q) * size_t(pitch_) + size_t(margin + i)]; }
  /// Of the shell with its middle at m. A shell around r = 0 (ghosts of an inner wall) counts as flat.
  static double centroid(Geometry geometry, double m, double h) {
    if (std::abs(m) < 0.49 * h) return m;
    return geometry == Geometry::spherical ? m + m * h * h / 6 / (m * m + h * h / 12) : m + h * h / (12 * m);
  }
  int n_ = 0, pitch_ = 0;
  Aligned<double> data_;
};

template <class Flow, class T>
class RadialKernel {
  static constexpr int n = Flow::n, n_flux = Flow::n_flux, w = Lane<T>::width, room = 4;

 public:
  explicit RadialKernel(int cells) : cells_(cells), pitch_(cells + room + 14), shells_(cells) {
    minus_.assign(size_t(n) * size_t(pitch_), 0.0), plus_ = minus_;
    flux_.assign(size_t(n_flux + 1) * size_t(pitch_), 0.0);
  }

  /// As BlockKernel::advance, for a block of shells; mirror as in ShellRow::fill.
  void advance(const Patch& patch, const Flow& flow, double dt, unsigned mirror, BlockChange& change) {
    const BlockShape& s = patch.shape();
    shells_.fill(s.geometry, patch.lower.x, s.h.x, mirror);
    change.scaled_cells = 0;
    for (auto& side : change.side) std::fill(side, side + change.rows, 0.0);
    predict(patch, flow, dt / s.h.x, change);
    for (int q = 0; q < n; ++q) {
      const double sign = q == Flow::v ? -1 : 1;
      if (mirror & 1) face(plus_, q)[-1] = sign * face(minus_, q)[0];
      if (mirror & 2) face(minus_, q)[cells_] = sign * face(plus_, q)[cells_ - 1];
    }
    solve(patch, flow);
    add_up(patch, flow, dt / s.h.x, change);
  }

 private:
  double* face(Aligned<double>& rows, int q) const { return rows.data() + size_t(q) * size_t(pitch_) + room; }
  T shell(int q, int i) const { return Lane<T>::load(shells_.row(q) + i); }

  /// States at the faces half a step later.
  void predict(const Patch& patch, const Flow& flow, double lambda, BlockChange& change) {
    const double* W[n];
    for (int q = 0; q < n; ++q) W[q] = patch.row(flow.prim_row(q), 0, 0);
    const double* rho_c2_row = patch.row(Prim::rho_c2, 0, 0);
    const double* dPi_row = patch.row(Prim::dPi, 0, 0);
    const double* order = patch.limited ? patch.row(Prim::order, 0, 0) : nullptr;
    const T k[3] = {T(0.5 * lambda), T(0), T(0)};
    for (int i = -1; i <= cells_; i += w) {
      T mean[n], half[n], slope[3][n];
      const T to_low = shell(ShellRow::to_low, i), to_high = shell(ShellRow::to_low, i + 1),
              reach = shell(ShellRow::reach, i);
      for (int q = 0; q < n; ++q) {
        mean[q] = half[q] = Lane<T>::load(W[q] + i);
        slope[0][q] = MonotonizedCentral::slope(to_low * (mean[q] - Lane<T>::load(W[q] + i - 1)),
                                                to_high * (Lane<T>::load(W[q] + i + 1) - mean[q]));
        slope[1][q] = slope[2][q] = T(0);
      }
      if constexpr (Flow::materials > 2)
        flow.balance(slope[0], [&](int m) {
          const double* a = patch.row(Prim::part(m), 0, 0) + i;
          const T middle = Lane<T>::load(a);
          return MonotonizedCentral::slope(to_low * (middle - Lane<T>::load(a - 1)), to_high * (Lane<T>::load(a + 1) - middle));
        });
      const T rho_c2 = Lane<T>::load(rho_c2_row + i), dPi = Lane<T>::load(dPi_row + i);
      Flow::predict(half, slope, k, rho_c2, dPi);
      const T dv = reach * slope[0][Flow::v], v_low = mean[Flow::v] - shell(ShellRow::back, i) * dv,
              v_high = mean[Flow::v] + shell(ShellRow::ahead, i) * dv;
      const T spread =
          k[0] * (shell(ShellRow::area_high, i) * v_high - shell(ShellRow::area_low, i) * v_low - slope[0][Flow::v]);
      expand(mean, half, spread, rho_c2, dPi);
      if (order) {
        const T keep = Lane<T>::load(order + i);
        for (int q = 0; q < n; ++q) {
          half[q] = mean[q] + keep * (half[q] - mean[q]);
          slope[0][q] = keep * slope[0][q];
        }
      }
      for (int q = 0; q < n; ++q) slope[0][q] = reach * slope[0][q];
      const auto scaled = keep_faces_positive(flow, mean, half, slope);
      if (any(scaled))
        for (int l = 0; l < w; ++l) change.scaled_cells += bit(scaled, l) && i + l >= 0 && i + l < cells_;
      const T back = shell(ShellRow::back, i), ahead = shell(ShellRow::ahead, i);
      T low[n], high[n];
      for (int q = 0; q < n; ++q) {
        low[q] = half[q] - back * slope[0][q];
        high[q] = half[q] + ahead * slope[0][q];
      }
      if constexpr (Flow::materials == 2)
        if (flow.interface.sharpness > 0) {
          const double* a = W[Prim::alpha1] + i;
          const SharpCell<T> cell(flow.interface, mean, k[0] * slope[0][Flow::v] / reach + spread, dPi);
          sharpen(cell, Lane<T>::load(a - 1), Lane<T>::load(a + 1), T(flow.interface.sharpness), T(lambda) * low[Flow::v],
                  T(lambda) * high[Flow::v], (order ? Lane<T>::load(order + i) : T(1)) > T(0), low, high);
        }
      for (int q = 0; q < n; ++q) {
        Lane<T>::store(face(minus_, q) + i, low[q]);
        Lane<T>::store(face(plus_, q) + i, high[q]);
      }
    }
  }
  static bool bit(const Mask& m, int l) { return m[l]; }
  static bool bit(bool m, int) { return m; }
  /// The half step's compression by what shells spread beyond slabs: spread = dt/2 (div v - dv/dr).
  static void expand(const T (&mean)[n], T (&half)[n], T spread, T rho_c2, [[maybe_unused]] T dPi) {
    half[0] -= mean[0] * spread;
    half[Flow::p] -= rho_c2 * spread;
    if constexpr (Flow::mixed) {
      half[Prim::arho2] -= mean[Prim::arho2] * spread;
      half[Prim::Pi] -= dPi * spread;
      for (int m = 2; m < Flow::materials; ++m) half[FaceRow::arho(m)] -= mean[FaceRow::arho(m)] * spread;
    }
  }

  /// The flux through each shell's lower face, and its velocity.
  void solve(const Patch& patch, const Flow& flow) {
    const double* c = patch.row(Prim::c, 0, 0);
    const double* arho1 = patch.row(Prim::arho1, 0, 0);
    const double* arho2 = patch.row(Prim::arho2, 0, 0);
    const double* z = Flow::mixed && patch.burns ? patch.row(Prim::stored_energy, 0, 0) : nullptr;
    const auto sound = [&](int i) -> Sound<T> {
      if constexpr (!Flow::mixed) return {Lane<T>::load(c + i), T(0)};
      T rho = Lane<T>::load(arho1 + i) + Lane<T>::load(arho2 + i);
      for (int m = 2; m < Flow::materials; ++m) rho += Lane<T>::load(patch.row(Prim::arho(m), 0, 0) + i);
      return {Lane<T>::load(c + i), rho};
    };
    for (int i = 0; i <= cells_; i += w) {
      T L[n], R[n], F[n_flux];
      for (int q = 0; q < n; ++q) {
        L[q] = Lane<T>::load(face(plus_, q) + i - 1);
        R[q] = Lane<T>::load(face(minus_, q) + i);
      }
      const T v_face = flow.template flux<0>(L, R, sound(i - 1), sound(i), F);
      if constexpr (Flow::mixed)
        if (z) F[Cons::rhoE] += F[Cons::arho1] * (T(0.5) * (Lane<T>::load(z + i - 1) + Lane<T>::load(z + i)));
      for (int q = 0; q < n_flux; ++q) Lane<T>::store(face(flux_, q) + i, F[q]);
      Lane<T>::store(face(flux_, n_flux) + i, v_face);
    }
  }

  void add_up(const Patch& patch, const Flow& flow, double lambda, BlockChange& change) {
    for (int q = 0; q < n_flux; ++q) {
      const int variable = flow.cons_row(q);
      const bool is_alpha = Flow::mixed && Cons::is_alpha(q);
      const double* alpha = patch.row(is_alpha ? Prim::alpha_of(q) : int(Prim::alpha1), 0, 0);
      const double *F = face(flux_, q), *v_face = face(flux_, n_flux);
      for (int upper = 0; upper < 2; ++upper)
        if (change.book_sides >> upper & 1) change.side[upper][variable] += lambda * F[upper * cells_];
      double* out = change.row(variable, 0, 0);
      for (int i = 0; i < cells_; i += w) {
        const T low = shell(ShellRow::area_low, i), high = shell(ShellRow::area_high, i);
        T in = Lane<T>::load(F + i), away = Lane<T>::load(F + i + 1);
        if (variable == Cons::mom) {
          const T p_low = Lane<T>::load(face(minus_, Flow::p) + i), p_high = Lane<T>::load(face(plus_, Flow::p) + i);
          const T push =
              p_low + shell(ShellRow::level, i) * (p_high - p_low);  // no product (it would fuse): see the file's head
          in -= push, away -= push;
        }
        T d = low * in - high * away;
        if (is_alpha)
          d -= Lane<T>::load(alpha + i) * (low * Lane<T>::load(v_face + i) - high * Lane<T>::load(v_face + i + 1));
        Lane<T>::store(out + i, T(lambda) * d);
      }
    }
  }

  int cells_, pitch_;
  ShellRow shells_;
  Aligned<double> minus_, plus_, flux_;
};

}  // namespace bw::cfd
