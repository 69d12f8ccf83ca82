// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>

#include "coupling/channel.h"
#include "csd/build.h"

namespace bw::csd {

/// Box 1 of the paper; without a channel the same loop with no peer. Returns the exit code.
int run(const Case& cs, Model& model, coupling::Channel* channel);

/// --check: steps, memory and minutes, estimated from the built model and printed.
void check(const Case& cs, Model& model);

}  // namespace bw::csd
