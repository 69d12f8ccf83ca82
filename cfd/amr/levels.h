// SPDX-License-Identifier: Apache-2.0
// Cells of one level from those of the next: the mean of the finer ones under a cell, and the finer ones in a cell from
// limited slopes of its primitive variables, so that pressure and velocity stay constant where they are, whatever the
// materials do (a contact).
#pragma once
#include <algorithm>
#include <cmath>

#include "cfd/amr/patch.h"
#include "common/math/pack.h"

namespace bw::cfd {

/// Mean over the cells of the finer block's variable U under one coarse cell; (k, j, i): the first of them. Pairs are
/// added first: the mean of equal numbers is that number, bit for bit.
inline double mean_of_children(const double* U, const BlockShape& s, int k, int j, int i) {
  const auto along_x = [&](int kk, int jj) {
    const double* u = U + s.at(kk, jj, i);
    return s.used[0] ? u[0] + u[1] : u[0];
  };
  const auto along_y = [&](int kk) { return s.used[1] ? along_x(kk, j) + along_x(kk, j + 1) : along_x(kk, j); };
  const double sum = s.used[2] ? along_y(k) + along_y(k + 1) : along_y(k);
  return sum * ((s.used[0] ? 0.5 : 1.0) * (s.used[1] ? 0.5 : 1.0) * (s.used[2] ? 0.5 : 1.0));
}

/// The smaller of two differences of the same sign, else 0: values stay positive in three directions at once, as a
/// quarter of three such slopes is less than the value.
inline double minmod(double a, double b) { return a * b <= 0 ? 0.0 : std::abs(a) < std::abs(b) ? a : b; }

/// The children of a cell in Morton order: the quarter of its width by which each is off the centre, and how many cells
/// of its block's storage lie between it and the first. Zeros up to whole packs.
struct Children {
  int count = 0;
  double off[3][8] = {};
  size_t cells[8] = {};
};

/// Limited slopes of what is carried to finer cells: the variables before Prim::Pi (that one follows), and the further
/// ones of K > 2 materials.
template <int K>
struct CellSlopes {
  static constexpr int n = Prim::Pi + (K > 2 ? FaceRow::rows(K) - Prim::count : 0);
  /// The row of Prim.
  static constexpr int row(int q) { return q < Prim::Pi ? q : FaceRow::prim(q + 1); }
  double slope[3][n] = {};
  bool any = false;
  void set(int d, const double* below, const double* here, const double* above) {
    for (int q = 0; q < n; ++q) {
      slope[d][q] = minmod(here[row(q)] - below[row(q)], above[row(q)] - here[row(q)]);
      any = any || slope[d][q] != 0;
    }
    if constexpr (K > 2) balance(slope[d]);
  }
  /// W of Pack::size children from `first` on.
  void children(const double* W, const Children& all, int first, Pack* out) const {
    const Pack x = Pack::load(all.off[0] + first), y = Pack::load(all.off[1] + first),
               z = Pack::load(all.off[2] + first);
    for (int q = 0; q < n; ++q)
      out[row(q)] = Pack(W[row(q)]) + x * Pack(slope[0][q]) + y * Pack(slope[1][q]) + z * Pack(slope[2][q]);
  }
  /// W of the child at side[d] (-1, 1; 0 in unused directions) of a cell.
  void child(const double* W, const int (&side)[3], double* out) const {
    for (int q = 0; q < n; ++q) {
      double change = 0;
      for (int d = 0; d < 3; ++d) change += side[d] * slope[d][q];
      out[row(q)] = W[row(q)] + 0.25 * change;
    }
  }

