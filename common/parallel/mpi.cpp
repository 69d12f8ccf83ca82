// SPDX-License-Identifier: Apache-2.0
#include "common/parallel/mpi.h"

#include <climits>
#include <cstdlib>
#include <exception>
#include <stdexcept>

#include "common/parallel/watchdog.h"

namespace bw {

void check_mpi(int code, const char* call) {
  if (code == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING];
  int length = 0;
  MPI_Error_string(code, text, &length);
  throw std::runtime_error(std::string(call) + ": " + std::string(text, size_t(length)));
}

void abort_all(int code) {
  MPI_Abort(MPI_COMM_WORLD, code);
  std::terminate();  // not reached: MPI_Abort ends the process
}

Comm::Comm(MPI_Comm comm) : comm_(comm) {
  if (comm == MPI_COMM_NULL) return;
  check_mpi(MPI_Comm_set_errhandler(comm, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
  check_mpi(MPI_Comm_rank(comm, &rank_), "MPI_Comm_rank");
  check_mpi(MPI_Comm_size(comm, &size_), "MPI_Comm_size");
}

namespace {

/// One rank needs no call: a Comm of one works before MPI_Init and costs nothing.
template <class T>
T all_reduce(const Comm& comm, T a, MPI_Datatype type, MPI_Op op) {
  if (comm.size() == 1) return a;
  T result{};
  check_mpi(MPI_Allreduce(&a, &result, 1, type, op, comm.raw()), "MPI_Allreduce");
  return result;
}

}  // namespace

double Comm::min(double a) const { return all_reduce(*this, a, MPI_DOUBLE, MPI_MIN); }
double Comm::max(double a) const { return all_reduce(*this, a, MPI_DOUBLE, MPI_MAX); }
int64_t Comm::sum(int64_t a) const { return all_reduce(*this, a, MPI_INT64_T, MPI_SUM); }
int64_t Comm::max(int64_t a) const { return all_reduce(*this, a, MPI_INT64_T, MPI_MAX); }

double Comm::sum(double a) const {
  sum(std::span(&a, 1));
  return a;
}

void Comm::sum(std::span<double> a) const {
  if (size_ == 1) return;
  const int n = int(a.size());
  std::vector<double> all(a.size() * size_t(size_));
  check_mpi(MPI_Allgather(a.data(), n, MPI_DOUBLE, all.data(), n, MPI_DOUBLE, comm_), "MPI_Allgather");
  for (size_t i = 0; i < a.size(); ++i) {
    double total = 0;
    for (int r = 0; r < size_; ++r) total += all[size_t(r) * a.size() + i];
    a[i] = total;
  }
}

void Comm::barrier() const {
  if (size_ > 1) check_mpi(MPI_Barrier(comm_), "MPI_Barrier");
}

void Comm::complete(std::span<double> all, std::span<const int> start) const {
  if (size_ == 1) return;
  std::vector<int> counts;
  for (int r = 0; r < size_; ++r) counts.push_back(start[size_t(r) + 1] - start[size_t(r)]);
  check_mpi(MPI_Allgatherv(MPI_IN_PLACE, 0, MPI_DOUBLE, all.data(), counts.data(), start.data(), MPI_DOUBLE, comm_),
            "MPI_Allgatherv");
}

void Comm::exchange(const std::vector<std::vector<double>>& send, std::vector<std::vector<double>>& receive) const {
  constexpr int tag = 1;
  std::vector<MPI_Request> started;
  for (int r = 0; r < size_; ++r)
    if (auto& in = receive[size_t(r)]; !in.empty())
      check_mpi(MPI_Irecv(in.data(), int(in.size()), MPI_DOUBLE, r, tag, comm_, &started.emplace_back()), "MPI_Irecv");
  for (int r = 0; r < size_; ++r)
    if (const auto& out = send[size_t(r)]; !out.empty())
      check_mpi(MPI_Isend(out.data(), int(out.size()), MPI_DOUBLE, r, tag, comm_, &started.emplace_back()), "MPI_Isend");
  check_mpi(MPI_Waitall(int(started.size()), started.data(), MPI_STATUSES_IGNORE), "MPI_Waitall");
}

void Comm::gather_bytes(const void* data, size_t bytes, void* all) const {
  if (size_ > 1)
    check_mpi(MPI_Allgather(data, int(bytes), MPI_BYTE, all, int(bytes), MPI_BYTE, comm_), "MPI_Allgather");
}

std::vector<char> Comm::gather_bytes(const void* data, size_t bytes) const {
  const char* begin = static_cast<const char*>(data);
  if (size_ == 1) return bytes ? std::vector<char>(begin, begin + bytes) : std::vector<char>();
  const int64_t mine = int64_t(bytes);
  std::vector<int64_t> sizes(static_cast<size_t>(size_));
  check_mpi(MPI_Allgather(&mine, 1, MPI_INT64_T, sizes.data(), 1, MPI_INT64_T, comm_), "MPI_Allgather");
  std::vector<int> counts(sizes.size()), starts(sizes.size());
  int64_t total = 0;
  for (size_t r = 0; r < sizes.size(); ++r) {
    starts[r] = int(total);
    counts[r] = int(sizes[r]);
    total += sizes[r];
    if (total > INT_MAX) throw std::runtime_error("gather_all: more than 2 GiB");
  }
  std::vector<char> all(static_cast<size_t>(total));
  check_mpi(MPI_Allgatherv(begin, int(mine), MPI_CHAR, all.data(), counts.data(), starts.data(), MPI_CHAR, comm_),
            "MPI_Allgatherv");
  return all;
}

namespace {

bool has_session = false;

/// s. MPI's own start can take long on many machines.
double start_limit() {
  const char* text = std::getenv("BREAKWAVE_START_LIMIT");
  const double given = text ? std::atof(text) : 0;
  return given > 0 ? given : 600;
}

}  // namespace

bool Session::is_there() { return has_session; }

Session::Session(int& argc, char**& argv) {
  has_session = true;
  const double limit = start_limit();
  watch(limit, 1,
        "MPI has not started within " + std::to_string(int(limit)) +
            " s (BREAKWAVE_START_LIMIT): another process of this run hangs, or died");
  int provided = 0;
  check_mpi(MPI_Init_thread(&argc, &argv, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread");
  check_mpi(MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
  check_mpi(MPI_Comm_set_errhandler(MPI_COMM_SELF, MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
  stop_watching();
}

Session::~Session() {
  // an exception on its way must not wait in MPI_Finalize for ranks that wait for this one
  if (std::uncaught_exceptions() > 0 && world().size() > 1) abort_all(1);
  MPI_Finalize();
}

}  // namespace bw
