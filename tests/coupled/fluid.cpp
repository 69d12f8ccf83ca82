// SPDX-License-Identifier: Apache-2.0
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

#include "common/app/error.h"
#include "common/app/log.h"
#include "coupling/fluid_side.h"
#include "scene.h"

namespace bw::dummy {
namespace {

using namespace coupling;

/// Accidents that FluidSide would not let through: bytes written by hand.
void say_strange_hello(Channel& channel, const CouplingCase& cs, const Hello& hello, const Scenario& scenario) {
  mark_accident();
  HelloBlock h = pack(hello, cs, "fluid", 1);
  if (scenario.is("version")) h.major = 2;
  if (scenario.is("old")) h.minor = 0;
  if (scenario.is("newer")) h.minor_needed = protocol_minor + 1;
  if (scenario.is("magic")) std::memset(h.magic, 'x', sizeof h.magic);
  if (scenario.is("endian")) h.endian = 0x04030201;
  channel.send(tag_hello, &h, scenario.is("short_hello") ? 100 : sizeof h);
  channel.flush();
  channel.wait({tag_step});
}

void send_strange_load(Channel& channel, const FluidSide& side, Loads loads, const Scenario& scenario) {
  mark_accident();
  StepBlock asked = pack(side.window(), side.surface());
  if (scenario.is("wrong_window")) asked.window += 1;
  if (scenario.is("bad_p")) loads.p[2] = NAN;
  if (scenario.is("late_t1")) loads.t1 = side.window().t1_max * 1.01;
  const LoadBlock load = pack(loads, asked);
  if (scenario.is("bye")) {
    ByeBlock bye{};
    std::strcpy(bye.text, "had enough");
    channel.send(tag_bye, &bye, sizeof bye);
  } else {
    channel.send(tag_load, &load, sizeof load);
    channel.send(tag_p, loads.p.data(), 8 * (loads.p.size() - (scenario.is("short_p") ? 1 : 0)));
  }
  channel.flush();
  channel.wait({tag_step});
}

}  // namespace

int run_fluid(const Comm& mine, Channel& channel, const CouplingCase& cs, const Scenario& scenario) {
  const Hello hello{
      .program = "dummy fluid", .version = "1", .t_end = 2 * t_end, .lower = {0, 0, 0}, .upper = {1, 1, 1}};
  if (scenario.is("version") || scenario.is("old") || scenario.is("newer") || scenario.is("magic") ||
      scenario.is("endian") || scenario.is("short_hello"))
    say_strange_hello(channel, cs, hello, scenario);
  FluidSide side(channel, cs, hello);
  while (side.receive()) {
    const Window& window = side.window();
    const WetSurface& wet = side.surface();
    if (side.topology_changed() != (window.index == 0 || window.index == crack_window))
      throw PhysicsError("the connectivity came when it was not new, or did not come");
    Loads loads;
    loads.t1 = std::min(window.t0 + 0.9e-4, window.t1_max);
    for (size_t f = 0; f < wet.quads.size(); ++f) loads.p.push_back(pressure(wet, f, window.index));
    loads.totals = wall_totals(wet, loads, wet.v, window);
    if (window.index == accident_window && !scenario.accident.empty()) {
      if (scenario.is("rank1")) {
        if (mine.rank() == 1) mark_accident(), throw PhysicsError("rank 1 is out of sorts");
        std::this_thread::sleep_for(std::chrono::milliseconds(100));  // the others could be done before it is heard
      } else if (scenario.is("own_bad_p")) {
        mark_accident();
        loads.p[2] = NAN;
      } else if (scenario.is("stop")) {
        loads.stop = true;
      } else if (have_accident(scenario)) {
        return 0;
      } else {
        send_strange_load(channel, side, loads, scenario);
      }
    }
    side.send(loads);
  }
  say("finished after window {}", side.window().index);
  return 0;
}

}  // namespace bw::dummy
