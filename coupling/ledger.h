// SPDX-License-Identifier: Apache-2.0
// The books of the interface: what the fluid gave against what the solid got, window by window (COUPLING, Ledger).
// A row of coupling_history.csv per window; a defect of impulse beyond round-off is a bug and ends the run.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "coupling/loads.h"

namespace bw::coupling {

/// What the solid received from the face forces in one or more substeps.
struct SolidTotals {
  Vec3 impulse;     ///< N s
  Vec3 moment;      ///< N m s about the origin
  double work = 0;  ///< J
  int64_t substeps = 0;
  SolidTotals& operator+=(const SolidTotals& b);
};

/// Totals of one substep: nodal forces f [N] held over h, nodes going from x_before to x_after. Sums in node order.
/// `moment` uses the lever at the window's start, `x_window`, where the face forces were made.
SolidTotals substep_totals(std::span<const Vec3> f, std::span<const Vec3> x_window, std::span<const Vec3> x_before,
                           std::span<const Vec3> x_after, double h);

/// A window's entries, and the sums since the start.
struct LedgerRow {
  int64_t window = 0;
  double t0 = 0, t1 = 0;
  SolidTotals solid;
  FluidTotals fluid;
  Vec3 advance;              ///< N s since the start, that the solid has got beyond the fluid's, to be given back
  Vec3 impulse_defect;       ///< N s, solid - (fluid + p_ref A dt)
  Vec3 moment_defect;        ///< N m s, likewise
  double impulse_scale = 0;  ///< N s, sum |P A| dt
  double moment_scale = 0;   ///< N m s, sum |P A| |x| dt
  double volume_gap = 0;     ///< m^3, solid's surface beyond the fluid's wall at t1 (fluid_first), before it is repaid
  int64_t born = 0, dead = 0;  ///< faces that came and went with this window's surface
  double added_mass = 0;       ///< 1, largest (impedance x dt / areal mass) of a face, set by SolidSide
  double area = 0;             ///< m^2
  double work_fluid = 0;       ///< J, the fluid's work beyond the reference pressure
  double work_fluid_sum = 0, work_solid_sum = 0;  ///< J since the start, beyond the reference pressure
};

/// The whole run.
struct LedgerSums {
  int64_t windows = 0, born = 0, dead = 0;
  int64_t dry_most = 0;               ///< faces without fluid, most of a window
  Vec3 impulse_fluid, impulse_solid;  ///< N s, of P - p_ref
  Vec3 moment_fluid, moment_solid;    ///< N m s
  double impulse_defect = 0;          ///< largest of a window, of sum |P A| dt
  double moment_defect = 0;           ///< largest of a window, of sum |P A| |x| dt
  int64_t moments_lost = 0;           ///< windows in which it was beyond round-off
  double gap_most = 0;                ///< m^3, largest volume gap of a window
  double mass_first = 0;              ///< kg, of the fluid at the end of the first window
};

class Ledger {
 public:
  /// impulse_tolerance: of sum |P A| dt.
  explicit Ledger(double p_ref, double impulse_tolerance = 1e-12) : p_ref_(p_ref), tolerance_(impulse_tolerance) {}

  /// The coming window's surface (x at t0; v as announced to the fluid), to stay as it is until close(). What does not
  /// ask for the fluid's answer is summed up here, while the fluid is at it.
  void begin(const WetSurface& surface);
  /// That answer, for that surface.
  void open(const Window& window, const Loads& loads);
  void add(const SolidTotals& substep) { row_.solid += substep; }
  /// Impulse [N s] and work [J] of forces inside the window that are no part of the fluid's answer.
  void add_advance(const Vec3& impulse, double work) {
    row_.advance += impulse;
    row_.solid.work += work;
  }
  /// The window ends; nodes of the opened surface are at x_end [n_nodes] (empty: unknown, then no gap). The text is a
  /// failure (impulse not conserved), to be given to Channel::fail(exit_ledger).
  std::optional<std::string> close(std::span<const Vec3> x_end = {});
  void set_added_mass(double share) { row_.added_mass = share; }
  const LedgerRow& row() const { return row_; }
  const LedgerSums& sums() const { return sums_; }
  size_t face_count() const { return area_.size(); }
  /// In a checkpoint, between two windows.
  template <class A>
  void keep(A& a) {
    a.value("row", row_), a.value("sums", sums_), a.value("first", first_), a.list("face_id", face_id_);
    if (a.restores()) topo_version_ = -1;  // the next surface is looked at anew
  }

 private:
  void add_to_sums(double tolerance);

  double p_ref_, tolerance_;
  bool first_ = true;
  int64_t topo_version_ = -1;
  const WetSurface* surface_ = nullptr;  // of the window in hand
  std::vector<int64_t> face_id_;
  int64_t born_ = 0, dead_ = 0;                // of its faces
  std::vector<Vec3> area_;                     // [n_faces] m^2, at the window's start
  std::vector<double> size_, lever_;           // [n_faces] m^2, m: of these, and of their centres
  Vec3 area_sum_, moment_sum_;                 // m^2, m^3
  double size_sum_ = 0;                        // m^2
  Vec3 reference_impulse_, reference_moment_;  // of p_ref A dt
  LedgerRow row_;
  LedgerSums sums_;
};

}  // namespace bw::coupling
