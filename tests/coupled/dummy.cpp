// SPDX-License-Identifier: Apache-2.0
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "common/app/guarded.h"
#include "common/app/log.h"
#include "scene.h"

namespace bw::dummy {

void mark_accident() {
  const double now = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  error_line(fmt::format("accident at {:.6f}", now));
}

bool have_accident(const Scenario& scenario) {
  if (scenario.accident.empty()) return false;
  mark_accident();
  if (scenario.is("throw")) throw PhysicsError("element 17 is inverted");
  if (scenario.is("exit")) std::exit(0);
  if (scenario.is("terminate")) std::thread([] { throw std::runtime_error("thrown in a thread"); }).join();
  if (scenario.is("kill")) raise(SIGKILL);
  if (scenario.is("segfault")) raise(SIGSEGV);
  if (scenario.is("hang")) std::this_thread::sleep_for(std::chrono::seconds(100));
  return scenario.is("return");
}

double pressure(const coupling::WetSurface& s, size_t face, int64_t window) {
  const Vec3 centre = coupling::face_mean(s.x, s.quads[face]);
  return 1e5 * (1 + centre.x + 2 * centre.y + 3 * centre.z) + 100 * double(s.face_id[face] % 97) + double(window);
}

}  // namespace bw::dummy

int main(int argc, char** argv) {
  using namespace bw;
  Session session(argc, argv);
  const std::string role = argv[1], text = argv[2];
  dummy::Scenario scenario;
  if (const size_t colon = text.find(':'); colon != std::string::npos)
    if (text.substr(0, colon) == role || text.substr(0, colon) == "both") scenario.accident = text.substr(colon + 1);
  set_speaker(role, is_first_of_program(session));
  error_line(fmt::format("process {}", getpid()));
  return guarded(session, [&]() -> int {
    session.world().barrier();  // the accidents before joining find the other program joining
    if (scenario.is("bad_input") || scenario.is("early_exit"))
      std::this_thread::sleep_for(std::chrono::milliseconds(500));  // on a busy machine, too
    coupling::CouplingCase cs;
    cs.reference_pressure = scenario.is("p_ref") ? 0 : dummy::p_ref;
    if (text == "fluid:old") cs.window = 1e-4;
    cs.join_limit = text.find("late") != text.npos ? 2 : 60;
    cs.silence_limit = text.find("hang") != text.npos ? 2 : 60;
    if (scenario.is("bad_input")) {
      dummy::mark_accident();
      throw InputError("case.toml:7: solid.body.density: a positive density was expected");
    }
    if (scenario.is("early_exit")) {
      dummy::mark_accident();
      std::exit(2);
    }
    if (scenario.is("late")) {
      dummy::mark_accident();
      std::this_thread::sleep_for(std::chrono::seconds(100));
    }
    const auto as = role == "solid" ? coupling::Role::solid : coupling::Role::fluid;
    const coupling::Joined joined = coupling::join(session, as, cs);
    if (!joined.channel) {
      say("alone with {} ranks", joined.mine.size());
      return 0;
    }
    return as == coupling::Role::solid ? dummy::run_solid(joined.mine, *joined.channel, cs, scenario)
                                       : dummy::run_fluid(joined.mine, *joined.channel, cs, scenario);
  });
}
