// SPDX-License-Identifier: Apache-2.0
// Face states of a cell stay physical: if a density, the pressure or a volume fraction would leave its range at one of
// the faces, the whole deviation from the cell's mean (half step and slopes, all variables alike) is scaled back.
#pragma once
#include "cfd/scheme/flow_model.h"

namespace bw::cfd {

/// What remains at a face of a cell's own density and pressure, at least.
inline constexpr double face_share = 0.05;

namespace detail {
/// Largest theta in [0, 1] with mean + theta (low - mean) >= face_share mean.
template <class T>
T theta_above(T mean, T low) {
  const T room = (1 - face_share) * mean, fall = mean - low;
  return select(fall > room, room / max(fall, T(1e-300)), T(1));
}
template <int n, class T>
T reach(const T (&slope)[3][n], int q) {
  return T(0.5) * max(max(abs(slope[0][q]), abs(slope[1][q])), abs(slope[2][q]));
}
}  // namespace detail

/// mean: the cell's W; half: W after the half step. Scales half and slope. Returns the mask of the cells that were
/// scaled.
template <class Flow, class T>
[[gnu::always_inline]] inline auto keep_faces_positive(const Flow&, const T (&mean)[Flow::n], T (&half)[Flow::n],
                                                       T (&slope)[3][Flow::n]) {
  using detail::reach, detail::theta_above;
  constexpr int p = Flow::p;
  T low_p = half[p] - reach(slope, p), low_1 = half[0] - reach(slope, 0), low_2 = T(0), low_a = T(0), high_a = T(0);
  auto bad = (low_p < face_share * mean[p]) | (low_1 < face_share * mean[0]);
  if constexpr (Flow::materials > 2) {
    for (int k = 0; k < Flow::materials; ++k)
      for (const int q : {FaceRow::arho(k), FaceRow::alpha(k)})
        bad = bad | (half[q] - reach(slope, q) < face_share * mean[q]);
  } else if constexpr (Flow::mixed) {
    constexpr int a = Prim::alpha1;
    const T r = reach(slope, a);
    low_2 = half[1] - reach(slope, 1);
    low_a = half[a] - r;
    high_a = half[a] + r;
    bad = bad | (low_2 < face_share * mean[1]) | (low_a < face_share * mean[a]) |
          (T(1) - high_a < face_share * (T(1) - mean[a]));
  }
  if (!any(bad)) return bad;
  T theta = min(theta_above(mean[p], low_p), theta_above(mean[0], low_1));
  if constexpr (Flow::materials > 2) {
    for (int k = 0; k < Flow::materials; ++k)
      for (const int q : {FaceRow::arho(k), FaceRow::alpha(k)})
        theta = min(theta, theta_above(mean[q], half[q] - reach(slope, q)));
  } else if constexpr (Flow::mixed) {
    constexpr int a = Prim::alpha1;
    theta = min(theta, min(theta_above(mean[1], low_2),
                           min(theta_above(mean[a], low_a), theta_above(T(1) - mean[a], T(1) - high_a))));
  }
  theta = max(theta, T(0));
  for (int q = 0; q < Flow::n; ++q) {
    half[q] = select(bad, mean[q] + theta * (half[q] - mean[q]), half[q]);
    for (int d = 0; d < 3; ++d) slope[d][q] = select(bad, theta * slope[d][q], slope[d][q]);
  }
  return bad;
}

}  // namespace bw::cfd
