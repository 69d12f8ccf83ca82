// SPDX-License-Identifier: Apache-2.0
#include "common/io/checkpoint.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>

#include "common/app/checkpoint_clock.h"
#include "common/app/error.h"

using namespace bw;

namespace {

struct Pair {
  double a = 0;
  int32_t b = 0, c = 0;
};

std::string folder(const std::string& name) {
  const std::string path = testing::TempDir() + "bw_" + name;
  std::filesystem::remove_all(path);
  std::filesystem::create_directories(path);
  return path;
}
std::string write_case(const std::string& path, const std::string& text) {
  std::ofstream(path) << text;
  return path;
}
std::string message_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}
void write(const std::string& path, const CheckpointHead& head) {
  CheckpointWriter out(path, head, Comm());
  const Saved flow = out.section("flow");
  std::vector<double> U(40000);
  for (size_t i = 0; i < U.size(); ++i) U[i] = 1.0 / double(i + 3);
  flow.rows("U", U, 4);
  flow.rows("pairs", std::vector<Pair>{{0.1, 1, 2}, {1.0 / 3, 3, 4}});
  flow.number("step", int64_t(7));
  flow.section("inner").same("none", std::vector<double>());
  EXPECT_FALSE(std::filesystem::exists(path));
  out.finish();
}

}  // namespace

TEST(Checkpoint, gives_back_every_bit) {
  const std::string path = checkpoint_path(folder("checkpoint"), "fluid", 1234);
  EXPECT_NE(path.find("fluid_checkpoint_00001234.h5"), std::string::npos);
  write(path, {"fluid", 3, "abc", 1234, 1.0 / 7, 1});
  CheckpointHead head{"fluid", 3, "abc"};
  const CheckpointReader in(path, head, Comm());
  EXPECT_EQ(head.step, 1234);
  EXPECT_EQ(head.t, 1.0 / 7);
  EXPECT_EQ(head.ranks, 1);
  const Restored flow = in.section("flow");
  EXPECT_EQ(flow.count("U"), 10000);
  EXPECT_EQ(flow.rows<double>("U", 9999).at(3), 1.0 / 40002);
  const std::vector<Pair> pairs = flow.rows<Pair>("pairs");
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[1].a, 1.0 / 3);
  EXPECT_EQ(pairs[1].c, 4);
  EXPECT_EQ(flow.number<int64_t>("step"), 7);
  EXPECT_TRUE(flow.section("inner").same<double>("none").empty());
  EXPECT_NE(message_of([&] { flow.rows<double>("V"); }).find("has no V"), std::string::npos);
}

TEST(Checkpoint, refuses_what_is_not_its_own) {
  const std::string place = folder("checkpoint_refused"), path = checkpoint_path(place, "fluid", 5);
  EXPECT_NE(message_of([&] { find_checkpoint(place, "fluid"); }).find("no checkpoint of the fluid"), std::string::npos);
  write(path, {"fluid", 3, "abc", 5, 0.0, 1});
  const auto reads = [&](CheckpointHead head) { return message_of([&] { CheckpointReader(path, head, Comm()); }); };
  EXPECT_EQ(reads({"fluid", 3, "abc"}), "");
  EXPECT_NE(reads({"solid", 3, "abc"}).find("expected one of the solid"), std::string::npos);
  EXPECT_NE(reads({"fluid", 4, "abc"}).find("layout 3"), std::string::npos);
  EXPECT_NE(reads({"fluid", 3, "abd"}).find("another case"), std::string::npos);
  std::ofstream(path) << "no HDF5";
  EXPECT_NE(reads({"fluid", 3, "abc"}).find("not a checkpoint"), std::string::npos);
}

TEST(Checkpoint, the_latest_complete_one_is_found_and_old_ones_go) {
  const std::string place = folder("checkpoint_latest");
  for (const int64_t step : {9, 10, 200000000})
    write(checkpoint_path(place, "fluid", step), {"fluid", 1, "x", step, 0.0, 1});
  std::ofstream(checkpoint_path(place, "fluid", 300000000) + ".tmp") << "half";
  std::ofstream(checkpoint_path(place, "solid", 400000000)) << "another program's";
  EXPECT_EQ(find_checkpoint(place, "fluid"), checkpoint_path(place, "fluid", 200000000));
  EXPECT_EQ(find_checkpoint(place, "fluid", 10), checkpoint_path(place, "fluid", 10));
  EXPECT_NE(message_of([&] { find_checkpoint(place, "fluid", 11); }), "");
  drop_old_checkpoints(place, "fluid", 2);
  EXPECT_FALSE(std::filesystem::exists(checkpoint_path(place, "fluid", 9)));
  EXPECT_TRUE(std::filesystem::exists(checkpoint_path(place, "fluid", 10)));
}

TEST(Checkpoint, the_hash_is_of_what_matters) {
  const std::string place = folder("checkpoint_hash");
  const std::string one =
      write_case(place + "/a.toml",
                 "title = \"x\"\n[time]\nend = 1\n[fluid]\nthreads = 1\ncells = [4, 1, 1]\nlower = [0, 0, 0]\n");
  const std::string same = write_case(place + "/b.toml",
                                      "# note\n[fluid]\nlower = [0.0, 0, 0]\ncells = [4, 1,  1]\n[time]\nend = "
                                      "2\n[checkpoint]\nevery_steps = 3\n[output]\nexact = true\n");
  const std::string other = write_case(place + "/c.toml", "[fluid]\nlower = [0, 0, 0]\ncells = [4, 1, 2]\n");
  EXPECT_EQ(case_hash(one).size(), 16u);
  EXPECT_EQ(case_hash(one), case_hash(same));
  EXPECT_NE(case_hash(one), case_hash(other));
}

TEST(Checkpoint, clock) {
  RunControl::Checkpoint rules;
  rules.every = 0.1;
  rules.every_steps = 10;
  CheckpointClock clock(rules, 0.05, 3);
  EXPECT_FALSE(clock.wanted(0.06, 4));
  EXPECT_TRUE(clock.wanted(0.10, 5));  // by time
  EXPECT_FALSE(clock.wanted(0.11, 9));
  EXPECT_TRUE(clock.wanted(0.12, 10));  // by steps
  EXPECT_FALSE(clock.wanted(0.13, 11));
  std::raise(SIGUSR1);
  EXPECT_TRUE(clock.wanted(0.14, 12));
  EXPECT_FALSE(clock.wanted(0.15, 13));
  CheckpointClock never({}, 0, 0);
  EXPECT_FALSE(never.wanted(1, 1000));
}
