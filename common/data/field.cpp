// SPDX-License-Identifier: Apache-2.0
#include "common/data/field.h"

#include <sys/mman.h>

namespace bw {

void ask_for_large_pages(void* p, size_t bytes) { madvise(p, bytes, MADV_HUGEPAGE); }

}  // namespace bw
