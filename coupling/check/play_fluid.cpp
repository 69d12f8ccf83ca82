// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <signal.h>

#include <cmath>
#include <fstream>

#include "common/math/sum.h"
#include "coupling/check/scenario.h"
#include "coupling/fluid_side.h"
#include "coupling/wall_path.h"

namespace bw::coupling::check {
namespace {

struct Fluid {
  const Options& o;
  Channel& channel;
  CouplingCase cs;
  Hello hello{.program = "fsi-check", .version = "1", .lower = {-1e30, -1e30, -1e30}, .upper = {1e30, 1e30, 1e30}};
  WallPath path;
  std::ofstream record;
  Vec3 impulse;         // N s beyond p_ref, of the window before
  double scale = 0;     // N s, sum |P - p_ref| A dt of it
  double growth = NAN;  // m^3/s, sum v A of the first window

  Fluid(Channel& line, const Options& options) : o(options), channel(line) {
    cs.scheme = o.scheme;
    cs.reference_pressure = o.p_ref;
    if (is("silence")) cs.silence_limit = short_silence;
    if (!o.record.empty()) record.open(o.record, std::ios::binary);
  }
  bool is(const char* name) const { return o.scenario == name; }

  int run();
  void look(const FluidSide& side);
  Loads answer(const FluidSide& side);
  void say_strange_hello();
  void have_accident(const FluidSide& side, Loads loads);
};

void Fluid::look(const FluidSide& side) {
  const WetSurface& wet = side.surface();
  const StepBlock& step = side.step();
  record.write(reinterpret_cast<const char*>(wet.x.data()), std::streamsize(wet.x.size() * sizeof(Vec3)));
  if (side.window().index > 0 && (is("push") || is("rest"))) {
    const Vec3 got{step.impulse[0], step.impulse[1], step.impulse[2]};
    if (norm(got - impulse) > 1e-12 * scale + 4e-16 * side.window().t0 / step.dt_stable * scale)
      found_wanting(
          fmt::format("window {}: the solid's books say an impulse of ({:.12g}, {:.12g}, {:.12g}) N s; it was given "
                      "({:.12g}, {:.12g}, {:.12g})",
                      side.window().index, got.x, got.y, got.z, impulse.x, impulse.y, impulse.z));
  }
  ExactSum grows;
  for (const auto& quad : wet.quads) grows += dot(area_vector(wet.x, quad), face_mean(wet.v, quad));
  if (std::isnan(growth)) growth = grows.value();
  if (is("push") && side.window().index + 1 == o.windows && !(grows.value() < growth))
    found_wanting(fmt::format("the pushed faces don't give way: sum v A was {:.6g} m^3/s at the start, is {:.6g}",
                              growth, grows.value()));
}

Loads Fluid::answer(const FluidSide& side) {
  const Window& window = side.window();
  const WetSurface& wet = side.surface();
  double dt = o.window > 0 ? o.window : 20 * window.dt_stable;
  if (is("short_windows")) dt = 0.1 * window.dt_stable;
  Loads loads;
  loads.t1 = window.fixed ? window.t1_max : std::min(window.t1_max, window.t0 + dt);
  loads.dt_next = dt;
  if (o.scheme == "concurrent" && window.index > 0 && !(window.fixed && window.t1_max <= window.t0 + (1 + 1e-9) * dt))
    found_wanting(fmt::format("window {}: not a fixed one of at most dt_next = {:.6g} s", window.index, dt));
  loads.p.assign(wet.quads.size(), o.p_ref + (is("rest") ? 0 : o.push));
  loads.stop = window.index + 1 >= o.windows;
  path.begin(window, wet);
  loads.totals = wall_totals(wet, loads, path.velocity(loads.t1 - window.t0), window);
  path.end(loads.t1 - window.t0);
  impulse = {};
  scale = 0;
  ExactSum3 sum;
  for (size_t f = 0; f < loads.p.size(); ++f) {
    const Vec3 area = area_vector(wet.x, wet.quads[f]);
    sum += -((loads.p[f] - o.p_ref) * (loads.t1 - window.t0)) * area;
    scale += loads.p[f] * norm(area) * (loads.t1 - window.t0);
  }
  impulse = sum.value();
  return loads;
}

int Fluid::run() {
  FluidSide side(channel, cs, hello);
  bool stopped = false;
  while (side.receive()) {
    if (stopped) found_wanting("a surface came after the fluid had asked to stop");
    look(side);
    Loads loads = answer(side);
    stopped = loads.stop;
    if (side.window().index == 2) have_accident(side, loads);
    side.send(loads);
  }
  return 0;
}

void Fluid::say_strange_hello() {
  strange_hello(channel, pack(hello, cs, "fluid", 1), o.scenario);
  channel.wait({tag_step});
  found_wanting("the program went on as if nothing were wrong");
}

void Fluid::have_accident(const FluidSide& side, Loads loads) {
  const bool bye = is("bye"),
             said = is("nan") || is("late_t1") || is("standstill") || is("size") || is("order") || is("books");
  if (!(bye || said || is("fail") || is("death") || is("silence"))) return;
  mark_accident();
  if (is("fail")) channel.fail(42, "fails on purpose");
  if (is("death")) raise(SIGKILL);
  if (is("silence")) {
    keep_silent(channel, o);
    found_wanting("the program waits in silence longer than its limit");
  }
  const Window& window = side.window();
  if (is("nan")) loads.p.front() = NAN;
  if (is("late_t1")) loads.t1 = window.t1_max + (window.t1_max - window.t0);
  if (is("standstill")) loads.t1 = window.t0;
  if (is("books")) loads.totals.impulse.x += 1e-6 * scale;
  StepBlock asked = side.step();
  asked.window += is("order");
  const LoadBlock load = pack(loads, asked);
  ByeBlock goodbye{};
  std::strcpy(goodbye.text, "had enough");
  if (bye) {
    channel.send(tag_bye, &goodbye, sizeof goodbye);
  } else {
    channel.send(tag_load, &load, sizeof load);
    channel.send(tag_p, loads.p.data(), 8 * (loads.p.size() - is("size")));
  }
  channel.flush();
  channel.wait({tag_step});
  found_wanting("the program went on as if nothing were wrong");
}

}  // namespace

int play_fluid(Channel& channel, const Options& o) {
  Fluid fluid(channel, o);
  if (fluid.is("version") || fluid.is("minor") || fluid.is("magic") || fluid.is("p_ref") || fluid.is("apart"))
    fluid.say_strange_hello();
  return fluid.run();
}

}  // namespace bw::coupling::check
