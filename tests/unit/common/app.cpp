// SPDX-License-Identifier: Apache-2.0
// What every program needs around its physics: schedules, command line, timers, progress, summary, exit codes.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "common/app/cli.h"
#include "common/app/guarded.h"
#include "common/app/log.h"
#include "common/app/machine.h"
#include "common/app/progress.h"
#include "common/app/run_control.h"
#include "common/app/summary.h"
#include "common/app/timers.h"
#include "common/app/version.h"
#include "common/io/file.h"

using namespace bw;

TEST(Schedule, hits_whole_multiples_without_drift) {
  const double interval = 1e-7;
  Schedule s(interval, Schedule::Zero::never);
  int rows = 0;
  double t = 0;
  EXPECT_TRUE(s.due(0));
  while (rows < 1000000) {
    t = s.next_time(t);
    ASSERT_EQ(t, double(rows + 1) * interval);
    ASSERT_FALSE(s.due(std::nextafter(t, 0) - 1e-3 * interval));
    ASSERT_TRUE(s.due(t));
    ASSERT_FALSE(s.due(t));
    ++rows;
  }
}

TEST(Schedule, several_multiples_in_one_step_count_once) {
  Schedule s(1.0, Schedule::Zero::never);
  EXPECT_TRUE(s.due(0));
  EXPECT_FALSE(s.due(0.5));
  EXPECT_TRUE(s.due(3.7));
  EXPECT_FALSE(s.due(3.9));
  EXPECT_TRUE(s.due(4.0));
  EXPECT_EQ(s.next_time(4.0), 5.0);
  s.skip_to(7.2);
  EXPECT_FALSE(s.due(7.9));
  EXPECT_TRUE(s.due(8.0));
}

TEST(Schedule, interval_zero) {
  Schedule never(0, Schedule::Zero::never), always(0, Schedule::Zero::every_step);
  EXPECT_FALSE(never.due(0));
  EXPECT_TRUE(always.due(0));
  EXPECT_TRUE(always.due(0.1));
  EXPECT_TRUE(std::isinf(never.next_time(1)) && std::isinf(always.next_time(1)));
}

TEST(RunControl, reads_its_part) {
  Keys k = Keys::read_text("title = \"x\"\n[time]\nend = \"150 us\"\n[output]\nfields_every = \"10 us\"\n");
  RunControl run;
  run.describe(k);
  k.finish();
  EXPECT_EQ(run.time.end, 150e-6);
  EXPECT_EQ(run.output.fields_every, 10e-6);
  EXPECT_EQ(run.output.directory, "out");
  Keys wrong = Keys::read_text("[time]\nend = 0\n");
  EXPECT_THROW(run.describe(wrong), InputError);
}

namespace {

CommandLine command(std::vector<std::string> words) {
  words.insert(words.begin(), "csd");
  std::vector<char*> argv;
  for (auto& w : words) argv.push_back(w.data());
  return read_command_line(int(argv.size()), argv.data(), "csd", "solid");
}

}  // namespace

TEST(CommandLine, options_replace_keys) {
  const CommandLine line = command({"case.toml", "--check", "--threads", "3", "--output", "there", "--end", "20 us"});
  EXPECT_EQ(line.case_file, "case.toml");
  EXPECT_TRUE(line.check);
  EXPECT_EQ(line.threads, 3);
  RunControl run;
  line.apply(run);
  EXPECT_EQ(run.output.directory, "there");
  EXPECT_DOUBLE_EQ(run.time.end, 20e-6);
  EXPECT_EQ(command({"--end", "1e-3", "case.toml"}).end, 1e-3);
  EXPECT_TRUE(command({"--manual"}).manual);
  EXPECT_FALSE(command({"--manual"}).exit_code);
}

TEST(CommandLine, wrong_lines_are_input_errors) {
  EXPECT_THROW(command({}), InputError);
  EXPECT_THROW(command({"case.toml", "--chekc"}), InputError);
  EXPECT_THROW(command({"case.toml", "--end", "20 m"}), InputError);
  EXPECT_THROW(command({"case.toml", "--end", "soon"}), InputError);
  EXPECT_THROW(command({"case.toml", "--end", "0 s"}), InputError);
  EXPECT_THROW(command({"case.toml", "--threads", "-1"}), InputError);
  EXPECT_THROW(command({"case.toml", "--threads", "x"}), InputError);
  EXPECT_THROW(command({"one.toml", "two.toml"}), InputError);
}

TEST(CommandLine, version_and_help_are_done) {
  testing::internal::CaptureStdout();
  EXPECT_EQ(command({"--version"}).exit_code, 0);
  EXPECT_EQ(command({"--help"}).exit_code, 0);
  const std::string text = testing::internal::GetCapturedStdout();
  EXPECT_NE(text.find(std::string("csd ") + version()), std::string::npos);
  EXPECT_NE(text.find("--check"), std::string::npos);
}

