// SPDX-License-Identifier: Apache-2.0
#include "coupling/recorded_solid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/app/log.h"
#include "coupling/channel.h"
#include "coupling/node_places.h"

namespace bw::coupling {

RecordedSolid::RecordedSolid(const std::string& path) : record_(path) {
  say("replay of {}: surfaces of {} windows to t = {:.6g} s{}", path, record_.steps().size(), record_.end(),
      record_.is_finished() ? "" : ", where the recorded run broke off");
}

Verdict RecordedSolid::take(int tag, std::span<const char> bytes) {
  switch (tag) {
    case tag_hello: {
      const HelloBlock fluid = block_of<HelloBlock>(bytes);
      greet(fluid);
      next_window_ = fluid.restart_window;
      return go_on(fluid.t0);
    }
    case tag_load:
      load_ = block_of<LoadBlock>(bytes);
      return {};
    case tag_p: {
      if (const Verdict fault = check_load(load_, asked_)) return fault;
      compare(list_of<double>(bytes));
      stops_ = load_.flags & load_stop;
      return go_on(load_.t1);
    }
    default:
      return {};
  }
}

void RecordedSolid::greet(const HelloBlock& fluid) {
  HelloBlock hello = replayed(record_.solid(), fluid);
  hello.minor = std::min(hello.minor, record_.fluid().minor);  // the hashes on record are those of both
  hello.t_end = record_.is_finished() ? record_.end() : record_.agreed_end();
  t_end_ = fluid.t_end > 0 ? std::min(fluid.t_end, hello.t_end) : hello.t_end;
  answer(tag_hello, &hello, sizeof hello);
}

/// A recorded time: what was said then. Else the surface in between; at the end BYE.
Verdict RecordedSolid::go_on(double t) {
  const auto bye = [&]() -> Verdict {
    report();
    const ByeBlock block{};
    answer(tag_bye, &block, sizeof block);
    return {};
  };
  if (t >= t_end_ || stops_) return bye();
  const auto at = record_.window_at(t);
  if (!at)
    return Fault{exit_record, fmt::format("{}: the record begins at t = {:.9g} s only, this run is at {:.9g} s",
                                          record_.path(), record_.begin(), t)};
  now_ = *at;
  const StepBlock& then = record_.steps()[now_];
  if (then.t0 == t) {
    ask(then, record_.surface(now_));
    return {};
  }
  if (now_ >= record_.loads().size() || t >= record_.loads()[now_].t1) {
    if (record_.is_finished()) return bye();
    return Fault{exit_record,
                 fmt::format("{}: the record ends at t = {:.9g} s, where its run broke off, before this one "
                             "(time.end, --end)",
                             record_.path(), record_.end())};
  }
  StepBlock step = then;
  step.t0 = t;
  step.t1_max = record_.loads()[now_].t1;
  ask(step, between(now_, t, step.t1_max));
  return {};
}

WetSurface RecordedSolid::between(size_t window, double t, double t_next) const {
  WetSurface surface = record_.surface(window);
  const double t0 = record_.steps()[window].t0, share = (t - t0) / (t_next - t0);
  if (window + 1 == record_.steps().size()) {  // nobody knows where it went
    for (size_t i = 0; i < surface.x.size(); ++i) surface.x[i] += (t - t0) * surface.v[i];
    return surface;
  }
  const WetSurface next = record_.surface(window + 1);
  const NodePlaces places(next);
  for (size_t i = 0; i < surface.x.size(); ++i) {
    const int64_t place = places.find(surface.node_id[i]);
    if (place >= 0) surface.v[i] = (next.x[size_t(place)] - surface.x[i]) / (t_next - t0);
    surface.x[i] += share * (t_next - t0) * surface.v[i];
  }
  return surface;
}

void RecordedSolid::ask(StepBlock step, const WetSurface& surface) {
  step.window = next_window_++;
  step.flags &= ~uint32_t(step_checkpoint | step_connectivity);
  const bool renewed = !knows_topology_ || step.hash != hash_;
  if (renewed) step.flags |= step_connectivity;
  knows_topology_ = true, hash_ = step.hash;
  asked_ = step;
  answer(tag_step, &step, sizeof step);
  answer(tag_x, surface.x);
  answer(tag_v, surface.v);
  if (!renewed) return;
  answer(tag_quads, surface.quads);
  std::vector<int64_t> ids = surface.node_id;
  ids.insert(ids.end(), surface.node_parent.begin(), surface.node_parent.end());
  ids.insert(ids.end(), surface.face_id.begin(), surface.face_id.end());
  answer(tag_ids, ids);
  std::vector<int32_t> faces = surface.body;
  faces.insert(faces.end(), surface.flags.begin(), surface.flags.end());
  answer(tag_faces, faces);
}

void RecordedSolid::compare(const std::vector<double>& p) {
  ++windows_;
  if (now_ >= record_.loads().size()) return;
  if (asked_.t0 != record_.steps()[now_].t0 || load_.t1 != record_.loads()[now_].t1) {
    same_ = false;
    return;
  }
  const std::vector<double> then = record_.pressures(now_);
  for (size_t i = 0; i < std::min(p.size(), then.size()); ++i)
    difference_ = std::fmax(difference_, std::abs(p[i] - then[i]));
}

void RecordedSolid::report() const {
  say("replay: {} windows{}; {}", windows_, same_ ? "" : ", some of them not the recorded ones",
      same_ && difference_ == 0
          ? std::string("pressures were the recorded ones, to the last bit")
          : fmt::format("in recorded windows pressures differ by at most {:.3g} Pa", difference_));
}

}  // namespace bw::coupling
