// SPDX-License-Identifier: Apache-2.0
#include "coupling/port.h"

#include <fmt/format.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include "common/app/log.h"
#include "common/app/timers.h"
#include "common/io/file.h"
#include "coupling/lifeline.h"
#include "coupling/messages.h"
#include "coupling/notice.h"
#include "coupling/polite.h"

namespace bw::coupling {
namespace {

/// Said by both on the TCP connection, the fluid first.
struct MeetBlock {
  char magic[8];
  char role[16];
  uint32_t major, reserved;
  char token[16];  // of the port file: no other run's
};
static_assert(sizeof(MeetBlock) == 48);

struct PortFile {
  std::string host, token, mpi_port;
  int tcp_port = 0;
};

constexpr double answer_limit = 5, mpi_limit = 60;  // s

MeetBlock block(Role role, const std::string& token) {
  MeetBlock b{};
  std::memcpy(b.magic, protocol_magic, sizeof b.magic);
  std::snprintf(b.role, sizeof b.role, "%s", name_of(role));
  b.major = protocol_major;
  std::memcpy(b.token, token.data(), std::min(token.size(), sizeof b.token));
  return b;
}
bool fits(const MeetBlock& b, Role role, const std::string& token) {
  const MeetBlock wanted = block(role, token);
  return std::memcmp(b.magic, wanted.magic, sizeof b.magic) == 0 && std::strcmp(b.role, wanted.role) == 0 &&
         std::memcmp(b.token, wanted.token, sizeof b.token) == 0;
}

std::string new_token() {
  std::random_device random;
  return fmt::format("{:08x}{:08x}", random(), random());
}

std::string text_of(const PortFile& file) {
  return fmt::format("BWCOUPL {}\nhost {}\ntcp {}\ntoken {}\nmpi {}\n", protocol_major, file.host, file.tcp_port,
                     file.token, file.mpi_port);
}
std::optional<PortFile> read_port_file(const std::string& path) {
  std::ifstream in(path);
  PortFile file;
  std::string line, key;
  if (!std::getline(in, line) || line != fmt::format("BWCOUPL {}", protocol_major)) return {};
  while (std::getline(in, line)) {
    std::istringstream words(line);
    words >> key;
    if (key == "host") words >> file.host;
    if (key == "tcp") words >> file.tcp_port;
    if (key == "token") words >> file.token;
    if (key == "mpi") words >> file.mpi_port;
  }
  if (file.host.empty() || file.token.size() != 16 || file.mpi_port.empty() || file.tcp_port <= 0) return {};
  return file;
}

[[noreturn]] void give_up(const std::string& text) {
  quiet_notice();
  error_line(fmt::format("cannot join: {} [exit code {}]", text, int(exit_join)));
  MPI_Abort(MPI_COMM_WORLD, exit_join);
  _exit(exit_join);
}

/// Waiting at a port file for the other program, up to the limit.
class Waiting {
 public:
  /// owner: the file is this program's, and goes with it.
  Waiting(const std::string& path, double limit, bool owner) : path_(path), limit_(limit), owner_(owner) {}
  bool goes_on(const std::string& for_what) {
    if (patience_.seconds() > limit_) {
      std::error_code ignored;
      if (owner_) std::filesystem::remove(path_, ignored);
      give_up(fmt::format("{} within {:g} s (coupling.join_limit)", for_what, limit_));
    }
    if (patience_.seconds() > next_line_) {
      say("waiting at port file {}: {}", path_, for_what);
      next_line_ += 10;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return true;
  }

 private:
  std::string path_;
  double limit_, next_line_ = 10;
  bool owner_;
  Patience patience_;
};

Lifeline wait_for_fluid(PortFile& mine, const std::string& path, double limit) {
  const Listener listener;
  mine.host = host_name(), mine.tcp_port = listener.port(), mine.token = new_token();
  if (const std::string folder = std::filesystem::path(path).parent_path().string(); !folder.empty())
    make_folder(folder);
  write_atomically(path, text_of(mine));
  say("waiting for a fluid program at port file {}", path);
  std::optional<Lifeline> line;
  for (Waiting waiting(path, limit, true); waiting.goes_on("no fluid program came");) {
    line = listener.accept();
    MeetBlock other{};
    if (!line || !line->receive(&other, sizeof other, answer_limit) || !fits(other, Role::fluid, mine.token)) continue;
    const MeetBlock me = block(Role::solid, mine.token);
    if (line->send(&me, sizeof me)) break;
  }
  std::error_code ignored;
  std::filesystem::remove(path, ignored);
  return std::move(*line);
}

Lifeline find_solid(PortFile& theirs, const std::string& path, double limit) {
  std::string seen = "there is no such file";
  for (Waiting waiting(path, limit, false);
       waiting.goes_on(fmt::format("no solid program was found by it ({})", seen));) {
    const std::optional<PortFile> file = read_port_file(path);
    if (!file) {
      if (std::filesystem::exists(path)) seen = "it is no port file";
      continue;
    }
    std::optional<Lifeline> line = connect_to(file->host, file->tcp_port, 1);
    const MeetBlock me = block(Role::fluid, file->token);
    MeetBlock other{};
    if (line && line->send(&me, sizeof me) && line->receive(&other, sizeof other, answer_limit) &&
        fits(other, Role::solid, file->token)) {
      theirs = *file;
      return std::move(*line);
    }
    seen = fmt::format("it is an old one: nobody answers at {}:{}", file->host, file->tcp_port);
  }
  give_up("");
}

/// Ends the program if the other one dies while MPI joins the two, which MPI would wait for for ever.
class Guard {
 public:
  explicit Guard(const Lifeline& line)
      : thread_([this, &line] {
          const Patience patience;
          while (!done_) {
            if (line.is_cut()) end("the other program ended while MPI joined the two (it says why)");
            if (patience.seconds() > mpi_limit)
              end(fmt::format("MPI did not join the two programs within {:g} s", mpi_limit));
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
          }
        }) {}
  ~Guard() {
    done_ = true;
    thread_.join();
  }

