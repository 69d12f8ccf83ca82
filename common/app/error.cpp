// SPDX-License-Identifier: Apache-2.0
#include "common/app/error.h"

#include <fmt/format.h>

namespace bw {

void check_failed(const char* condition, const char* file, int line) {
  throw std::logic_error(fmt::format("{}:{}: a condition that always holds does not: {}", file, line, condition));
}

}  // namespace bw
