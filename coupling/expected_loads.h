// SPDX-License-Identifier: Apache-2.0
// The answer that a solid may expect of a fluid that is still computing it (scheme concurrent).
//
// What comes towards a face, I = P - Z W, is carried on from the windows before; what the face itself does, Z W, is
// known: P = I + Z W, with the fluid's impedance Z and the velocity W of its wall into the fluid. Waves that leave are
// then right at once, as in linear acoustics, and only the wave that comes in is a window late.
#pragma once
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "coupling/loads.h"
#include "coupling/wall_path.h"

namespace bw::coupling {

class ExpectedLoads {
 public:
  explicit ExpectedLoads(double p_ref) : p_ref_(p_ref) {}

  /// A window as announced: where the fluid's walls go in it. Every window.
  void begin(const Window& window, const WetSurface& surface);
  /// Something was answered before.
  bool are_known() const { return !faces_.empty(); }
  /// For the window begun, which ends at t1. Faces that the last answer did not have get p_ref.
  Loads expect(const WetSurface& surface, double t1) const;
  /// The answer has come.
  void answered(const WetSurface& surface, const Loads& loads);

  /// In a checkpoint, between two windows.
  template <class A>
  void keep(A& a) {
    std::vector<int64_t> ids;
    std::vector<double> values;
    for (const Face& f : list_)
      ids.push_back(f.id), values.insert(values.end(), {f.incoming, f.rise, f.slope, f.middle, f.impedance});
    a.list("face_ids", ids), a.list("face_values", values);
    list_.clear();
    for (size_t i = 0; i < ids.size(); ++i)
      list_.push_back(
          {ids[i], values[5 * i], values[5 * i + 1], values[5 * i + 2], values[5 * i + 3], values[5 * i + 4]});
    index();
    path_.keep(a);
  }

 private:
  struct Face {
    int64_t id;
    double incoming;   // Pa, mean of the last window
    double rise;       // Pa/s, from the window before
    double slope;      // Pa/s, that is carried on
    double middle;     // s, of that window
    double impedance;  // kg/(m^2 s); 0: unknown
  };
  /// [n_faces] m/s into the fluid, of walls that end at t1.
  std::vector<double> speeds(const WetSurface& surface, double t1) const;
  void index();

  double p_ref_;
  Window window_;
  WallPath path_;
  std::vector<Face> list_;                     // of the last answer
  std::unordered_map<int64_t, size_t> faces_;  // id -> place
};

}  // namespace bw::coupling
