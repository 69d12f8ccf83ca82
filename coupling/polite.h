// SPDX-License-Identifier: Apache-2.0
// Waiting that leaves the cores to the other program.
#pragma once
#include <algorithm>
#include <chrono>
#include <thread>

#include "common/parallel/mpi.h"
#include "coupling/bell.h"

namespace bw::coupling {

/// Sleeps longer the longer one waits: busy waiting would steal the other program's cores.
class Patience {
 public:
  void rest() const {
    const double waited = seconds();
    if (waited < 50e-6) return;
    std::this_thread::sleep_for(std::chrono::duration<double>(std::clamp(waited / 64, 50e-6, 2e-3)));
  }
  /// The same, until the bell rings: who knows that it will may sleep soundly.
  void rest(Bell& bell) const {
    const double waited = seconds();
    if (waited < 50e-6) return;
    bell.wait(bell.is_known() ? 5e-3 : std::clamp(waited / 64, 50e-6, 2e-3));
  }
  /// The same for one who doesn't know how often it will ring: from then on it is as if the waiting had just begun.
  void rest_anew(Bell& bell) {
    const double waited = seconds();
    if (waited >= 50e-6 && bell.wait(std::clamp(waited / 64, 50e-6, 2e-3))) *this = {};
  }
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Rank 0's bytes to all ranks; with a bell, which it rings, the others don't sleep on.
inline void share_politely(const Comm& comm, void* data, size_t bytes, Bell* bell = nullptr) {
  if (comm.size() == 1 || bytes == 0) return;
  MPI_Request request;
  check_mpi(MPI_Ibcast(data, int(bytes), MPI_BYTE, 0, comm.raw(), &request), "MPI_Ibcast");
  for (int rank = 1; bell && comm.root() && rank < comm.size(); ++rank) bell->ring(rank);
  Patience patience;
  for (int done = 0; !done;) {
    check_mpi(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
    if (done) break;
    if (bell && !comm.root())
      patience.rest_anew(*bell);
    else
      patience.rest();
  }
}

}  // namespace bw::coupling
