// SPDX-License-Identifier: Apache-2.0
#include "coupling/check/driver.h"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <future>
#include <iterator>
#include <thread>

#include "common/app/error.h"
#include "common/app/log.h"
#include "coupling/check/scenario.h"

namespace bw::coupling::check {
namespace {

constexpr int patience = 60;  // s, then a pair hangs

std::string quoted(const std::string& word) {
  std::string text = "'";
  for (const char c : word) {
    if (c == '\'')
      text += "'\\''";
    else
      text += c;
  }
  text += "'";
  return text;
}

struct Ended {
  int code = 0;
  double at = 0;  ///< s, steady clock
  std::string text;
};

Ended start(const std::string& command) {
  Ended ended;
  FILE* pipe = popen(command.c_str(), "r");
  if (!pipe) return {.code = 127, .text = "mpirun cannot be started"};
  char buffer[4096];
  for (size_t n = 0; (n = fread(buffer, 1, sizeof buffer, pipe)) > 0;) ended.text.append(buffer, n);
  const int status = pclose(pipe);
  ended.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  ended.at = std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  return ended;
}

/// Lines of errors, without mpirun's own.
std::string errors_in(const std::string& text) {
  std::string lines;
  size_t at = 0;
  while (at < text.size()) {
    const size_t end = std::min(text.find('\n', at), text.size());
    const std::string line = text.substr(at, end - at);
    if (line.find("rror: ") != line.npos && line.find("accident at") == line.npos)
      lines += fmt::format("\n        {}", line);
    at = end + 1;
  }
  return lines.empty() ? fmt::format("\n{}", text) : lines;
}

double accident_in(const std::string& text) {
  const size_t at = text.rfind("accident at ");
  return at == text.npos ? -1 : std::strtod(text.c_str() + at + 12, nullptr);
}

std::string bytes_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// What Open MPI needs to join programs of two mpiruns.
class MeetingServer {
 public:
  void start() {
    process_ = fork();
    if (process_ == 0) {
      execlp("ompi-server", "ompi-server", "--no-daemonize", "-r", file_.c_str(), nullptr);
      _exit(127);
    }
    for (int i = 0; i < 100 && !std::filesystem::exists(file_); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (!std::filesystem::exists(file_)) throw InputError("--port: ompi-server does not start");
  }
  ~MeetingServer() {
    if (process_ <= 0) return;
    kill(process_, SIGTERM);
    waitpid(process_, nullptr, 0);
    std::filesystem::remove(file_);
  }
  const std::string& file() const { return file_; }

 private:
  std::string file_ = std::filesystem::temp_directory_path() / fmt::format("fsi-check-server.{}", getpid());
  pid_t process_ = 0;
};

class Driver {
 public:
  Driver(const std::string& self, const Options& options, const std::vector<std::string>& arguments)
      : self_(self),
        options_(options),
        folder_(std::filesystem::temp_directory_path() / fmt::format("fsi-check.{}", getpid())) {
    if (!options.port.empty()) server_.start();
    for (const std::string& word : arguments) arguments_ += fmt::format(" {}", quoted(word));
    for (const std::string& word : options.command) program_ += fmt::format(" {}", quoted(word));
    std::filesystem::create_directories(folder_);
  }
  ~Driver() { std::filesystem::remove_all(folder_); }

  /// Empty: as expected.
  std::string fault_of(const Scenario& scenario) {
    const Ended ended = play(scenario.name, scenario.ranks, scenario.turned);
    if (ended.code == 124 || ended.code == 137) {
      if (scenario.code != -1 || ended.code == 124)
        return fmt::format("hangs: not over after {} s\n{}", patience, ended.text);
    }
    const bool as_expected = scenario.code < 0 ? ended.code != 0 : ended.code == scenario.code;
    if (!as_expected) return fmt::format("exit code {}{}", ended.code, errors_in(ended.text));
    if (scenario.timed) {
      const double accident = accident_in(ended.text), seconds = ended.at - accident - scenario.wait;
      if (accident < 0) return "ended before the accident" + errors_in(ended.text);
      if (seconds > options_.limit)
        return fmt::format("{:.1f} s from the accident to the end, {:g} s are allowed", seconds, options_.limit);
    }
    if (*scenario.like) {
      if (!std::filesystem::exists(record_of(scenario.like)))
        if (const Ended one = play(scenario.like, 1, false); one.code != 0)
          return fmt::format("on one rank: exit code {}{}", one.code, errors_in(one.text));
      const std::string mine = bytes_of(record_of(scenario.name)), other = bytes_of(record_of(scenario.like));
      if (mine.empty() || mine != other)
        return fmt::format("{} bytes were exchanged, {} on one rank, and they differ", mine.size(), other.size());
    }
    return "";
  }

