// SPDX-License-Identifier: Apache-2.0
// The solid of a record: shows a fluid the surfaces that were recorded, and between these times what lies between.
#pragma once
#include "coupling/record.h"
#include "coupling/stand_in.h"

namespace bw::coupling {

class RecordedSolid final : public StandIn {
 public:
  explicit RecordedSolid(const std::string& path);
  Verdict take(int tag, std::span<const char> bytes) override;

 private:
  void greet(const HelloBlock& fluid);
  Verdict go_on(double t);
  void ask(StepBlock step, const WetSurface& surface);
  /// Between the window's start and the next one.
  WetSurface between(size_t window, double t, double t_next) const;
  void compare(const std::vector<double>& p);
  void report() const;

  Record record_;
  double t_end_ = 0;
  bool stops_ = false;  // the fluid wants to end
  size_t now_ = 0;      // recorded window in hand
  StepBlock asked_{};   // what the fluid has to answer
  LoadBlock load_{};
  int64_t next_window_ = 0;
  bool knows_topology_ = false;
  uint64_t hash_ = 0;  // of the topology that the fluid knows
  size_t windows_ = 0;
  double difference_ = 0;  // Pa, largest between a pressure and the recorded one in the same window
  bool same_ = true;
};

}  // namespace bw::coupling
