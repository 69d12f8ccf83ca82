// SPDX-License-Identifier: Apache-2.0
// coupling_history.csv: a row per window.
#pragma once
#include <fstream>
#include <string>

#include "coupling/ledger.h"

namespace bw::coupling {

class History {
 public:
  explicit History(const std::string& path);
  /// waited: s that the solid waited for the window's LOAD.
  void write(const LedgerRow& row, double waited);

 private:
  std::ofstream file_;
};

}  // namespace bw::coupling
