// SPDX-License-Identifier: Apache-2.0
// coupling_history.csv: the ledger's rows, one per window.
#pragma once
#include <string>

#include "common/io/csv.h"
#include "coupling/ledger.h"

namespace bw::coupling {

History open_ledger_table(const std::string& path);
/// After a restart: with the first `rows` rows that it holds.
History resume_ledger_table(const std::string& path, int64_t rows);
/// waited: s that the solid waited for the window's LOAD.
void write_row(History& table, const LedgerRow& row, double waited);

}  // namespace bw::coupling
