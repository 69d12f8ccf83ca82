// SPDX-License-Identifier: Apache-2.0
// What an exchange costs: mpirun -n 1 bench_exchange solid <faces> : -n 1 bench_exchange fluid <faces>
// Both sides do nothing but exchange; the solid prints "geometry_ms <a>" (connectivity unchanged), "full_ms <b>" (new
// connectivity every window), both also of the fastest window (on a machine that is shared), and "wait_cpu_share <c>":
// processor time that the solid uses while it waits for a fluid that sleeps, and "late_ms <d>": how long after such a
// fluid has woken all ranks of the solid are through the exchange.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>

#include "common/app/machine.h"
#include "coupling/fluid_side.h"
#include "coupling/join.h"
#include "coupling/solid_side.h"

namespace {

using namespace bw;
using namespace bw::coupling;

constexpr int quiet_windows = 100, full_windows = 40, sleepy_windows = 5, warm_up = 10;
constexpr double dt = 1e-6;
constexpr std::chrono::milliseconds nap{400};

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

/// A square sheet of n x n quads.
WetSurface sheet(int64_t faces) {
  const int n = int(std::lround(std::sqrt(double(faces))));
  WetSurface s;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i) {
      s.x.push_back({0.1 + 0.8 * i / n, 0.1 + 0.8 * j / n, 0.5});
      s.v.push_back({0, 0, 1});
      s.node_id.push_back(int64_t(s.node_id.size()));
      s.node_parent.push_back(-1);
    }
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      const int32_t a = j * (n + 1) + i;
      s.quads.push_back({a, a + 1, a + n + 2, a + n + 1});
      s.face_id.push_back(int64_t(s.face_id.size()));
      s.body.push_back(0);
      s.flags.push_back(0);
    }
  return s;
}

int play_solid(Channel& channel, const CouplingCase& cs, int64_t faces) {
  WetSurface wet = sheet(faces);
  const int windows = warm_up + quiet_windows + full_windows + sleepy_windows;
  SolidSide side(
      channel, cs,
      {.program = "bench", .version = "1", .t_end = windows * dt, .lower = {0.1, 0.1, 0.5}, .upper = {0.9, 0.9, 0.5}},
      "");
  const int first_full = warm_up + quiet_windows, first_sleepy = first_full + full_windows;
  double t = 0, start = 0, cpu = 0;
  std::vector<double> ended;
  for (int w = 0; w < windows; ++w) {
    if (w == first_sleepy) start = now(), cpu = cpu_seconds();
    if (w >= first_full && w < first_sleepy) wet.topo_version += 1;
    side.send({.t0 = t, .t1_max = t + dt, .dt_stable = dt}, wet);
    const Loads& loads = side.receive();
    if (w >= first_sleepy) channel.mine().barrier();
    t = loads.t1;
    side.add(SolidTotals{});  // the fluid is at the reference pressure: no impulse
    side.end_window();
    ended.push_back(now());
  }
  const double slept = now() - start;
  cpu = cpu_seconds() - cpu;
  side.finish();
  if (!channel.mine().root()) return 0;
  const auto tell = [&](const char* name, int from, int to) {
    double best = ended[size_t(to) - 1] - ended[size_t(from) - 1];
    const double mean = best / (to - from);
    for (int w = from; w < to; ++w) best = std::min(best, ended[size_t(w)] - ended[size_t(w) - 1]);
    std::printf("%s_ms %.4f\n%s_best_ms %.4f\n", name, 1e3 * mean, name, 1e3 * best);
  };
  tell("geometry", warm_up, first_full);
  tell("full", first_full, first_sleepy);
  std::printf("wait_cpu_share %.5f\n", cpu / slept);
  std::printf("late_ms %.4f\n", 1e3 * slept / sleepy_windows - double(nap.count()));
  return 0;
}

int play_fluid(Channel& channel, const CouplingCase& cs) {
  FluidSide side(channel, cs, {.program = "bench", .version = "1", .lower = {0, 0, 0}, .upper = {1, 1, 1}});
  Loads loads;
  while (side.receive()) {
    if (side.window().index >= warm_up + quiet_windows + full_windows) std::this_thread::sleep_for(nap);
    loads.t1 = side.window().t1_max;
    loads.p.assign(side.surface().quads.size(), cs.reference_pressure);
    loads.totals = wall_totals(side.surface(), loads, side.surface().v, side.window());
    side.send(loads);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Session session(argc, argv);
  const std::string role = argc > 1 ? argv[1] : "";
  const int64_t faces = argc > 2 ? std::atoll(argv[2]) : 20000;
  const CouplingCase cs;
  Joined joined = join(session, role == "solid" ? Role::solid : Role::fluid, cs);
  return role == "solid" ? play_solid(*joined.channel, cs, faces) : play_fluid(*joined.channel, cs);
}
