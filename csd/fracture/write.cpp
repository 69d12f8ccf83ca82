// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "common/io/file.h"
#include "csd/fracture/pieces.h"

namespace bw::csd {

void write_rows(const std::string& path, std::span<const Row> rows) {
  std::string text =
      "t [s],body [1],lower [m],upper [m],radius [m],speed [m/s],stress [Pa],width [m],ratio [1],around [1],layers "
      "[1],bins [1],first_bin [1],elements [1],elements_across [1]\n";
  for (const Row& r : rows)
    text += fmt::format("{:.12g},{},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{:.12g},{},{},{},{},{},{:.6g}\n",
                        r.t, r.body, r.lower, r.upper, r.state.radius, r.state.speed, r.state.stress, r.width, r.ratio,
                        r.around, r.layers, r.bins, r.first_bin, r.elements, r.across);
  write_atomically(path, text);
}

}  // namespace bw::csd
