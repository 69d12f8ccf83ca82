// SPDX-License-Identifier: Apache-2.0
// Order in time of a coupling scheme, with both programs exact inside a window: a closed volume of gas (isentropic,
// uniform) drives a piston on a spring. Episodes of the same 3.2 periods with N, 2N, 4N ... windows follow each other
// in one run; a new episode has a new surface.
//   mpirun -n 1 coupled_piston solid <scheme> : -n 1 coupled_piston fluid <scheme>
#include <cmath>

#include "common/app/guarded.h"
#include "common/app/log.h"
#include "coupling/fluid_side.h"
#include "coupling/join.h"
#include "coupling/solid_side.h"
#include "coupling/wall_path.h"

namespace {

using namespace bw;
using namespace bw::coupling;

constexpr double gas_gamma = 1.4, p0 = 1e5, volume0 = 1, mass = 50, stiffness = 2e6, v0 = 20, duration = 0.1;
constexpr int coarsest = 128, episodes = 4;

double gas_pressure(double volume) { return p0 * std::pow(volume0 / volume, gas_gamma); }
double gas_energy(double volume) { return gas_pressure(volume) * volume / (gas_gamma - 1); }
double total_energy(double x, double v) {
  return 0.5 * mass * v * v + 0.5 * stiffness * x * x + p0 * x + gas_energy(volume0 + x);
}

/// Time's (and volume's) mean of the pressure while the volume goes from a to b.
double mean_pressure(double a, double b) {
  if (std::abs(b - a) < 1e-12) return gas_pressure(a);
  return (gas_energy(a) - gas_energy(b)) / (b - a);
}

double acceleration(double x, double p) { return (p - p0 - stiffness * x) / mass; }

/// The oscillator without coupling errors at the ends of the coarsest windows, by central differences with so many
/// steps that their own error does not count.
std::vector<double> exact_motion() {
  constexpr int steps = 1 << 14;  // a window
  const double h = duration / coarsest / steps;
  std::vector<double> at{0};
  double x = 0, v = v0;
  for (int i = 1; i <= coarsest * steps; ++i) {
    v += 0.5 * h * acceleration(x, gas_pressure(volume0 + x));
    x += h * v;
    v += 0.5 * h * acceleration(x, gas_pressure(volume0 + x));
    if (i % steps == 0) at.push_back(x);
  }
  return at;
}

/// A square metre across the x axis; the gas is on its lower side.
WetSurface face_at(double x, double v, int64_t episode) {
  WetSurface s;
  s.topo_version = episode;
  s.x = {{x, 0, 0}, {x, 0, 1}, {x, 1, 1}, {x, 1, 0}};
  s.v.assign(4, {v, 0, 0});
  s.quads = {{0, 1, 2, 3}};
  for (int64_t i = 0; i < 4; ++i) s.node_id.push_back(4 * episode + i);
  s.node_parent.assign(4, -1);
  s.face_id = {episode};
  s.body = {0};
  s.flags = {0};
  return s;
}

int run_solid(Channel& channel, const CouplingCase& cs) {
  SolidSide side(
      channel, cs,
      {.program = "piston", .version = "1", .t_end = episodes * duration, .lower = {0, 0, 0}, .upper = {0, 1, 1}}, "");
  const std::vector<double> exact = exact_motion();
  const double amplitude = v0 * std::sqrt(mass / stiffness), energy0 = total_energy(0, v0);
  double t = 0, error = 0, first_error = 0;
  for (int episode = 0; episode < episodes; ++episode) {
    const int windows = coarsest << episode;
    const double start = t, work_before = side.books().work_fluid_sum - side.books().work_solid_sum;
    const double error_before = error;
    double x = 0, v = v0, gap = 0, owed = 0;  // owed: Pa s
    error = 0;
    for (int w = 1; w <= windows; ++w) {
      const double t_next = episode + 1 == episodes && w == windows ? side.t_end() : start + duration * w / windows;
      WetSurface wet = face_at(x, v, episode);
      const double wet_time = t;
      side.send({.t0 = t, .t1_max = t_next, .dt_stable = 1e-5}, wet);
      const std::optional<Loads> expected = side.expect();
      const Loads loads = expected ? *expected : side.receive();
      const auto force = nodal_loads(wet, loads, cs.reference_pressure);
      const double p = loads.p[0] + owed / (loads.t1 - t);
      owed = 0;
      EqualSubsteps sub(t, loads.t1);
      WetSurface now = wet;
      while (!sub.done()) {
        const double h = sub.next(1e-5);
        const auto before = now.x;
        v += 0.5 * h * acceleration(x, p);
        x += h * v;
        v += 0.5 * h * acceleration(x, p);
        for (Vec3& node : now.x) node.x = x;
        if (!expected) side.add(substep_totals(force, wet.x, before, now.x, h));
        t = sub.advance();
      }
      if (expected) {
        const double dt = t - wet_time;
        const Loads& truth = side.receive();
        side.add(substep_totals(nodal_loads(wet, truth, cs.reference_pressure), wet.x, wet.x, now.x, dt));
        owed = (truth.p[0] - loads.p[0]) * dt;
      }
      side.end_window(now.x);
      gap = std::max(gap, std::abs(side.books().volume_gap));
      if (w % (1 << episode) == 0) error = std::max(error, std::abs(x - exact[size_t(w >> episode)]) / amplitude);
    }
    const double kinetic = 0.5 * mass * v0 * v0;
    const double work_defect = side.books().work_fluid_sum - side.books().work_solid_sum - work_before;
    say("N {:5d} error {:.3e} order {:.2f} energy {:+.3e} work defect {:+.3e} gap {:.1e}", windows, error,
        episode ? std::log2(error_before / error) : 0, (total_energy(x, v) - energy0) / kinetic, work_defect / kinetic,
        gap);
    if (episode == 0) first_error = error;
  }
  side.finish();
  const double order = std::log2(first_error / error) / (episodes - 1), wanted = cs.kind() == Scheme::box1 ? 0.95 : 1.9;
  say("order {:.2f}, wanted {}", order, wanted);
  return order >= wanted ? exit_ok : exit_physics;
}

int run_fluid(Channel& channel, const CouplingCase& cs) {
  FluidSide side(channel, cs, {.program = "gas", .version = "1", .lower = {-1, 0, 0}, .upper = {1, 1, 1}});
  WallPath path;
  while (side.receive()) {
    const WetSurface& wet = side.surface();
    const Window& window = side.window();
    path.begin(window, wet);
    const double dt = window.t1_max - window.t0, from = volume0 + path.x()[0].x, to = volume0 + path.x_end(dt)[0].x;
    Loads loads;
    loads.t1 = window.t1_max;
    loads.p = {window.mean_pressure ? mean_pressure(from, to) : gas_pressure(to)};
    loads.totals = wall_totals(wet, loads, path.velocity(dt), window);
    path.end(dt);
    side.send(loads);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Session session(argc, argv);
  const std::string role = argv[1];
  set_speaker(role, true);
  return guarded(session, [&] {
    CouplingCase cs;
    cs.scheme = argv[2];
    cs.reference_pressure = p0;
    const Joined joined = join(session, role == "solid" ? Role::solid : Role::fluid, cs);
    return role == "solid" ? run_solid(*joined.channel, cs) : run_fluid(*joined.channel, cs);
  });
}
