// SPDX-License-Identifier: Apache-2.0
// What is allowed but hardly meant, told at the start of a run.
#pragma once
#include "cfd/books.h"
#include "cfd/build.h"

namespace bw::cfd {

/// Warns of materials that fill no cell and flow in nowhere, and of the case's bodies outside of the domain. sums: of the
/// painted flow. InputError if no cell holds fluid. Collective.
void remark(const Case& cs, const Model& m, const FluidSums& sums);

}  // namespace bw::cfd
