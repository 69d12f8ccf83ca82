// SPDX-License-Identifier: Apache-2.0
// csd's end of the line to a fluid program: the wet surface out, pressures in, window by window.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "coupling/commit.h"
#include "coupling/solid_side.h"
#include "csd/archive.h"
#include "csd/case.h"
#include "csd/checkpoint.h"
#include "csd/mesh/surface.h"
#include "csd/model.h"

namespace bw::csd {

/// Before a model that is to be coupled is restored: what its loads hold then.
void expect_fluid(const Case& cs, Model& model);

/// Where a pair goes on.
struct PairRestart {
  const Restart& file;
  const coupling::CommitMark& mark;
};

class Coupled {
 public:
  Coupled(coupling::Channel& channel, const Case& cs, Model& model, const PairRestart* from);

  double t_end() const { return side_->t_end(); }
  bool stop_asked() const { return side_->stop_asked(); }
  /// Sends the surface at the state's time and puts the answer on the model's faces, for the whole window; under
  /// concurrent the expected answer, the true one comes in end_window(). Returns the window's end, at most t_max.
  double exchange(Model& model, double dt_stable, double t_max);
  /// Between two windows: the fluid wants a checkpoint.
  bool checkpoint_asked() const { return side_->checkpoint_asked(); }
  /// Whether the fluid keeps its state too; warns if it doesn't.
  bool can_commit() const;
  /// The solid's checkpoint of the time at which the next window starts is in this file: the exchange asks the fluid
  /// for its own, and commits both.
  void commit_with_next(const std::string& file, int keep);
  /// In a checkpoint, between two windows.
  void keep(Archive a, Model& model);
  /// After each step of the window.
  void after_step(const Model& model, double dt);
  void end_window(const Model& model);
  /// Tells what crossed in the whole run, and says BYE.
  void finish(const Model& model);

 private:
  std::vector<Vec3> positions(const Model& model) const;
  /// What the fluid's answer brings besides loads.
  void hear();
  /// The true answer to a window that went by the expected one: what was lacking is owed to the next window.
  void settle();
  /// What radiates in this window, but for the impedances that the fluid will answer.
  void prepare_radiation();
  /// Forces on faces [N] that give back the impulses that radiation advanced in the window before, and radiation for
  /// this one, dt long.
  std::vector<Vec3> renew_radiation(Model& model, const coupling::Loads& loads, double dt_stable, double dt);

  const Case& case_;
  Surface surface_;
  std::vector<Vec3> area_;       ///< per face of it: m^2
  std::vector<double> mass_;     ///< per face: kg, of the element behind it; faces keep their places
  std::vector<Vec3> force_, x_;  ///< per node of it: N in this window; m, where it is by now
  RadiatingFaces radiating_;     ///< per face, until radiation begins
  std::vector<Vec3> back_;       ///< per node: N in this window, that give back what radiation advanced, or owed_
  struct Expected {
    std::vector<Vec3> on_faces;    ///< N
    double t0 = 0;                 ///< s
    coupling::SolidTotals beyond;  ///< of back_
  };
  std::optional<Expected> expected_;  ///< the window goes by an answer that has not come yet
  std::vector<Vec3> owed_;            ///< per face: N s that the window before lacked
  std::unique_ptr<coupling::SolidSide> side_;
  std::optional<coupling::CommitMark> to_commit_;
  int marks_kept_ = 1;
};

}  // namespace bw::csd
