// SPDX-License-Identifier: Apache-2.0
// Large pages under the long buffers of messages: the system, which copies from program to program, looks up and holds
// each page of both, a sixth of an exchange of 200,000 faces.
#pragma once
#include <sys/mman.h>

#include <cstddef>
#include <cstdint>
#include <map>

namespace bw::coupling {

class LargePages {
 public:
  /// A message with this tag is about to use the buffer. Where it is the one of the last time, its pages become large
  /// if the system knows how; what they hold stays.
  void use(int tag, const void* data, size_t bytes) {
    const uintptr_t begin = reinterpret_cast<uintptr_t>(data);
    const uintptr_t first = (begin + page - 1) / page * page, end = (begin + bytes) / page * page;
    Buffer& known = buffers_[tag];
    if (known.begin != begin) {
      known = {begin, first};
    } else if (end > known.large_to) {
      known.large_to = end;
      (void)madvise(reinterpret_cast<void*>(first), end - first, collapse);
    }
  }

 private:
  static constexpr uintptr_t page = uintptr_t{1} << 21;
  static constexpr int collapse = 25;  // MADV_COLLAPSE of Linux 6.1: older headers don't name it, older systems refuse
  struct Buffer {
    uintptr_t begin = 0, large_to = 0;
  };
  std::map<int, Buffer> buffers_;  // by tag
};

}  // namespace bw::coupling
