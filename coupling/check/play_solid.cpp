// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <signal.h>

#include <cmath>
#include <fstream>

#include "coupling/check/cube.h"
#include "coupling/check/scenario.h"
#include "coupling/solid_side.h"

namespace bw::coupling::check {
namespace {

struct Solid {
  const Options& o;
  Channel& channel;
  WetSurface wet = cube(o.centre, o.edge);
  double dt = o.window > 0 ? o.window : 0.01 * o.edge / o.c;  // s, longest window
  CouplingCase cs;
  Hello hello;
  std::ofstream record;

  Solid(Channel& line, const Options& options) : o(options), channel(line) {
    cs.scheme = o.scheme;
    cs.reference_pressure = o.p_ref;
    if (is("silence")) cs.silence_limit = short_silence;
    if (is("short_windows")) dt *= 1e-3;
    if (is("fixed_window")) cs.window = dt *= 40;
    const Vec3 half = 0.5 * o.edge * Vec3{1, 1, 1};
    hello = {.program = "fsi-check",
             .version = "1",
             .t_end = o.windows * dt,
             .lower = o.centre - half,
             .upper = o.centre + half};
    if (!o.record.empty()) record.open(o.record, std::ios::binary);
    if (is("piston") || is("split") || is("fixed_window") || is("turned") || o.scenario.starts_with("ranks"))
      wet.v.assign(wet.x.size(), {o.speed, 0, 0});
    if (is("co_moving")) wet.v.assign(wet.x.size(), o.flow);
    if (is("empty")) wet = WetSurface{}, hello.lower = {1, 1, 1}, hello.upper = {-1, -1, -1};
  }
  bool is(const char* name) const { return o.scenario == name; }
  Vec3 normal(size_t f) const { return unit(area_vector(wet.x, wet.quads[f])); }

  /// The surface of that window, before it is sent.
  void change(int64_t window);
  void look(int64_t window, const Loads& loads) const;
  int run();
  void say_strange_hello();
  void send_strange_surface();

