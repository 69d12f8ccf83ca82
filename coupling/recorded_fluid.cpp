// SPDX-License-Identifier: Apache-2.0
#include "coupling/recorded_fluid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/app/log.h"
#include "coupling/channel.h"

namespace bw::coupling {

RecordedFluid::RecordedFluid(const std::string& path) : record_(path) {
  say("replay of {}: loads of {} windows to t = {:.6g} s{}", path, record_.loads().size(), record_.end(),
      record_.is_finished() ? "" : ", where the recorded run broke off");
}

Verdict RecordedFluid::take(int tag, std::span<const char> bytes) {
  switch (tag) {
    case tag_hello:
      greet(block_of<HelloBlock>(bytes));
      return {};
    case tag_step:
      step_ = block_of<StepBlock>(bytes);
      return {};
    case tag_x:
      x_ = list_of<Vec3>(bytes);
      return {};
    case tag_v:  // quads come later, but the hash in STEP says all of them
      v_ = list_of<Vec3>(bytes);
      return answer_window();
    case tag_bye: {
      report();
      const ByeBlock bye{};
      answer(tag_bye, &bye, sizeof bye);
      return {};
    }
    default:
      return {};
  }
}

void RecordedFluid::greet(const HelloBlock& solid) {
  HelloBlock hello = replayed(record_.fluid(), solid);
  hello.minor = std::min(hello.minor, record_.solid().minor);  // the hashes on record are those of both
  hello.t_end = record_.is_finished() ? record_.end() : record_.agreed_end();
  answer(tag_hello, &hello, sizeof hello);
}

Verdict RecordedFluid::answer_window() {
  const auto at = record_.window_at(step_.t0);
  if (!at)
    return Fault{exit_record, fmt::format("{}: the record begins at t = {:.9g} s only, this run is at {:.9g} s",
                                          record_.path(), record_.begin(), step_.t0)};
  if (*at >= record_.loads().size() || !(step_.t0 < record_.loads()[*at].t1))
    return Fault{exit_record, fmt::format("{}: the record ends at t = {:.9g} s, before this run (time.end, --end)",
                                          record_.path(), record_.end())};
  const StepBlock& then = record_.steps()[*at];
  if (step_.hash != then.hash || step_.n_faces != then.n_faces)
    return Fault{
        exit_record,
        fmt::format("{}: at t = {:.9g} s the wet surface has {} faces and {} nodes, in the record {} and {}{}: "
                    "another mesh, or cracks that opened elsewhere or earlier",
                    record_.path(), step_.t0, step_.n_faces, step_.n_nodes, then.n_faces, then.n_nodes,
                    step_.n_faces == then.n_faces ? ", others" : "")};
  if ((step_.flags & step_fixed) && record_.loads()[*at].t1 < step_.t1_max)
    return Fault{
        exit_record,
        fmt::format("{}: the window from t = {:.9g} s is to end at {:.9g} s, in the record it ends at {:.9g} s: "
                    "another coupling.scheme or coupling.window, or another material",
                    record_.path(), step_.t0, step_.t1_max, record_.loads()[*at].t1)};
  const WetSurface was = record_.surface(*at);
  Loads loads = record_.load(*at);
  LoadBlock block = record_.loads()[*at];
  const bool same_time = step_.t0 == then.t0 && block.t1 <= step_.t1_max;
  const bool same = same_time && was.x == x_ && was.v == v_;
  if (step_.t0 == then.t0)
    for (size_t i = 0; i < x_.size(); ++i) distance_ = std::fmax(distance_, norm(x_[i] - was.x[i]));
  same_ = same_ && same;
  if (!same) {  // the same pressures on other areas, or for a part of their window
    WetSurface now = was;
    now.x = x_, now.v = v_;
    loads.t1 = std::min(loads.t1, step_.t1_max);
    const FluidTotals wall = wall_totals(now, loads, v_, {.t0 = step_.t0, .t1_max = step_.t1_max});
    loads.totals.impulse = wall.impulse, loads.totals.moment = wall.moment;
    loads.totals.work = wall.work, loads.totals.swept = wall.swept;
    block = pack(loads, step_);
  }
  block.window = step_.window, block.topo_version = step_.topo_version;
  block.flags &= ~uint32_t(load_checkpoint);
  ++windows_;
  answer(tag_load, &block, sizeof block);
  answer(tag_p, loads.p);
  if (block.flags & load_traction) answer(tag_traction, loads.traction);
  if (block.flags & load_impedance) answer(tag_impedance, loads.impedance);
  return {};
}

void RecordedFluid::report() const {
  say("replay: {} windows; {}", windows_,
      same_ ? std::string("the wet surface was the recorded one, to the last bit")
            : fmt::format("at recorded times the wet surface was up to {:.3g} m from the recorded one", distance_));
}

}  // namespace bw::coupling