 private:
  [[noreturn]] static void end(const std::string& text) {
    error_line(fmt::format("cannot join: {} [exit code {}]", text, int(exit_join)));
    _exit(exit_join);  // not the thread that may call MPI
  }
  std::atomic<bool> done_{false};
  std::thread thread_;
};

}  // namespace

Joined join_by_port(const Comm& world, Role role, const CouplingCase& cs) {
  const Timed timed("join", Timed::waiting);
  if (world.root()) set_notice(" before the programs had joined");
  signal(SIGPIPE, SIG_IGN);  // MPI may write to a program that has died; that is this one's to notice
  const bool solid = role == Role::solid;
  MPI_Comm raw = MPI_COMM_NULL, inter = MPI_COMM_NULL;  // live until MPI_Finalize
  check_mpi(MPI_Comm_dup(world.raw(), &raw), "MPI_Comm_dup");
  const Comm mine(raw);
  char mpi_port[MPI_MAX_PORT_NAME] = "";
  std::unique_ptr<Lifeline> line;
  if (mine.root()) {
    PortFile file;
    if (solid) {
      if (MPI_Open_port(MPI_INFO_NULL, mpi_port) != MPI_SUCCESS) give_up("MPI_Open_port failed");
      file.mpi_port = mpi_port;
    }
    line = std::make_unique<Lifeline>(solid ? wait_for_fluid(file, cs.port_file, cs.join_limit)
                                            : find_solid(file, cs.port_file, cs.join_limit));
    std::snprintf(mpi_port, sizeof mpi_port, "%s", file.mpi_port.c_str());
  }
  share_politely(mine, mpi_port, sizeof mpi_port);
  check_mpi(MPI_Comm_set_errhandler(mine.raw(), MPI_ERRORS_RETURN), "MPI_Comm_set_errhandler");
  {
    std::optional<Guard> guard;
    if (line) guard.emplace(*line);
    const int code = solid ? MPI_Comm_accept(mpi_port, MPI_INFO_NULL, 0, mine.raw(), &inter)
                           : MPI_Comm_connect(mpi_port, MPI_INFO_NULL, 0, mine.raw(), &inter);
    if (code != MPI_SUCCESS)
      give_up(
          "MPI cannot join two programs that were started apart. Open MPI needs a server for it: "
          "ompi-server --no-daemonize -r FILE &, then for each of the two mpirun --ompi-server file:FILE ... "
          "(or OMPI_MCA_pmix_server_uri=file:FILE)");
  }
  quiet_notice();
  if (mine.root()) set_notice(" before the first window");
  ChannelLimits limits;
  limits.silence = cs.silence_limit;
  return {mine, std::make_unique<Channel>(mine, inter, role, limits, std::move(line))};
}

}  // namespace bw::coupling
