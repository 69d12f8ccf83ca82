// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "coupling/check/options.h"

namespace bw::coupling::check {

/// Starts mpirun once a scenario, with `self` as the other half; prints a verdict each. Returns how many failed.
int run_all(const std::string& self, const Options& options, const std::vector<std::string>& arguments);

}  // namespace bw::coupling::check
