// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>

#include "common/app/error.h"
#include "common/app/log.h"
#include "coupling/solid_side.h"
#include "scene.h"

namespace bw::dummy {
namespace {

using namespace coupling;

/// The six faces of the cube [0.4, 0.6]^3, normals outwards.
WetSurface cube() {
  WetSurface s;
  for (int i = 0; i < 8; ++i) s.x.push_back({i & 1 ? 0.6 : 0.4, i & 2 ? 0.6 : 0.4, i & 4 ? 0.6 : 0.4});
  s.v.assign(8, {1, 2, 3});
  s.quads = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (int i = 0; i < 8; ++i) s.node_id.push_back(100 + i);
  s.node_parent.assign(8, -1);
  for (int f = 0; f < 6; ++f) s.face_id.push_back(1000 + f);
  s.body.assign(6, 0);
  s.flags.assign(6, 0);
  return s;
}

/// A crack: the first face gets nodes of its own, a lip of two triangles appears, one face goes, and all orders are
/// turned round.
void crack(WetSurface& s) {
  for (int32_t& node : s.quads[0]) {
    const size_t old = size_t(node);
    s.x.push_back(s.x[old]);
    s.v.push_back(s.v[old]);
    s.node_id.push_back(int64_t(200 + s.x.size()));
    s.node_parent.push_back(s.node_id[old]);
    node = int32_t(s.x.size() - 1);
  }
  s.quads[5] = {s.quads[0][2], s.quads[0][1], s.quads[0][0], s.quads[0][0]};
  s.face_id[5] = 2000;
  s.flags[5] = face_lip;
  const int32_t n = int32_t(s.x.size());
  std::reverse(s.x.begin(), s.x.end());
  std::reverse(s.v.begin(), s.v.end());
  std::reverse(s.node_id.begin(), s.node_id.end());
  std::reverse(s.node_parent.begin(), s.node_parent.end());
  std::reverse(s.quads.begin(), s.quads.end());
  std::reverse(s.face_id.begin(), s.face_id.end());
  std::reverse(s.body.begin(), s.body.end());
  std::reverse(s.flags.begin(), s.flags.end());
  for (auto& q : s.quads)
    for (int32_t& node : q) node = n - 1 - node;
  s.topo_version += 1;
}

}  // namespace

int run_solid(const Comm& mine, Channel& channel, const CouplingCase& cs, const Scenario& scenario) {
  WetSurface wet = cube();
  Hello hello{
      .program = "dummy solid", .version = "1", .t_end = t_end, .lower = {0.4, 0.4, 0.4}, .upper = {0.6, 0.6, 0.6}};
  if (scenario.is("apart")) hello.lower.x = hello.upper.x = 7;
  if (scenario.is("p_ref") || scenario.is("apart")) mark_accident();
  SolidSide side(channel, cs, hello, "");
  double t = 0;
  int64_t window = 0;
  for (; t < side.t_end() && !side.stop_asked(); ++window) {
    if (window == crack_window) crack(wet);
    if (window == accident_window) {
      if (scenario.is("bad_v")) mark_accident(), wet.v[3].y = NAN;
      if (scenario.is("rank1")) {
        if (mine.rank() == 1) mark_accident(), throw PhysicsError("rank 1 is out of sorts");
        std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the others could be done before it is heard
      } else if (have_accident(scenario)) {
        return 0;
      }
    }
    side.send({.t0 = t, .t1_max = t + 1e-4, .dt_stable = 0.7e-5}, wet);
    const Loads& loads = side.receive();
    for (size_t f = 0; f < wet.quads.size(); ++f)  // on every rank
      if (loads.p[f] != pressure(wet, f, window)) throw PhysicsError(fmt::format("P of face {} is another face's", f));
    const std::vector<Vec3> force = nodal_loads(wet, loads, cs.reference_pressure);
    std::vector<Vec3> x = wet.x;
    EqualSubsteps sub(t, loads.t1);
    while (!sub.done()) {
      const double h = sub.next(0.7e-5);
      const std::vector<Vec3> before = x;
      for (size_t i = 0; i < x.size(); ++i) x[i] += h * wet.v[i];
      SolidTotals totals = substep_totals(force, wet.x, before, x, h);
      if (scenario.is("lost_impulse") && window == accident_window) mark_accident(), totals.impulse.x *= 1 + 1e-9;
      side.add(totals);
      t = sub.advance();
    }
    side.end_window(x);
    wet.x = x;
    if (mine.root() && norm(side.books().moment_defect) > 1e-12 * side.books().impulse_scale)
      throw PhysicsError("the moments of the two sides differ");
    if (mine.root() && std::abs(side.books().volume_gap) > 1e-15)
      throw PhysicsError("a gap opened behind a rigid motion");
    if (mine.root() && window == crack_window && (side.books().born != 1 || side.books().dead != 1))
      throw PhysicsError("births and deaths were miscounted");
  }
  side.finish();
  say("{} windows, t = {} s", window, t);
  return 0;
}

}  // namespace bw::dummy
