// SPDX-License-Identifier: Apache-2.0
// The solid's half of a coupled run. One pass of its loop:
//
//   side.send({.t0 = t, .t1_max = t_allowed, .dt_stable = dt}, wet);      // x^n, v^n
//   const Loads& loads = side.receive();                                  // P over [t, t1]
//   const auto force = nodal_loads(wet, loads, cs.reference_pressure);    // constant over the window
//   EqualSubsteps sub(t, loads.t1); while (!sub.done()) { ...; side.add(substep_totals(...)); }
//   side.end_window(x_of_the_sent_nodes);
//
// until t >= side.t_end() or side.stop_asked(); then side.finish(). Collective over the solid's ranks: the leader
// exchanges and its surface counts, all ranks get the loads.
#pragma once
#include <optional>
#include <span>
#include <string>

#include "common/io/csv.h"
#include "coupling/added_mass.h"
#include "coupling/channel.h"
#include "coupling/expected_loads.h"
#include "coupling/ledger.h"
#include "coupling/messages.h"
#include "coupling/predictor.h"
#include "coupling/record.h"
#include "coupling/substeps.h"

namespace bw::coupling {

class SolidSide {
 public:
  /// Says HELLO and checks the answer. Rows go to history_path (leader; empty: none); a run that goes on calls keep()
  /// next, which finds its rows there again.
  SolidSide(Channel& channel, const CouplingCase& cs, const Hello& hello, const std::string& history_path);

  /// s; the smaller of the two programs' ends.
  double t_end() const { return t_end_; }
  /// The fluid wants to end after the window in hand.
  bool stop_asked() const { return loads_.stop; }

  /// Window.index and mean_pressure are set here, t1_max is clipped to t_end(), window_max and what light faces stand
  /// (areal_mass [n_faces] kg/m^2: of the part of the solid that moves with the face in one window, its element; empty:
  /// unknown). The leader's surface.v is v^n; afterwards it is what was announced on all ranks, the predicted velocity
  /// of the walls.
  /// The surface must stay as it is until end_window().
  void send(Window window, WetSurface& surface, std::span<const double> areal_mass = {});
  /// Under concurrent, while the fluid computes its answer: the loads to go on with, to the window's end, which is
  /// fixed; receive() is due before end_window(). Nothing under other schemes, and before the first answer: receive()
  /// next. All ranks.
  std::optional<Loads> expect();
  /// Checked: t0 < t1 <= t1_max, one finite P per face. Valid until the next send.
  const Loads& receive();
  /// Of the protocol's version, that both programs speak (leader).
  uint32_t minor() const { return minor_; }
  /// The fluid can keep its state.
  bool fluid_keeps() const { return features_ & feature_checkpoint; }
  /// The fluid asked for a checkpoint in its last answer.
  bool checkpoint_asked() const { return loads_.checkpoint; }
  /// The next window asks the fluid to keep its state at t0; after receive() it is in this file of the output folder
  /// (leader).
  void ask_checkpoint() { asks_checkpoint_ = true; }
  const std::string& fluid_file() const { return fluid_file_; }
  int64_t next_window() const { return next_window_; }
  /// In a checkpoint, between two windows.
  template <class A>
  void keep(A& a) {
    a.value("next_window", next_window_), a.value("dt_usual", dt_usual_), a.value("t_last", t_last_);
    int64_t rows = history_ ? history_->rows() : 0;
    a.value("rows", rows);
    if (history_) history_->flush();  // rows before the checkpoint don't come again
    if (a.restores()) resume_table(rows);
    A predictor = a.section("predictor"), added_mass = a.section("added_mass"), ledger = a.section("ledger");
    predictor_.keep(predictor), added_mass_.keep(added_mass), ledger_.keep(ledger);
    if (case_.kind() != Scheme::concurrent) return;
    A expected = a.section("expected");
    a.value("dt_next", dt_next_), expected_.keep(expected);
  }
  /// One substep's totals (leader's count; call on any).
  void add(const SolidTotals& totals) { ledger_.add(totals); }
  /// What the solid got beyond these in the window [N s, J]: an advance on what the fluid will give.
  void add_advance(const Vec3& impulse, double work) { ledger_.add_advance(impulse, work); }
  /// Closes the window's books; x_end = positions of the nodes as sent (leader; may be empty). Ends the run if impulse
  /// was lost.
  void end_window(std::span<const Vec3> x_end = {});
  /// The other program's failure, if there is one by now, ends this one.
  void poll() { channel_.poll(); }
  const LedgerRow& books() const { return ledger_.row(); }
  /// BYE both ways. Nothing may be sent afterwards.
  void finish(const std::string& reason = "finished");
  /// Says in a few lines what crossed in the whole run, and whether anything was lost; kinetic: J, the solid's. Before
  /// finish().
  void tell_ledger(double kinetic) const;

 private:
  void resume_table(int64_t rows);
  void gather_connectivity(const WetSurface& surface);
  /// The leader's part of send().
  void give(const Window& window, WetSurface& surface);
  /// The window's end, where the solid leads or computes beside the fluid.
  void fix(Window& window) const;

  Channel& channel_;
  CouplingCase case_;
  double t_end_ = 0;
  uint64_t features_ = 0;  // of the fluid
  uint32_t minor_ = 0;
  bool asks_checkpoint_ = false;
  std::string fluid_file_, history_path_;
  Window window_;
  int64_t next_window_ = 0;
  WetSurface* sent_ = nullptr;           // the caller's, of the window in hand
  std::optional<int64_t> topo_version_;  // of the connectivity that the fluid knows
  StepBlock step_{};
  std::vector<int64_t> ids_;  // as on the wire, until they are under way
  std::vector<int32_t> faces_;
  Loads loads_;
  WallPredictor predictor_;
  AddedMass added_mass_;
  Ledger ledger_;
  ExpectedLoads expected_;
  double dt_next_ = 0;   // s, that the fluid will take, as far as it or the last window tell
  double dt_usual_ = 0;  // last window that was not clipped
  double t_last_ = 0;    // s, where the books are closed
  double waited_ = 0;    // s, for the last LOAD
  std::optional<History> history_;
  std::optional<Recorder> recorder_;  // leader
};

}  // namespace bw::coupling
