// SPDX-License-Identifier: Apache-2.0
#include "cfd/step.h"

#include <fmt/format.h>

#include <algorithm>

#include "cfd/adapt.h"
#include "cfd/afterburn.h"
#include "common/app/log.h"
#include "common/app/timers.h"

namespace bw::cfd {
namespace {

constexpr int most_tries = 8, told_repeats = 5;

void refresh(const Model& m, Books& books, const std::vector<int>& changed) {
  Timed timed("sums");
  books.refresh(m, changed);
}

/// The walls have moved or are new: cells that they freed get a state, and what changed hands is booked. changed: blocks
/// whose sums have changed already.
void follow_walls(Model& m, Sweep& sweep, Books& books, std::vector<int> changed = {}) {
  {
    Timed timed("covered and uncovered cells");
    sweep.refill(m.state, changed, books.swept);
  }
  std::sort(changed.begin(), changed.end());
  changed.erase(std::unique(changed.begin(), changed.end()), changed.end());
  refresh(m, books, changed);
}

/// Walls in place for a window of dt, which is shortened until they go no further than half a cell.
double place_walls(Model& m, Sweep& sweep, Books& books, const WallMotion& motion, double dt) {
  for (int i = 0;; ++i) {
    {
      Timed timed("walls");
      m.walls->begin(motion.surface(), motion.x(), motion.velocity(dt));
    }
    follow_walls(m, sweep, books);
    const double largest = m.walls->largest_step();
    if (largest >= dt || i == most_tries) {
      m.walls->set_step(dt, motion.x_end(dt));
      return dt;
    }
    dt = 0.9 * largest;
  }
}

/// Box 1, the fluid's part: fluxes, burn, limits; share: of the products' further energy that is released at its end;
/// false if the new state can't be used.
bool advance_flow(Model& m, Sweep& sweep, double dt, double share) {
  Timed timed("flow");
  sweep.exchange(m.state);
  if (m.setup.afterburn) sweep.burn_on(afterburn_energy(m, share));
  sweep.look(m.refine && (m.state.step + 1) % m.refine->every == 0 ? &*m.refine : nullptr);
  sweep.select(m.state, dt);
  sweep.advance(m.state);
  for (int i = 0; i < 3 && sweep.bad() > 0; ++i) sweep.repeat_first_order(m.state);
  return sweep.bad() == 0;
}

[[noreturn]] void fail(const Model& m, const Sweep& sweep, double dt) {
  const BadCell bad = sweep.first_bad();
  if (bad.block < 0) throw PhysicsError(fmt::format("another rank of the fluid has a state that can't be used at t = {:.9g} s", m.state.t));
  const BlockShape& s = m.forest.shape(bad.block);
  const Index3 first = m.forest.first_cell(bad.block);
  const int i = bad.cell % s.n[0], j = bad.cell / s.n[0] % s.n[1], k = bad.cell / (s.n[0] * s.n[1]);
  const Vec3 x = m.forest.lower(bad.block) + Vec3{(i + 0.5) * s.h.x, (j + 0.5) * s.h.y, (k + 0.5) * s.h.z};
  double u[Cons::most];
  for (int q = 0; q < m.state.rows(); ++q) u[q] = m.state.block(bad.block, q)[bad.cell];
  throw PhysicsError(fmt::format(
      "no valid state (density, pressure or a number) follows in cell ({}, {}, {}) at ({:.6g}, {:.6g}, {:.6g}) m, step {}, t = {:.9g} s, even "
      "with dt = {:.3g} s; before: density {:.6g} kg/m^3, momentum ({:.4g}, {:.4g}, {:.4g}), energy {:.6g} J/m^3, alpha {:.6g}",
      first[0] + i, first[1] + j, first[2] + k, x.x, x.y, x.z, m.state.step, m.state.t, dt, m.setup.medium.density(u), u[2], u[3], u[4], u[5], u[6]));
}

void book_walls(Model& m, Sweep& sweep, Books& books, double dt, const coupling::Loads& loads, const std::vector<Vec3>& v) {
  const WallExchange e = sweep.wall_exchange();
  books.wall_impulse += e.momentum;
  books.wall_energy += e.energy;
  books.wall_mass += e.mass;
  const coupling::FluidTotals t = coupling::wall_totals(m.walls->surface(), loads, v, coupling::Window{.t0 = 0, .t1_max = dt});
  books.face_impulse += t.impulse;
  books.face_work += t.work;
  books.lip_impulse += dt * m.walls->lip_force();
}

}  // namespace

double step(Model& m, Sweep& sweep, Books& books, double dt, const WallMotion* motion, bool mean, coupling::Loads* loads) {
  double share = 0;
  for (int i = 0;; ++i, dt *= 0.5) {
    if (m.walls) dt = place_walls(m, sweep, books, *motion, dt);
    share = share_after(m, dt);
    if (advance_flow(m, sweep, dt, share)) break;
    if (i == most_tries) fail(m, sweep, dt);
    if (books.repeated++ < told_repeats)
      warn("step {}, t = {:.6g} s: no valid state with dt = {:.3g} s; it is taken again at half of that{}", m.state.step, m.state.t, dt,
           books.repeated == told_repeats ? " (further ones are counted only)" : "");
  }
  sweep.commit(m.state);
  if (m.setup.afterburn) m.setup.afterburn->share = share;
  books.seconds_between_levels = sweep.seconds_between_levels();
  if (!m.walls) {
    refresh(m, books, sweep.active());
  } else {
    const std::vector<Vec3> v = m.walls->surface().v;
    if (!mean) sweep.measure_loads(m.state);
    {
      Timed timed("walls");
      m.forest.comm().sum(m.walls->values());
      if (m.walls->conservative()) m.walls->set_links(sweep.link_loads(), dt);
      *loads = m.walls->loads();
      loads->t1 = dt;
      book_walls(m, sweep, books, dt, *loads, v);
      m.walls->end(motion->x_end(dt));
    }
    follow_walls(m, sweep, books, sweep.active());
  }
  adapt(m, sweep, books);
  return dt;
}

}  // namespace bw::cfd
