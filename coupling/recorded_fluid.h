// SPDX-License-Identifier: Apache-2.0
// The fluid of a record: answers a solid with the loads that were recorded.
#pragma once
#include "coupling/record.h"
#include "coupling/stand_in.h"

namespace bw::coupling {

class RecordedFluid final : public StandIn {
 public:
  explicit RecordedFluid(const std::string& path);
  Verdict take(int tag, std::span<const char> bytes) override;

 private:
  void greet(const HelloBlock& solid);
  Verdict answer_window();
  void report() const;

  Record record_;
  StepBlock step_{};  // of the window in hand
  std::vector<Vec3> x_, v_;
  size_t windows_ = 0;   // answered
  double distance_ = 0;  // m, largest from the recorded surface at the same times
  bool same_ = true;     // nothing was asked that wasn't then
};

}  // namespace bw::coupling