 private:
  WetSurface kept_;
};

void Solid::change(int64_t window) {
  if ((is("split") || o.scenario.starts_with("ranks")) && window == 4) split(wet);
  if (is("degenerate") && window == 2) degenerate(wet);
  if (is("vanish") && window == 2) {
    kept_ = wet;
    wet = WetSurface{};
    wet.topo_version = 1;
  }
  if (is("vanish") && window == 3) {
    wet = kept_;
    wet.topo_version = 2;
    for (int64_t& id : wet.node_id) id += 1000;
    for (int64_t& id : wet.face_id) id += 1000;
  }
}

void Solid::look(int64_t window, const Loads& loads) const {
  const double p0 = o.ambient(), jump = o.rho * o.c * o.speed;
  Vec3 force;
  for (size_t f = 0; f < loads.p.size(); ++f) {
    const double over = loads.p[f] - p0;
    const Vec3 area = area_vector(wet.x, wet.quads[f]);
    force += -loads.p[f] * area;
    const auto wrong = [&](const std::string& wanted) {
      found_wanting(fmt::format(
          "window {}: on face {} of the cube, normal ({:.3g}, {:.3g}, {:.3g}), P - p0 = {:.6g} Pa; expected {}", window,
          wet.face_id[f], normal(f).x, normal(f).y, normal(f).z, over, wanted));
    };
    if (is("rest") && std::abs(over) > 1e-6 * p0) wrong(fmt::format("0, p0 = {:g} Pa", p0));
    if (is("co_moving") && std::abs(over) > 1e-3 * p0) wrong(fmt::format("0 within a thousandth of {:g} Pa", p0));
    const bool end_face = norm(area) > 0 && std::abs(normal(f).x) > 0.9 && !(wet.flags[f] & face_lip);
    const double wanted = end_face ? jump * normal(f).x : 0;
    if (is("piston") && end_face && window < 3 && std::abs(over - wanted) > 0.25 * jump)
      wrong(fmt::format("rho c u = {:+.6g} Pa", wanted));
    if ((is("split") || (is("fixed_window") && window < 2)) && end_face && !(over * wanted > 0))
      wrong(fmt::format("the sign of {:+.6g} Pa", wanted));
  }
  if (is("rest") && norm(force) > 1e-6 * p0 * o.edge * o.edge)
    found_wanting(
        fmt::format("a net force of ({:.6g}, {:.6g}, {:.6g}) N on a closed cube at rest", force.x, force.y, force.z));
}

int Solid::run() {
  if (is("t_end")) hello.t_end = 2.5 * dt;
  SolidSide side(channel, cs, hello, "");
  double t = 0;
  int64_t window = 0;
  for (; t < side.t_end() && !side.stop_asked() && !is("early_bye"); ++window) {
    change(window);
    side.send({.t0 = t, .t1_max = t + dt, .dt_stable = 0.3 * dt}, wet);
    const Loads& loads = side.receive();
    look(window, loads);
    record.write(reinterpret_cast<const char*>(loads.p.data()), std::streamsize(8 * loads.p.size()));
    const std::vector<Vec3> force = nodal_loads(wet, loads, cs.reference_pressure);
    std::vector<Vec3> x = wet.x;
    EqualSubsteps sub(t, loads.t1);
    while (!sub.done()) {
      const double h = sub.next(0.3 * dt);
      const std::vector<Vec3> before = x;
      for (size_t i = 0; i < x.size(); ++i) x[i] += h * wet.v[i];
      side.add(substep_totals(force, wet.x, before, x, h));
      t = sub.advance();
    }
    side.end_window(x);
    wet.x = x;
    if (window > 1000 * o.windows) found_wanting(fmt::format("{} windows for {:g} s: the program creeps", window, t));
  }
  side.finish();
  return 0;
}

void Solid::say_strange_hello() {
  strange_hello(channel, pack(hello, cs, "solid", 1), o.scenario);
  channel.wait({tag_load});
}

void Solid::send_strange_surface() {
  SolidSide side(channel, cs, hello, "");  // shakes hands
  if (is("silence") || is("death") || is("fail")) {
    mark_accident();
    if (is("fail")) channel.fail(42, "fails on purpose");
    if (is("death")) raise(SIGKILL);
    keep_silent(channel, o);
    found_wanting("the program waits in silence longer than its limit");
  }
  StepBlock step = pack({.t0 = 0, .t1_max = dt, .dt_stable = dt, .mean_pressure = o.scheme != "box1"}, wet);
  if (is("index")) wet.quads[0][1] = 99;
  step.hash = connectivity_hash(wet, side.minor()) + is("hash");
  step.flags |= step_connectivity;
  if (is("order")) step.window = 5;
  if (is("nan")) wet.v[3].y = NAN;
  std::vector<int64_t> ids = wet.node_id;
  ids.insert(ids.end(), wet.node_parent.begin(), wet.node_parent.end());
  ids.insert(ids.end(), wet.face_id.begin(), wet.face_id.end());
  std::vector<int32_t> faces = wet.body;
  faces.insert(faces.end(), wet.flags.begin(), wet.flags.end());
  mark_accident();
  channel.send(tag_step, &step, sizeof step);
  channel.send(tag_x, std::span<const Vec3>(wet.x).first(wet.x.size() - is("size")));
  channel.send(tag_v, std::span<const Vec3>(wet.v));
  channel.send(tag_quads, std::span<const std::array<int32_t, 4>>(wet.quads));
  channel.send(tag_ids, std::span<const int64_t>(ids));
  channel.send(tag_faces, std::span<const int32_t>(faces));
  channel.flush();
  channel.wait({tag_load});
}

}  // namespace

int play_solid(Channel& channel, const Options& o) {
  Solid solid(channel, o);
  if (solid.is("version") || solid.is("minor") || solid.is("magic") || solid.is("p_ref"))
    solid.say_strange_hello();
  else if (solid.is("nan") || solid.is("index") || solid.is("size") || solid.is("order") || solid.is("hash") ||
           solid.is("fail") || solid.is("silence") || solid.is("death"))
    solid.send_strange_surface();
  else
    return solid.run();
  found_wanting("the program answered as if nothing were wrong");
}

}  // namespace bw::coupling::check
