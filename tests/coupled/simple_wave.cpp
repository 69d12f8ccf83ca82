// SPDX-License-Identifier: Apache-2.0
// A fluid program without cells: gas at rest on the lower side of every wet face with a normal towards -x, which feels
// the exact simple wave
//   p = p0 (c/c0)^(2 gamma/(gamma - 1)),   c = c0 - (gamma - 1)/2 u,   u: velocity of the wall along +x,
// so that the real csd can be held against the exact piston (VALIDATION C1).
//   mpirun -n 1 csd case.toml : -n 1 coupled_simple_wave <scheme> <window, s> [reference pressure, Pa]
#include <cmath>

#include "common/app/guarded.h"
#include "common/app/log.h"
#include "coupling/fluid_side.h"
#include "coupling/join.h"
#include "coupling/wall_path.h"

int main(int argc, char** argv) {
  using namespace bw;
  using namespace bw::coupling;
  Session session(argc, argv);
  set_speaker("gas", true);
  return guarded(session, [&] {
    constexpr double rho0 = 1.225, p0 = 101325, gas_gamma = 1.4;
    const double c0 = std::sqrt(gas_gamma * p0 / rho0);
    CouplingCase cs;
    cs.scheme = argv[1];
    cs.reference_pressure = argc > 3 ? std::stod(argv[3]) : 0;
    const double dt_window = std::stod(argv[2]);
    const Joined joined = join(session, Role::fluid, cs);
    FluidSide side(*joined.channel, cs,
                   {.program = "simple wave", .version = "1", .lower = {-1, -1, -1}, .upper = {1, 1, 1}});
    WallPath path;
    while (side.receive()) {
      const Window& window = side.window();
      const WetSurface& wet = side.surface();
      path.begin(window, wet);
      Loads loads;
      // the last two windows before a limit share what is left
      const double left = window.t1_max - window.t0;
      loads.t1 = left <= dt_window * (1 + 1e-9) ? window.t1_max
                 : left < 2 * dt_window         ? window.t0 + 0.5 * left
                                                : window.t0 + dt_window;
      const double dt = loads.t1 - window.t0;
      const std::vector<Vec3> v = path.velocity(dt);
      for (const auto& quad : wet.quads) {
        const Vec3 area = area_vector(wet.x, quad);
        const double c = 1 - 0.5 * (gas_gamma - 1) * face_mean(v, quad).x / c0;  // of c0
        loads.p.push_back(area.x < 0 ? p0 * std::pow(c, 2 * gas_gamma / (gas_gamma - 1)) : 0.0);
        loads.impedance.push_back(area.x < 0 ? rho0 * c0 * std::pow(c, (gas_gamma + 1) / (gas_gamma - 1)) : 0.0);
      }
      loads.totals = wall_totals(wet, loads, v, window);
      path.end(dt);
      side.send(loads);
    }
    return 0;
  });
}
