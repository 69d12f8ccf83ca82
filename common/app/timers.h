// SPDX-License-Identifier: Apache-2.0
// Where the time goes: named scopes that nest into a tree. Main thread only; about 0.1 us a scope.
//
//   Timed timed("internal force");
//   Timed timed("wait for loads", Timed::waiting);
#pragma once
#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "common/io/json.h"

namespace bw {

class Timers {
 public:
  using Clock = std::chrono::steady_clock;
  struct Node {
    const char* name;
    bool waiting = false;
    int parent = -1;
    std::vector<int> inside;
    double seconds = 0;
    int64_t calls = 0;
  };
  Timers() { restart(); }
  void restart();

  void enter(const char* name, bool waiting);
  void leave(double seconds);

  double wall() const;                            ///< seconds since the start
  double cpu() const;                             ///< of all threads, since the start
  double waiting_share() const;                   ///< part of the wall time spent in scopes marked as waiting
  double seconds(const std::string& name) const;  ///< of all scopes of that name
  std::string table() const;                      ///< the tree as text, with shares
  JsonObject json() const;  ///< {"name": {"seconds":, "calls":, "waiting": true, "inside": {...}}, ...}

 private:
  JsonObject json_of(int node) const;
  void print(int node, int depth, std::string& out) const;
  std::vector<Node> nodes_;  ///< [0] is the whole run
  int here_ = 0;
  Clock::time_point start_;
  double cpu_start_ = 0;
};

/// The timers of this program.
Timers& timers();

class Timed {
 public:
  enum Kind { working, waiting };
  /// `name` must live as long as the program: a literal.
  explicit Timed(const char* name, Kind kind = working) : start_(Timers::Clock::now()) {
    timers().enter(name, kind == waiting);
  }
  ~Timed() { timers().leave(std::chrono::duration<double>(Timers::Clock::now() - start_).count()); }
  Timed(const Timed&) = delete;

 private:
  Timers::Clock::time_point start_;
};

}  // namespace bw
