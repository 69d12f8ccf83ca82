// SPDX-License-Identifier: Apache-2.0
#include "csd/case.h"

namespace bw::csd {

Vec3 MotionCase::velocity(const Vec3& x) const {
  const Vec3 r = x - centre, n = unit(axis);
  const Vec3 away = away_from == "axis" ? r - dot(r, n) * n : r;
  const double distance = norm(away);
  return cross(spin, r) + (distance > 0 ? (radial / distance) * away : Vec3{});
}

namespace {

void describe(Keys& k, Case& cs) {
  cs.run.describe(k);
  k.table("solid", cs.solid, "the solid program csd");
  k.table("coupling", cs.coupling, "the exchange of csd and cfd");
}

}  // namespace

Case read_case(const CommandLine& line) {
  Keys k = Keys::read_file(line.case_file);
  Case cs;
  cs.file = line.case_file;
  describe(k, cs);
  k.finish({"fluid"});
  line.apply(cs.run);
  cs.restart = line.restart;
  if (!line.record.empty()) cs.coupling.record = line.record;
  if (!line.replay.empty()) cs.coupling.replay = line.replay, cs.coupling.replay_place.clear();
  if (!cs.coupling.replay.empty()) cs.run.checkpoint = {};  // there is no other program to keep its half
  if (line.threads > 0) cs.solid.threads = line.threads;
  return cs;
}

std::string case_manual() {
  Keys k = Keys::manual();
  Case cs;
  describe(k, cs);
  return k.manual_text();
}

}  // namespace bw::csd
