// SPDX-License-Identifier: Apache-2.0
#include "coupling/solid_side.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/app/log.h"
#include "common/app/timers.h"
#include "common/parallel/loop.h"
#include "coupling/handshake.h"
#include "coupling/ledger_report.h"
#include "coupling/ledger_table.h"

namespace bw::coupling {

SolidSide::SolidSide(Channel& channel, const CouplingCase& cs, const Hello& hello, const std::string& history_path)
    : channel_(channel),
      case_(cs),
      predictor_(cs.kind()),
      added_mass_(cs.added_mass),
      ledger_(cs.reference_pressure),
      expected_(cs.reference_pressure) {
  const Greeting greeting = shake_hands(channel, cs, hello);
  t_end_ = greeting.t_end;
  features_ = greeting.features;
  minor_ = greeting.minor();
  if (channel.leader() && !cs.record.empty() && cs.replay.empty())
    recorder_.emplace(cs.record, greeting.mine, greeting.other);
  t_last_ = hello.t0;
  if (channel.leader()) history_path_ = history_path;
  if (channel.leader() && !history_path.empty() && hello.restart_hash == 0)
    history_.emplace(open_ledger_table(history_path));
}

void SolidSide::resume_table(int64_t rows) {
  if (!history_path_.empty()) history_.emplace(resume_ledger_table(history_path_, rows));
}

void SolidSide::fix(Window& window) const {
  const double length = case_.kind() == Scheme::concurrent ? dt_next_ : case_.window;
  if (!(length > 0)) return;
  window.fixed = true;
  const double room = window.t1_max - window.t0, parts = std::ceil(room / length * (1 - 1e-12));
  if (parts > 1) window.t1_max = window.t0 + room / parts;  // no sliver is left before an output time
}

void SolidSide::gather_connectivity(const WetSurface& surface) {
  ids_ = surface.node_id;
  ids_.insert(ids_.end(), surface.node_parent.begin(), surface.node_parent.end());
  ids_.insert(ids_.end(), surface.face_id.begin(), surface.face_id.end());
  faces_ = surface.body;
  faces_.insert(faces_.end(), surface.flags.begin(), surface.flags.end());
}

void SolidSide::send(Window window, WetSurface& surface, std::span<const double> areal_mass) {
  const Timed timed("send surface");
  window.index = next_window_++;
  window.checkpoint = asks_checkpoint_;
  window.mean_pressure = case_.kind() != Scheme::box1;
  if (!(window.t1_max > window.t0) || window.t1_max > t_end_) window.t1_max = t_end_;
  if (case_.window_max > 0) window.t1_max = std::min(window.t1_max, window.t0 + case_.window_max);
  fix(window);
  window.t1_max =
      std::min(window.t1_max, window.t0 + added_mass_.longest_window(surface, areal_mass, window.dt_stable));
  window_ = window;
  sent_ = &surface;
  channel_.set_place(window.index, window.t0);
  if (channel_.leader()) give(window, surface);
  channel_.share(surface.v);
}

void SolidSide::give(const Window& window, WetSurface& surface) {
  const bool renewed = surface.topo_version != topo_version_;
  topo_version_ = surface.topo_version;
  const double room = window.t1_max - window.t0;
  predictor_.predict(surface, dt_usual_ > 0 && !window.fixed ? std::min(dt_usual_, room) : room);
  if (case_.kind() == Scheme::concurrent) expected_.begin(window, surface);

  uint64_t hash = step_.hash;
  Verdict fault;
  if (renewed)
    beside(
        int64_t(surface.quads.size()), [&] { gather_connectivity(surface), fault = check_connectivity(surface); },
        [&] { hash = connectivity_hash(surface, minor_); });
  if (!fault) fault = check_motion(surface);
  if (fault) channel_.fail(fault->code, fault->text);
  const LedgerRow books = ledger_.row();
  step_ = pack(window, surface);
  step_.hash = hash;
  if (renewed) step_.flags |= step_connectivity;
  step_.born = books.born;
  step_.dead = books.dead;
  for (int d = 0; d < 3; ++d) {
    step_.impulse[d] = books.solid.impulse[d];
    step_.moment[d] = books.solid.moment[d];
  }
  step_.work = books.solid.work;
  step_.volume_gap = books.volume_gap;

  if (recorder_) {
    const Timed record("record");
    recorder_->asked(step_, surface);
  }
  channel_.send(tag_step, &step_, sizeof step_);
  channel_.send(tag_x, std::span<const Vec3>(surface.x));
  channel_.send(tag_v, std::span<const Vec3>(surface.v));
  if (renewed) {
    channel_.send(tag_quads, std::span<const std::array<int32_t, 4>>(surface.quads));
    channel_.send(tag_ids, std::span<const int64_t>(ids_));
    channel_.send(tag_faces, std::span<const int32_t>(faces_));
  }
  channel_.ring();
  ledger_.begin(surface);  // while the fluid receives
  channel_.flush();
}

std::optional<Loads> SolidSide::expect() {
  if (!window_.fixed || case_.kind() != Scheme::concurrent) return {};
  Loads loads;
  int32_t known = expected_.are_known();
  channel_.share(&known, sizeof known);
  if (!known) return {};
  channel_.share(&window_.t1_max, sizeof window_.t1_max);  // what light faces stand the leader knows
  if (channel_.leader()) loads = expected_.expect(*sent_, window_.t1_max);
  loads.t1 = window_.t1_max;
  channel_.share(loads.p);
  channel_.share(loads.impedance);
  return loads;
}

const Loads& SolidSide::receive() {
  const Timed timed("wait for loads", Timed::waiting);
  LoadBlock load{};
  if (channel_.leader()) {
    const double waited_before = channel_.seconds_waited();
    if (asks_checkpoint_) {
      KeptBlock block{};
      channel_.receive(tag_kept, "CHECKPOINT", &block, sizeof block);
      if (block.window != window_.index)
        channel_.fail(exit_malformed,
                      fmt::format("CHECKPOINT: of window {}, asked was {}", block.window, window_.index));
      block.file[sizeof block.file - 1] = 0;
      fluid_file_ = block.file;
    }
    channel_.receive(tag_load, "LOAD", &load, sizeof load);
    if (const Verdict fault = check_load(load, step_)) channel_.fail(fault->code, fault->text);
    const size_t n = size_t(load.n_faces);
    loads_.p.resize(n);
    loads_.traction.resize(load.flags & load_traction ? n : 0);
    loads_.impedance.resize(load.flags & load_impedance ? n : 0);
    channel_.receive(tag_p, "LOAD: P", loads_.p.data(), n * sizeof(double));
    if (load.flags & load_traction)
      channel_.receive(tag_traction, "LOAD: traction", loads_.traction.data(), n * sizeof(Vec3));
    if (load.flags & load_impedance)
      channel_.receive(tag_impedance, "LOAD: impedance", loads_.impedance.data(), n * sizeof(double));
    if (const Verdict fault = check_values(loads_, *sent_)) channel_.fail(fault->code, fault->text);
    waited_ = channel_.seconds_waited() - waited_before;
    if (recorder_) {
      const Timed record("record");
      recorder_->answered(load, loads_);
    }
  }
  channel_.share(&load, sizeof load);
  channel_.share(loads_.p);
  channel_.share(loads_.traction);
  channel_.share(loads_.impedance);
  asks_checkpoint_ = false;
  loads_.t1 = load.t1;
  loads_.checkpoint = load.flags & load_checkpoint;
  loads_.stop = load.flags & load_stop;
  loads_.totals = totals_of(load);

  const double dt = loads_.t1 - window_.t0;
  const bool was_free = !window_.fixed && loads_.t1 < window_.t1_max;  // the fluid's own choice
  dt_next_ = load.dt_next > 0 ? load.dt_next : was_free ? dt : dt_next_;
  if (loads_.t1 < window_.t1_max) dt_usual_ = dt;  // one that the limit cut short says nothing about the next
  if (channel_.leader()) {
    predictor_.window_lasted(dt);
    if (case_.kind() == Scheme::concurrent) expected_.answered(*sent_, loads_);
    ledger_.open(window_, loads_);
    ledger_.set_added_mass(added_mass_.answer(loads_.impedance, dt));
  }
  return loads_;
}

void SolidSide::end_window(std::span<const Vec3> x_end) {
  const Timed timed("ledger");
  t_last_ = loads_.t1;
  channel_.set_place(window_.index, t_last_);
  if (!channel_.leader()) return;
  if (const auto lost = ledger_.close(x_end)) channel_.fail(exit_ledger, *lost);
  if (history_) write_row(*history_, ledger_.row(), waited_);
}

void SolidSide::tell_ledger(double kinetic) const {
  if (!channel_.leader()) return;
  const LedgerReport books = report(ledger_, kinetic);
  say("ledger of {} windows: {}", ledger_.sums().windows,
      books.lost.empty() ? "nothing was lost" : fmt::format("LOST: {}", fmt::join(books.lost, "; ")));
  for (const std::string& line : books.lines) say("  {}", line);
}

void SolidSide::finish(const std::string& reason) {
  if (channel_.leader()) {
    ByeBlock bye{};
    std::snprintf(bye.text, sizeof bye.text, "%s", reason.c_str());
    channel_.send(tag_bye, &bye, sizeof bye);
    channel_.flush();
    channel_.receive(tag_bye, "BYE", &bye, sizeof bye);
    if (recorder_) recorder_->finished(bye);
  }
  channel_.mine().barrier();
  channel_.close();
}

}  // namespace bw::coupling
