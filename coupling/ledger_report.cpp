// SPDX-License-Identifier: Apache-2.0
#include "coupling/ledger_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace bw::coupling {
namespace {

constexpr double bound = 0.01;  // of work

std::string text(const Vec3& v) { return fmt::format("({:.6g}, {:.6g}, {:.6g})", v.x, v.y, v.z); }

double percent(double part, double whole) { return whole > 0 ? 100 * part / whole : 0; }

}  // namespace

LedgerReport report(const Ledger& ledger, double kinetic) {
  const LedgerRow& last = ledger.row();
  const LedgerSums& sums = ledger.sums();
  const FluidTotals& fluid = last.fluid;
  LedgerReport r;
  const auto say = [&]<class... A>(fmt::format_string<A...> line, A&&... values) {
    r.lines.push_back(fmt::format(line, std::forward<A>(values)...));
  };
  say("impulse  fluid {}, solid {} N s; largest defect of a window {:.1e} of sum |P A| dt", text(sums.impulse_fluid),
      text(sums.impulse_solid), sums.impulse_defect);
  say("moment   fluid {}, solid {} N m s; largest defect of a window {:.1e} of sum |P A| |x| dt",
      text(sums.moment_fluid), text(sums.moment_solid), sums.moment_defect);
  if (norm(last.advance) > 0)
    say("advance  {} N s that the solid has got beyond that, due back in the next window", text(last.advance));
  if (sums.moments_lost > 0) r.lost.push_back(fmt::format("moment in {} windows", sums.moments_lost));

  const double between = last.work_fluid_sum - last.work_solid_sum;
  const double scale = std::max(kinetic, std::abs(last.work_solid_sum));
  say("work     fluid {:.6g}, solid {:.6g} J; between them {:+.2g} J, {:+.2g} % of the solid's kinetic energy or work",
      last.work_fluid_sum, last.work_solid_sum, between, percent(between, scale));
  if (std::abs(between) > bound * scale) r.lost.push_back(fmt::format("work, {:+.2g} %", percent(between, scale)));

  const double area = last.area > 0 ? last.area : 1;
  say("gap      solid beyond the fluid's walls {:.2g} m^3 at the end, at most {:.2g} m^3; {:.2g}, {:.2g} m over the "
      "wet area",
      last.volume_gap, sums.gap_most, last.volume_gap / area, sums.gap_most / area);
  say("faces    {} at the end; {} born, {} died, at most {} dry at a time", ledger.face_count(), sums.born, sums.dead,
      sums.dry_most);
  if (!(fluid.mass > 0)) return r;  // one that keeps no such books
  say("fluid    mass {:.6g} kg, {:+.2g} % since the first window, energy {:.6g} J; cells that walls covered took "
      "{:.3g} kg, {:.3g} J, uncovered ones brought {:.3g} kg, {:.3g} J",
      fluid.mass, percent(fluid.mass - sums.mass_first, sums.mass_first), fluid.energy, fluid.mass_covered,
      fluid.energy_covered, fluid.mass_uncovered, fluid.energy_uncovered);
  return r;
}

}  // namespace bw::coupling
