// SPDX-License-Identifier: Apache-2.0
// A record of a coupled run: what crossed between the two programs, in an HDF5 file of the solid's leader. What each
// window asked and was answered is on the disk before the run goes on, so the record of a run that died is usable.
//
//   hello      u8 [2][296]          HELLO of the solid, of the fluid, as on the wire (PROTOCOL.md), as these:
//   step       u8 [windows][192]    STEP
//   load       u8 [windows][256]    LOAD; a row less than step if the run died before the answer
//   x, v       f64 [...][3]         SURFACE, one window after the other, as these:
//   quads, node_id, node_parent, face_id, body, flags    of windows with step_connectivity
//   p, traction, impedance          LOAD
//   bye        u8 [0 or 1][256]     BYE: the run came to its end
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "common/io/growing_file.h"
#include "coupling/messages.h"

namespace bw::coupling {

class Recorder {
 public:
  /// A pair that goes on from window solid.restart_window takes over the windows before it from a file of that name;
  /// without one (or if it doesn't hold them) the record begins there.
  Recorder(const std::string& path, const HelloBlock& solid, const HelloBlock& fluid);
  void asked(const StepBlock& step, const WetSurface& surface);
  void answered(const LoadBlock& load, const Loads& loads);
  void finished(const ByeBlock& bye);

 private:
  void take_over(const std::string& path, int64_t windows);
  h5::GrowingFile file_;
};

class Record {
 public:
  /// InputError if there is no record of a window.
  explicit Record(const std::string& path);
  const std::string& path() const { return path_; }
  const HelloBlock& solid() const { return solid_; }
  const HelloBlock& fluid() const { return fluid_; }
  const std::vector<StepBlock>& steps() const { return steps_; }
  const std::vector<LoadBlock>& loads() const { return loads_; }  ///< as many, or one less
  bool is_finished() const { return is_finished_; }
  /// s; the smaller of the two programs' ends, where the run was to end.
  double agreed_end() const;
  double begin() const { return steps_.front().t0; }
  double end() const { return loads_.empty() ? begin() : loads_.back().t1; }  ///< of the last answered window
  /// The latest window that starts at t or before; nothing: t lies before the record.
  std::optional<size_t> window_at(double t) const;
  WetSurface surface(size_t window) const;
  std::vector<double> pressures(size_t window) const;
  Loads load(size_t window) const;  ///< totals as in the block

 private:
  std::string path_;
  h5::File file_;
  HelloBlock solid_{}, fluid_{};
  std::vector<StepBlock> steps_;
  std::vector<LoadBlock> loads_;
  std::vector<int64_t> first_node_, first_face_;  // of each window's x, p
  std::vector<int64_t> first_traction_, first_impedance_;
  std::vector<int64_t> topology_;                         // of each window: among those that were sent
  std::vector<int64_t> topology_nodes_, topology_faces_;  // of each of these: first rows
  bool is_finished_ = false;
};

}  // namespace bw::coupling
