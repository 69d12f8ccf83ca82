// SPDX-License-Identifier: Apache-2.0
// Failure values of all elements by the criterion of the case.
#pragma once
#include <algorithm>
#include <vector>

#include "csd/element/elements.h"
#include "csd/fracture/fracture.h"

namespace bw::csd {

class Failure {
 public:
  /// materials [body]: what is known of their failure; none given: nothing is.
  Failure(const FractureInput& input, const Mesh& mesh, const std::vector<FailureData>& materials);

  /// Renews the values of this rank's elements after a step; sigma_m: of the filter, null without. Rigid elements have
  /// 0.
  void update(const Elements& elements, const State& s, const Resting& resting, const Field<double, SlotId>* sigma_m);
  /// [element] 1 or more: broken. Those of other ranks are old until they are completed.
  std::vector<double>& values() { return values_; }
  const std::vector<double>& values() const { return values_; }
  /// Elements whose stress was looked at so far.
  int64_t examined() const { return examined_; }

  /// In a checkpoint.
  template <class A>
  void keep(A& a) {
    a.elements("values", values_);
    a.elements("memory", memory_, memory_.size() / std::max<size_t>(values_.size(), 1));
    a.value("examined", examined_);
  }

 private:
  std::vector<Criteria> criteria_;  // [body]
  bool skip_safe_;
  std::vector<double> strength_;  // [element] over the mean one; empty: 1
  std::vector<double> memory_;    // [element][C::memory]
  std::vector<double> values_;
  std::vector<int32_t> looked_at_;  // [block] elements whose stress was looked at in this step
  int64_t examined_ = 0;
};

}  // namespace bw::csd
