// SPDX-License-Identifier: Apache-2.0
// What stands in for the other program in this process: takes the leader's messages and has the answers ready.
#pragma once
#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "coupling/messages.h"

namespace bw::coupling {

class StandIn {
 public:
  virtual ~StandIn() = default;
  /// A message of this program. A fault ends the run.
  virtual Verdict take(int tag, std::span<const char> bytes) = 0;

  struct Message {
    int tag;
    std::vector<char> bytes;
  };
  /// The next one with that tag; null: none is there, nor will be before the other side says something.
  const Message* next(int tag) const {
    const auto found = std::find_if(answers_.begin(), answers_.end(), [&](const Message& m) { return m.tag == tag; });
    return found == answers_.end() ? nullptr : &*found;
  }
  void drop(const Message* message) { answers_.erase(answers_.begin() + (message - &answers_.front())); }

 protected:
  void answer(int tag, const void* data, size_t bytes) {
    const auto* first = static_cast<const char*>(data);
    answers_.push_back({tag, std::vector<char>(first, first + bytes)});
  }
  template <class T>
  void answer(int tag, const std::vector<T>& values) {
    answer(tag, values.data(), values.size() * sizeof(T));
  }

 private:
  std::vector<Message> answers_;
};

/// HELLO of a recorded program as the answer to another run's: it goes on from where that does, and keeps no state.
inline HelloBlock replayed(HelloBlock recorded, const HelloBlock& asked) {
  recorded.program[23] = 0;
  std::strcat(recorded.program, " (record)");
  recorded.features &= ~uint64_t(feature_checkpoint);
  recorded.restart_id = asked.restart_id;
  recorded.restart_window = asked.restart_window;
  recorded.restart_hash = asked.restart_hash;
  if (asked.restart_id) recorded.t0 = asked.t0;
  return recorded;
}

/// A message as the block or the numbers that it holds.
template <class T>
T block_of(std::span<const char> bytes) {
  T block{};
  std::memcpy(static_cast<void*>(&block), bytes.data(), std::min(bytes.size(), sizeof block));
  return block;
}
template <class T>
std::vector<T> list_of(std::span<const char> bytes) {
  std::vector<T> values(bytes.size() / sizeof(T));
  std::memcpy(static_cast<void*>(values.data()), bytes.data(), values.size() * sizeof(T));
  return values;
}

}  // namespace bw::coupling
