// SPDX-License-Identifier: Apache-2.0
// The line between the two programs: messages, polite waiting, and one way to fail for all. Bytes and rules:
// PROTOCOL.md.
//
// A failure on either side (exception, exit(), a bad message, silence) is told to the other side, printed by both, and
// ends both with the same nonzero code. The failing path never calls MPI_Finalize: that would wait for the other
// program for ever.
#pragma once
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/parallel/mpi.h"
#include "coupling/lifeline.h"

namespace bw::coupling {

class StandIn;

enum class Role { solid, fluid };
const char* name_of(Role role);  ///< "solid", "fluid"

/// Exit codes of a coupled run, besides those of common/app/error.h.
enum CouplingExit {
  exit_protocol = 64,      ///< not this protocol: magic, byte order
  exit_version = 65,       ///< major version differs
  exit_disagreement = 66,  ///< the two cases contradict each other
  exit_apart = 67,         ///< the wet surface lies outside the fluid's domain
  exit_malformed = 68,     ///< a message of the wrong size, order or window
  exit_bad_value = 69,     ///< not a number, or out of range, in a named field
  exit_unspecified = 70,   ///< a failure without a code
  exit_left = 71,          ///< exit() or return while the coupling was open
  exit_terminate = 72,     ///< uncaught exception
  exit_join = 73,          ///< the other program did not join
  exit_silence = 75,       ///< silence limit
  exit_bye = 76,           ///< BYE out of turn
  exit_killed = 77,        ///< ended from outside: the other program died, or the job was cancelled
  exit_ledger = 78,        ///< the books of the two sides do not agree
  exit_record = 79,        ///< a record that doesn't fit the run, or ends before it
};

/// What a channel waits for, and how long.
struct ChannelLimits {
  double silence = 600;    ///< s without the awaited message
  double heartbeat = 10;   ///< s between two lines "waiting for ..."
  double acknowledge = 1;  ///< s that a failing program waits for the other to print the reason
};

/// One per process. Leaders (rank 0 of each side) exchange; every rank of a side holds a Channel for fail() and
/// share().
class Channel {
 public:
  /// Takes over `inter`, the intercommunicator of the two sides, and installs itself as the failure hook of guarded().
  /// line: to the other leader, of programs that mpirun did not start together.
  Channel(const Comm& mine, MPI_Comm inter, Role role, const ChannelLimits& limits,
          std::unique_ptr<Lifeline> line = nullptr);
  /// Without another program: the leader's is stood in for, the other ranks' is null.
  Channel(const Comm& mine, std::unique_ptr<StandIn> stand_in, Role role);
  /// Ends the program with exit_left if the coupling is still open, unless an exception is on its way to be reported.
  ~Channel();
  Channel(const Channel&) = delete;

  const Comm& mine() const;
  bool leader() const { return mine().root(); }
  Role role() const;
  /// The other program's name, from HELLO; "the other program" before.
  const std::string& peer() const;
  void set_peer(const std::string& name, double silence_limit);
  /// Where the run is, for the texts of failures.
  void set_place(int64_t window, double t);

  // --- leaders
  // ---------------------------------------------------------------------------------------------------------
  /// Starts sending; `data` must stay until flush().
  void send(int tag, const void* data, size_t bytes);
  template <class T>
  void send(int tag, std::span<const T> data) {
    send(tag, data.data(), data.size_bytes());
  }
  /// The other side may look: all that it waits for was started. flush() does so otherwise.
  void ring();
  /// Waits politely until all that was started is on its way.
  void flush();
  /// Waits politely for a message with one of the tags, which it returns. Fails on FAIL, on silence, and on BYE unless
  /// asked for.
  int wait(std::initializer_list<int> tags);
  /// Bytes of the awaited message.
  size_t size_of(int tag) const;
  /// Receives it; fails naming the message if its size is not `bytes`.
  void receive(int tag, const char* message, void* data, size_t bytes);
  /// To be called now and then in long computations: ends the program if the other one failed. Costs about 1 us.
  void poll();
  /// Both sides have said BYE: nothing is open any more.
  void close();

  // --- every rank
  // ------------------------------------------------------------------------------------------------------
  /// The leader's bytes to all ranks of this side, waiting politely.
  void share(void* data, size_t bytes);
  template <class T>
  void share(std::vector<T>& data) {
    int64_t n = int64_t(data.size());
    share(&n, sizeof n);
    data.resize(size_t(n));
    share(data.data(), data.size() * sizeof(T));
  }
  /// Tells the other side, prints, and ends both programs with `code`. Any rank, any time, any depth.
  [[noreturn]] void fail(int code, const std::string& text);

  double seconds_waited() const;  ///< in wait(), since the start

 private:
  struct State;
  std::shared_ptr<State> state_;
};

}  // namespace bw::coupling
