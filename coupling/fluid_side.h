// SPDX-License-Identifier: Apache-2.0
// The fluid's half of a coupled run:
//
//   while (side.receive()) {                       // false: the solid has finished
//     ...move the walls of side.surface() with its velocities from side.window().t0 to some t1 <= t1_max...
//     side.send(loads);                            // one P per face of side.surface()
//   }
//
// Collective over the fluid's ranks: the leader exchanges and its loads count, all ranks get the surface.
#pragma once
#include "coupling/channel.h"
#include "coupling/messages.h"

namespace bw::coupling {

class FluidSide {
 public:
  /// Says HELLO and checks the answer.
  FluidSide(Channel& channel, const CouplingCase& cs, const Hello& hello);

  /// s; the smaller of the two programs' ends.
  double t_end() const { return t_end_; }
  /// The next surface. false: the solid said BYE, which was answered; nothing may be sent afterwards.
  bool receive();
  const Window& window() const { return window_; }
  /// As it came: the solid's books of the window before.
  const StepBlock& step() const { return step_; }
  /// x at t0; v for the whole window, to be held constant (fluid_first: the gap's repayment comes on top, on the
  /// fluid's side).
  const WetSurface& surface() const { return surface_; }
  /// The connectivity is not that of the window before (true for the first).
  bool topology_changed() const { return topology_changed_; }
  /// To be called after receive() where window().checkpoint asks for it: the state at t0 is on the disk, in a file of
  /// this name in the output folder.
  void kept(const std::string& file);
  /// Answers. The leader's loads; t1 in (t0, t1_max].
  void send(const Loads& loads);

 private:
  void receive_surface();
  void receive_from_solid(size_t nodes, size_t faces);

  Channel& channel_;
  double t_end_ = 0;
  uint32_t minor_ = 0;  // of the protocol, that both speak
  Window window_;
  WetSurface surface_;
  std::vector<int64_t> ids_;  // as on the wire
  std::vector<int32_t> values_;
  StepBlock step_{};
  Known known_;
  bool topology_changed_ = false;
};

}  // namespace bw::coupling
