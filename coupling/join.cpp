// SPDX-License-Identifier: Apache-2.0
#include "coupling/join.h"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstring>
#include <thread>
#include <vector>

#include "common/app/log.h"
#include "common/app/timers.h"
#include "common/parallel/watchdog.h"
#include "coupling/messages.h"
#include "coupling/notice.h"
#include "coupling/port.h"

namespace bw::coupling {
namespace {

/// What every process of the world says of itself; the first 8 bytes keep other codes' collectives out.
struct JoinBlock {
  char magic[8];
  char role[16];
  uint32_t major, reserved;
};
static_assert(sizeof(JoinBlock) == 32);

[[noreturn]] void end(const std::string& text) {
  quiet_notice();
  error_line(fmt::format("cannot join: {} [exit code {}]", text, int(exit_join)));
  MPI_Abort(MPI_COMM_WORLD, exit_join);
  _exit(exit_join);
}

std::vector<JoinBlock> ask_all(const Comm& world, const JoinBlock& me, double limit) {
  std::vector<JoinBlock> all(static_cast<size_t>(world.size()));
  MPI_Request request;
  check_mpi(MPI_Iallgather(&me, sizeof me, MPI_BYTE, all.data(), sizeof me, MPI_BYTE, world.raw(), &request),
            "MPI_Iallgather");
  const auto start = std::chrono::steady_clock::now();
  for (int done = 0; !done;) {
    check_mpi(MPI_Test(&request, &done, MPI_STATUS_IGNORE), "MPI_Test");
    if (done) break;
    const double waited = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    if (waited > limit)
      end(fmt::format(
          "another program of this run has not joined within {:g} s (coupling.join_limit); it may hang, or is no "
          "program of this project",
          limit));
    std::this_thread::sleep_for(std::chrono::microseconds(waited < 0.01 ? 50 : 1000));
  }
  return all;
}

}  // namespace

Joined join(const Comm& world, Role role, const CouplingCase& cs) {
  if (cs.join == "port") return join_by_port(world, role, cs);
  const Timed timed("join", Timed::waiting);
  if (world.size() == 1) return {world, nullptr};
  set_notice(" before the programs had joined");
  watch(1.25 * cs.join_limit + 5, exit_join, "cannot join: another process of this run hangs (coupling.join_limit)");

  JoinBlock me{};
  std::memcpy(me.magic, protocol_magic, sizeof me.magic);
  std::snprintf(me.role, sizeof me.role, "%s", name_of(role));
  me.major = protocol_major;
  const std::vector<JoinBlock> all = ask_all(world, me, cs.join_limit);

  int peer_leader = -1;
  for (int rank = world.size() - 1; rank >= 0; --rank) {
    const JoinBlock& other = all[size_t(rank)];
    const bool solid = std::strcmp(other.role, name_of(Role::solid)) == 0;
    const bool fluid = std::strcmp(other.role, name_of(Role::fluid)) == 0;
    if (std::memcmp(other.magic, me.magic, sizeof me.magic) != 0 || (!solid && !fluid))
      end(fmt::format("rank {} of the run is no program of this project", rank));
    if (solid != (role == Role::solid)) peer_leader = rank;
  }
  if (peer_leader < 0) {  // the world is this program's alone
    quiet_notice();
    stop_watching();
    return {world, nullptr};
  }
  MPI_Comm raw = MPI_COMM_NULL, inter = MPI_COMM_NULL;  // live until MPI_Finalize
  check_mpi(MPI_Comm_split(world.raw(), int(role), world.rank(), &raw), "MPI_Comm_split");
  const Comm mine(raw);
  check_mpi(MPI_Intercomm_create(raw, 0, world.raw(), peer_leader, tag_hello, &inter), "MPI_Intercomm_create");
  quiet_notice();
  if (mine.root()) set_notice(" before the first window");
  ChannelLimits limits;
  limits.silence = cs.silence_limit;
  return {mine, std::make_unique<Channel>(mine, inter, role, limits)};
}

}  // namespace bw::coupling