 private:
  std::string record_of(const std::string& scenario) const { return folder_ / scenario; }
  Ended play(const std::string& scenario, int ranks, bool turned) const {
    if (!options_.port.empty()) return play_apart(scenario, ranks, turned);
    const std::string player = fmt::format("-n 1 {}{} --scenario {} --record {}", quoted(self_), arguments_, scenario,
                                           quoted(record_of(scenario)));
    const std::string program = fmt::format("-n {}{}", ranks, program_);
    return start(fmt::format("timeout -k 2 {} mpirun {} : {} 2>&1", patience, turned ? program : player,
                             turned ? player : program));
  }

  /// Two mpiruns, which meet by the port file; the one of a run that died is there first.
  Ended play_apart(const std::string& scenario, int ranks, bool turned) const {
    std::ofstream(options_.port) << "BWCOUPL 1\nhost localhost\ntcp 1\ntoken 0123456789abcdef\nmpi none\n";
    const std::string player =
        fmt::format("{}{} --scenario {} --record {}", quoted(self_), arguments_, scenario, quoted(record_of(scenario)));
    const auto run = [&](int n, const std::string& program) {
      return start(fmt::format("timeout -k 2 {} mpirun --ompi-server file:{} -n {} {} 2>&1", patience,
                               quoted(server_.file()), n, program));
    };
    auto first = std::async(std::launch::async, [&] { return turned ? run(ranks, program_) : run(1, player); });
    std::this_thread::sleep_for(std::chrono::milliseconds(turned ? 1000 : 0));
    const Ended second = turned ? run(1, player) : run(ranks, program_), one = first.get();
    const Ended& played = turned ? second : one;
    Ended ended = turned ? one : second;
    if (played.code == exit_found_wanting || (ended.code == 0 && played.code < 128)) ended.code = played.code;
    ended.text = played.text + ended.text;
    return ended;
  }

  std::string self_, arguments_, program_;
  const Options& options_;
  std::filesystem::path folder_;
  MeetingServer server_;
};

bool is_wanted(const Scenario& scenario, const Options& options) {
  const auto names = [&](const std::vector<std::string>& list) {
    return std::find(list.begin(), list.end(), scenario.name) != list.end();
  };
  if (names(options.skip)) return false;
  if (!options.only.empty()) return names(options.only);
  return options.play != "solid" || std::string(scenario.name) != "co_moving" || options.has_flow;
}

/// Programs that take turns on few cores, and mpirun for root: what the user has set already stays.
void set_environment() {
  for (const auto& [name, value] : {std::pair{"OMPI_MCA_rmaps_base_oversubscribe", "1"},
                                    {"OMPI_MCA_hwloc_base_binding_policy", "none"},
                                    {"OMPI_MCA_mpi_yield_when_idle", "1"},
                                    {"OMP_WAIT_POLICY", "passive"},
                                    {"BREAKWAVE_PROGRESS", "off"}})
    setenv(name, value, 0);
  if (geteuid() != 0) return;
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 0);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 0);
}

}  // namespace

int run_all(const std::string& self, const Options& options, const std::vector<std::string>& arguments) {
  set_environment();
  Driver driver(self, options, arguments);
  int failed = 0, played = 0;
  for (const Scenario& scenario : scenarios_of(options.play)) {
    if (!is_wanted(scenario, options)) continue;
    const std::string fault = driver.fault_of(scenario);
    ++played;
    failed += !fault.empty();
    say("{:6} {:14} {}{}", fault.empty() ? "ok" : "FAILED", scenario.name, scenario.expected,
        fault.empty() ? "" : "\n    but: " + fault);
  }
  say("{} of {} scenarios as expected", played - failed, played);
  if (played == 0) error_line("no such scenario");
  return played == 0 ? 1 : failed;
}

}  // namespace bw::coupling::check
