// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "cfd/case.h"
#include "coupling/channel.h"

namespace bw::cfd {

/// The whole run; returns the exit code. channel: to the solid program, nullptr: alone.
int run(const Case& cs, const Comm& comm, coupling::Channel* channel);
/// --check: grid, steps, memory and time, printed. Paints everything that needs no surface from the other program.
void check(const Case& cs, const Comm& comm);

}  // namespace bw::cfd