 private:
  /// As ManyFlow::balance.
  static void balance(double (&s)[n]) {
    const auto at = [](int face_row) { return face_row < Prim::Pi ? face_row : face_row - 1; };
    double rise = 0, fall = 0;
    for (int k = 0; k < K; ++k) {
      const double a = s[at(FaceRow::alpha(k))];
      (a > 0 ? rise : fall) += std::abs(a);
    }
    const double share = std::min(rise, fall) / std::max(std::max(rise, fall), 1e-300);
    for (int k = 0; k < K; ++k) {
      const double a = s[at(FaceRow::alpha(k))];
      if (rise > fall ? a > 0 : a < 0) s[at(FaceRow::alpha(k))] *= share, s[at(FaceRow::arho(k))] *= share;
    }
  }
};

/// visit(child number, its offset {0, 1} per direction, its side {-1, 1}, 0 in unused directions), in Morton order.
template <class Visit>
void for_each_child(const BlockShape& s, const Visit& visit) {
  int number = 0;
  for (int c = 0; c < 8; ++c) {
    int offset[3], side[3];
    bool exists = true;
    for (int d = 0; d < 3; ++d) {
      offset[d] = c >> d & 1;
      side[d] = s.used[size_t(d)] ? 2 * offset[d] - 1 : 0;
      exists = exists && (s.used[size_t(d)] || offset[d] == 0);
    }
    if (exists) visit(number++, offset, side);
  }
}
inline Children children_of(const BlockShape& s) {
  Children all;
  for_each_child(s, [&](int c, const int(&at)[3], const int(&side)[3]) {
    all.count = c + 1;
    for (int d = 0; d < 3; ++d) all.off[d][c] = 0.25 * side[d];
    all.cells[c] = s.at(at[2], at[1], at[0]);
  });
  return all;
}
inline int child_count(const BlockShape& s) { return 1 << (int(s.used[0]) + int(s.used[1]) + int(s.used[2])); }

/// U of the children of a cell, in the order of for_each_child, that add up to it: mass by the slopes' symmetry,
/// momentum by a common shift of velocity, energy by a common shift of pressure; both shifts are zero at a contact.
/// more: energy per mass of material 1 stored at the child above that stored at the cell [J/kg]. Children that would
/// leave the range of states become copies of the cell.
template <class Mix>
void split_cell(const Mix& mix, double p_floor, const BlockShape& shape, const double (&U)[Mix::n_cons],
                const double* W, const CellSlopes<Mix::materials>& slopes, const double (&more)[8],
                double (&out)[8][Mix::n_cons]) {
  const int n = child_count(shape);
  double kept = 0;
  for (int i = 0; i < n; ++i) kept += more[i] * U[Cons::arho1] / n;
  const auto copy = [&] {
    for (int i = 0; i < n; ++i)
      for (int q = 0; q < Mix::n_cons; ++q) out[i][q] = U[q] - (q == Cons::rhoE ? kept : 0.0);
  };
  if (!slopes.any) return copy();
  double w[8][Mix::n_prim], shift[3];
  for_each_child(shape, [&](int i, const int(&)[3], const int(&side)[3]) { slopes.child(W, side, w[i]); });
  double rho = U[Cons::arho1] + U[Cons::arho2];
  for (int k = 2; k < Mix::materials; ++k) rho += U[Cons::arho(k)];
  for (int d = 0; d < 3; ++d) {
    double mean = 0;
    for (int i = 0; i < n; ++i) {
      double own = w[i][Prim::arho1] + w[i][Prim::arho2];
      for (int k = 2; k < Mix::materials; ++k) own += w[i][Prim::arho(k)];
      mean += own * w[i][Prim::v + d] / n;
    }
    shift[d] = (U[Cons::mom + d] - mean) / rho;
  }
  double energy = 0, stiffness = 0;
  for (int i = 0; i < n; ++i) {
    for (int d = 0; d < 3; ++d) w[i][Prim::v + d] += shift[d];
    mix.to_conserved(w[i], out[i]);
    energy += (out[i][Cons::rhoE] + more[i] * out[i][Cons::arho1]) / n;
    stiffness += mix.G(w[i]) / n;
  }
  const double p_shift = (U[Cons::rhoE] - energy) / stiffness;
  bool fine = std::isfinite(p_shift);
  for (int i = 0; i < n; ++i) {
    fine = fine && w[i][Prim::p] + p_shift > std::max(p_floor, 0.1 * W[Prim::p]);
    out[i][Cons::rhoE] += p_shift * mix.G(w[i]);
  }
  if (!fine) copy();
}

}  // namespace bw::cfd