TEST(Timers, scopes_nest_and_add_up) {
  timers().restart();
  for (int i = 0; i < 3; ++i) {
    Timed outer("outer");
    {
      Timed inner("inner");
      usleep(2000);
    }
    Timed wait("wait", Timed::waiting);
    usleep(1000);
  }
  EXPECT_GE(timers().seconds("inner"), 0.006);
  EXPECT_GE(timers().seconds("outer"), timers().seconds("inner") + timers().seconds("wait"));
  EXPECT_GT(timers().waiting_share(), 0.1);
  EXPECT_LT(timers().waiting_share(), 0.9);
  const std::string json = timers().json().text();
  EXPECT_NE(json.find("\"outer\": {"), std::string::npos) << json;
  EXPECT_NE(json.find("\"calls\": 3"), std::string::npos) << json;
  EXPECT_NE(timers().table().find("waiting"), std::string::npos);
}

TEST(Progress, line_has_share_and_time_to_go) {
  const Progress p(2.0, 0, Progress::Style::lines);
  EXPECT_EQ(p.line(7, 0.5, 30, "dt 1e-3 (elem 4)"), "step 7 t 0.5 s (25.0 %), 1 min 30 s to go, dt 1e-3 (elem 4)");
  const Progress by_steps(2.0, 10, Progress::Style::lines);
  EXPECT_EQ(by_steps.line(5, 0.5, 30, ""), "step 5 t 0.5 s (50.0 %), 30 s to go");
  const Progress bar(2.0, 0, Progress::Style::bar);
  EXPECT_EQ(bar.line(7, 0.5, 30, "").substr(0, 26), "[######..................]");
  EXPECT_EQ(shown_duration(45.2), "45 s");
  EXPECT_EQ(shown_duration(12000), "3 h 20 min");
}

TEST(Summary, is_complete_json) {
  set_speaker("csd", true);
  Summary s;
  s.case_file = "a \"b\"\n.toml";
  s.steps = 12;
  s.t = 0.1;
  s.energies = {{"kinetic", 1.5}, {"lost", std::nan("")}};
  const std::string path = testing::TempDir() + "bw_summary.json";
  s.write(path, timers());
  set_speaker("", true);
  std::ifstream in(path);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  for (const char* piece :
       {"\"program\": \"csd\"", "\"case\": \"a \\\"b\\\"\\u000a.toml\"", "\"steps\": 12,", "\"t\": 0.1,",
        "\"energies\": {\n    \"kinetic\": 1.5,\n    \"lost\": null\n  }", "\"masses\": {}", "\"timers\": {"})
    EXPECT_NE(text.find(piece), std::string::npos) << piece << "\n" << text;
  EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));
}

TEST(File, errors_name_the_file) {
  EXPECT_THROW(write_atomically("/nowhere/x", "y"), std::runtime_error);
  EXPECT_THROW(make_folder("/proc/x/y"), InputError);
  const std::string folder = testing::TempDir() + "bw_a/b/c";
  make_folder(folder);
  make_folder(folder);
  EXPECT_TRUE(std::filesystem::is_directory(folder));
}

TEST(Machine, warns_of_more_threads_than_cpus) {
  EXPECT_GE(allowed_cpus(), 1);
  EXPECT_GE(machine_cpus(), allowed_cpus());
  EXPECT_NE(thread_warning(allowed_cpus() + 1).find("--bind-to none"), std::string::npos);
  if (allowed_cpus() == machine_cpus()) {
    EXPECT_EQ(thread_warning(allowed_cpus()), "");
  }
  EXPECT_GT(peak_memory(), 1 << 20);
}

namespace {

/// Exit code of a program that ends as `body` does; its last line on stderr.
std::pair<int, std::string> run_guarded(const std::function<int()>& body) {
  int ends[2];
  if (pipe(ends) != 0) return {-1, ""};
  const pid_t child = fork();
  if (child == 0) {
    dup2(ends[1], STDERR_FILENO);
    int argc = 0;
    char** argv = nullptr;
    int code;
    {
      Session session(argc, argv);
      set_speaker("csd", true);
      code = guarded(session, body);
    }
    _exit(code);
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n; (n = read(ends[0], buffer, sizeof buffer)) > 0;) text.append(buffer, size_t(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text};
}

}  // namespace

TEST(Guarded, exceptions_become_exit_codes_and_messages) {
  EXPECT_EQ(run_guarded([] { return 0; }).first, 0);
  const auto input = run_guarded([]() -> int { throw InputError("case.toml:3: x: unknown key"); });
  EXPECT_EQ(input.first, 2);
  EXPECT_NE(input.second.find("[csd] error: case.toml:3: x: unknown key\n"), std::string::npos) << input.second;
  EXPECT_EQ(run_guarded([]() -> int { throw PhysicsError("inverted"); }).first, 3);
  EXPECT_EQ(run_guarded([]() -> int { throw CodedError(66, "peer gone"); }).first, 66);
  const auto bug = run_guarded([]() -> int {
    BW_CHECK(1 == 2);
    return 0;
  });
  EXPECT_EQ(bug.first, 1);
  EXPECT_NE(bug.second.find("1 == 2"), std::string::npos);
}
