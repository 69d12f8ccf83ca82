// SPDX-License-Identifier: Apache-2.0
// MPI, owned and checked. Every call's error code is checked: MPI_ERRORS_RETURN, then an exception with MPI's text.
#pragma once
#include <mpi.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace bw {

/// Throws std::runtime_error with MPI's own text when code is an error.
void check_mpi(int code, const char* call);

/// Ends every rank of every program that was started together, now, without MPI_Finalize.
[[noreturn]] void abort_all(int code);

/// Not owned: a communicator and the few collectives that the programs use.
class Comm {
 public:
  Comm() = default;
  explicit Comm(MPI_Comm comm);
  MPI_Comm raw() const { return comm_; }
  int rank() const { return rank_; }
  int size() const { return size_; }
  bool root() const { return rank_ == 0; }
  double min(double a) const;
  double max(double a) const;
  int64_t sum(int64_t a) const;
  int64_t max(int64_t a) const;
  /// Sum of the ranks' values in rank order: the same bits on all ranks, whatever the MPI library's own order.
  double sum(double a) const;
  void sum(std::span<double> a) const;  ///< likewise, in place
  void barrier() const;
  /// All ranks' items, in rank order.
  template <class T> std::vector<T> gather_all(const std::vector<T>& mine) const;
  /// Rank r knows all[start[r]] ... all[start[r + 1] - 1]; afterwards all ranks know all of it. start [size + 1].
  void complete(std::span<double> all, std::span<const int> start) const;
  /// One item of each rank, in rank order.
  template <class T> std::vector<T> gather_one(const T& mine) const {
    std::vector<T> all(static_cast<size_t>(size_), mine);
    gather_bytes(&mine, sizeof mine, all.data());
    return all;
  }
  /// send[r] goes to rank r, receive[r] is filled by it. Both know the sizes; where they are empty nothing travels.
  void exchange(const std::vector<std::vector<double>>& send, std::vector<std::vector<double>>& receive) const;

 private:
  MPI_Comm comm_ = MPI_COMM_NULL;
  int rank_ = 0, size_ = 1;
  std::vector<char> gather_bytes(const void* data, size_t bytes) const;
  void gather_bytes(const void* data, size_t bytes, void* all) const;
};

template <class T>
std::vector<T> Comm::gather_all(const std::vector<T>& mine) const {
  const std::vector<char> bytes = gather_bytes(mine.data(), mine.size() * sizeof(T));
  std::vector<T> all(bytes.size() / sizeof(T));
  if (!bytes.empty()) __builtin_memcpy(static_cast<void*>(all.data()), bytes.data(), bytes.size());
  return all;
}

/// MPI_Init_thread(FUNNELED) ... MPI_Finalize. world() holds both programs when they were started together; the program's own
/// communicator comes from coupling's join (or is world() when alone).
class Session {
 public:
  Session(int& argc, char**& argv);
  ~Session();
  Session(const Session&) = delete;
  Comm world() const { return Comm(MPI_COMM_WORLD); }
  static bool is_there();
};

}  // namespace bw
