// SPDX-License-Identifier: Apache-2.0
// Programmed burn: the front leaves points, lines and discs at speed D, in straight lines or, where these leave the
// explosive, on the shortest way through it (cfd/source/paths.h); behind it the burnt share rises
// over a few cells,  lambda = clip((t - t_b) D/(width h), 0, 1),  t_b = start + distance/D. Unreleased energy is
// carried by the explosive's own mass flux (block_kernel.h adds F[arho1] q (1 - lambda) to the energy flux), so what is
// released is q per mass exactly, wherever the material moves meanwhile. The explosive is material 1.
#pragma once
#include <algorithm>
#include <vector>

#include "cfd/amr/patch.h"
#include "cfd/source/light.h"

namespace bw::cfd {

struct Burn {
  std::vector<Vec3> points;  ///< [m]
  std::vector<LineLight> lines;
  std::vector<DiscLight> discs;
  WayTable ways;      ///< empty: straight lines
  double start = 0;   ///< s
  double D = 0;       ///< m/s
  double width = 3;   ///< of the front, in cells
  double h = 0;       ///< cell size where it burns [m]
  double margin = 0;  ///< largest cell size [m]
  double q = 0;       ///< energy released per mass of explosive [J/kg]
  double c_CJ = 0;    ///< speed of sound behind the front [m/s], for the step
  double t_all = 0;   ///< everything is burnt from here on [s]

  /// In straight lines.
  double straight(const Vec3& x) const {
    double least = 1e300;
    for (const Vec3& p : points) least = std::min(least, norm(x - p));
    for (const LineLight& l : lines) least = std::min(least, norm(x - l.nearest(x)));
    for (const DiscLight& d : discs) least = std::min(least, norm(x - d.nearest(x)));
    return least;
  }
  double distance(const Vec3& x) const { return ways.empty() ? straight(x) : straight(x) + ways.more(x); }
  /// lambda at distance r from where it was lit.
  double burnt(double r, double t) const { return std::clamp(((t - start) * D - r) / (width * h), 0.0, 1.0); }
  /// q (1 - lambda): energy per mass still stored at x.
  double stored(const Vec3& x, double t) const { return q * (1 - burnt(distance(x), t)); }

  enum class Phase { before, during, after };
  /// Does lambda change between t0 and t1, or differ from its neighbours, anywhere in the box (which is widened by a
  /// cell)?
  Phase phase(const Vec3& lower, const Vec3& upper, double t0, double t1) const {
    double near = 1e300, far = 1e300;
    for (const Vec3& p : points) {
      double least = 0, most = 0;
      for (int d = 0; d < 3; ++d) {
        const double below = lower[d] - margin - p[d], above = p[d] - upper[d] - margin;
        const double gap = std::max({below, above, 0.0}), reach = std::max(-below, -above);
        least += gap * gap, most += reach * reach;
      }
      near = std::min(near, std::sqrt(least)), far = std::min(far, std::sqrt(most));
    }
    if (!lines.empty() || !discs.empty()) {
      const Vec3 middle = 0.5 * (lower + upper), half = 0.5 * (upper - lower) + Vec3{margin, margin, margin};
      const double at_middle = straight(middle), reach = norm(half);
      near = std::min(near, at_middle - reach), far = std::min(far, at_middle + reach);
    }
    if (!ways.empty()) far += ways.most;
    if (burnt(near, t1) == 0) return Phase::before;
    return burnt(far, t0) == 1 ? Phase::after : Phase::during;
  }
  bool active(double t0, double t1) const { return t1 > start && t0 < t_all; }
};

/// Row Prim::stored_energy of the patch at time t, one layer of ghosts.
inline void fill_stored_energy(const Burn& burn, double t, Patch& patch) {
  const BlockShape& s = patch.shape();
  const int g[3] = {s.used[0], s.used[1], s.used[2]};
  for (int k = -g[2]; k < s.n[2] + g[2]; ++k)
    for (int j = -g[1]; j < s.n[1] + g[1]; ++j) {
      double* row = patch.row(Prim::stored_energy, k, j);
      for (int i = -g[0]; i < s.n[0] + g[0]; ++i)
        row[i] = burn.stored(patch.lower + Vec3{(i + 0.5) * s.h.x, (j + 0.5) * s.h.y, (k + 0.5) * s.h.z}, t);
    }
  patch.burns = true;
}

}  // namespace bw::cfd
