// SPDX-License-Identifier: Apache-2.0
// Counter-based random numbers: a pure function of (seed, id, event), so results do not depend on threads, ranks or restart.
#pragma once
#include <cstdint>

namespace bw {

/// SplitMix64's finaliser [Steele, Lea, Flood 2014].
constexpr uint64_t mix64(uint64_t z) {
  z += 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  return z ^ (z >> 31);
}
/// Uniform in [0, 1) for (seed, global id, event).
constexpr double uniform01(uint64_t seed, uint64_t id, uint64_t event = 0) {
  return double(mix64(mix64(mix64(seed) ^ id) ^ event) >> 11) * 0x1p-53;
}

}  // namespace bw
