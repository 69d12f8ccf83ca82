// SPDX-License-Identifier: Apache-2.0
// The books of a whole run in a few lines: whether anything was lost between the two programs.
#pragma once
#include <string>
#include <vector>

#include "coupling/ledger.h"

namespace bw::coupling {

struct LedgerReport {
  std::vector<std::string> lines;  ///< impulse, moment, work, volume gap, faces, the fluid's own defects
  std::vector<std::string> lost;   ///< what is beyond its bound; empty: nothing was lost
};

/// kinetic: J, of the solid at the end; the scale of what the work of the two sides may differ by (1 %).
LedgerReport report(const Ledger& ledger, double kinetic);

}  // namespace bw::coupling
