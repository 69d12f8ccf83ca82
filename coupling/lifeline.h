// SPDX-License-Identifier: Apache-2.0
// A TCP connection between the leaders of two programs that mpirun did not start together. They find each other by
// it, and afterwards nothing is said on it: it breaks when the other process dies, which nobody else would tell.
#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace bw::coupling {

class Lifeline {
 public:
  Lifeline() = default;
  explicit Lifeline(int descriptor) : descriptor_(descriptor) {}
  Lifeline(Lifeline&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Lifeline& operator=(Lifeline&& other) noexcept {
    std::swap(descriptor_, other.descriptor_);
    return *this;
  }
  ~Lifeline();

  bool is_open() const { return descriptor_ >= 0; }
  /// The other end is gone. About 1 us.
  bool is_cut() const;
  /// All of it, within `limit` seconds; false: not possible.
  bool send(const void* data, size_t bytes) const;
  bool receive(void* data, size_t bytes, double limit) const;

 private:
  int descriptor_ = -1;
};

/// Waits for a connection from anywhere.
class Listener {
 public:
  /// std::runtime_error with the system's reason.
  Listener();
  ~Listener();
  Listener(const Listener&) = delete;
  int port() const { return port_; }
  /// One that has come, without waiting.
  std::optional<Lifeline> accept() const;

 private:
  int descriptor_ = -1, port_ = 0;
};

std::string host_name();
/// Nothing: nobody listens there, or not within `limit` seconds.
std::optional<Lifeline> connect_to(const std::string& host, int port, double limit);

}  // namespace bw::coupling
