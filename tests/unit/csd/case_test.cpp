// SPDX-License-Identifier: Apache-2.0
// T19, T3: what is refused before the first step, and how a run ends that can't go on.
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <map>

#include "csd/run.h"

namespace bw::csd {
namespace {

const std::string block_mesh =
    "{kind = \"box\", lower = [0, 0, 0], upper = [\"1 cm\", \"1 cm\", \"1 cm\"], cells = [2, 2, 2]}";
std::string steel(const std::string& change = "", const std::string& value = "") {
  std::map<std::string, std::string> keys{{"density", "7800"}, {"young_modulus", "206e9"}, {"poisson_ratio", "0.3"}};
  if (!change.empty()) keys[change] = value;
  std::string text = "{kind = \"j2\", flow = {kind = \"linear\", yield_stress = 4e8, hardening = 1e9}";
  for (const auto& [key, v] : keys) text += ", " + key + " = " + v;
  return text + "}";
}
std::string block(const std::string& material = steel(), const std::string& more = "",
                  const std::string& mesh = block_mesh) {
  return "[time]\nend = \"20 us\"\n[[solid.body]]\nname = \"block\"\nmesh = " + mesh + "\nmaterial = " + material +
         "\n" + more;
}

class CaseFile : public testing::Test {
 protected:
  std::filesystem::path folder = std::filesystem::temp_directory_path() / ("csd_case_" + std::to_string(getpid()));
  void SetUp() override { std::filesystem::create_directories(folder); }
  void TearDown() override { std::filesystem::remove_all(folder); }
  Case read(const std::string& text) {
    CommandLine line;
    line.case_file = folder / "case.toml";
    line.output = folder / "out";
    std::ofstream(line.case_file) << text;
    return read_case(line);
  }
  /// The message of the InputError that reading and building end with.
  std::string refusal(const std::string& text) {
    try {
      build(read(text));
    } catch (const InputError& e) {
      return e.what();
    }
    return "not refused";
  }
};
#define EXPECT_SAYS(message, words) EXPECT_NE((message).find(words), std::string::npos) << (message)

TEST_F(CaseFile, GoodOneIsBuilt) { EXPECT_EQ(build(read(block())).mesh.elem_count(), 8); }

TEST_F(CaseFile, ImpossibleConstantsAreRefused) {
  EXPECT_SAYS(refusal(block(steel("poisson_ratio", "0.5"))), "poisson_ratio");
  EXPECT_SAYS(refusal(block(steel("young_modulus", "0.0"))), "young_modulus");
  EXPECT_SAYS(refusal(block(steel("young_modulus", "-1e9"))), "young_modulus");
  EXPECT_SAYS(refusal(block(steel("density", "0.0"))), "density");
  EXPECT_SAYS(refusal(block(steel("density", "\"7800 kg\""))), "density");
  EXPECT_SAYS(refusal(block(steel("colour", "1"))), "colour");
}

TEST_F(CaseFile, MissingThingsAreNamed) {
  EXPECT_SAYS(refusal("[time]\nend = 1.0\n[solid]\nthreads = 1\n"), "body");
  const std::string set = refusal(block(steel(), "[[solid.condition]]\nkind = \"fixed\"\nnodes = \"x_lowr\"\n"));
  EXPECT_SAYS(set, "x_lower");
  EXPECT_SAYS(set, "case.toml:");
  EXPECT_SAYS(
      refusal(
          block(steel(), "[[solid.load]]\nkind = \"pressure\"\nfaces = [\"inner\"]\ntimes = [0]\npressures = [1e5]\n")),
      "inner");
  EXPECT_SAYS(refusal(block(steel(), "[[solid.load]]\nkind = \"presure\"\n")), "pressure");
  EXPECT_SAYS(refusal(block(steel(), "[solid.filter]\nkind = \"plain\"\nstrength = 1.0\n")), "strength");
  EXPECT_SAYS(refusal(block(steel(), "[[solid.body]]\nname = \"block\"\nmesh = " + block_mesh +
                                         "\nmaterial = " + steel() + "\n")),
              "block");
  EXPECT_NE(refusal(block(steel(), "", "{kind = \"box\", lower = [0, 0, 0], upper = [1, 1, 1], cells = [0, 1, 1]}")),
            "not refused");
  EXPECT_SAYS(
      refusal(block(
          steel(), "[[solid.load]]\nkind = \"pressure\"\nfaces = [\"x_lower\"]\ntimes = [0, 0]\npressures = [1, 2]\n")),
      "times");
}

TEST_F(CaseFile, ManualNamesEveryKey) {
  const std::string manual = case_manual();
  for (const char* word :
       {"young_modulus", "pressure_front", "rigid_wall", "self_adjoint", "safety", "saturation", "separation"})
    EXPECT_SAYS(manual, word);
}

TEST_F(CaseFile, InvertedElementEndsTheRunByName) {  // a corner is driven through the opposite one
  const std::string text =
      block(steel(),
            "[output]\nfields_every = \"1 us\"\nhistory_every = \"1 us\"\n"
            "[[solid.condition]]\nkind = \"velocity\"\nnodes = \"corner\"\nvalue = [-3000, -3000, -3000]\n",
            "{kind = \"box\", lower = [0, 0, 0], upper = [\"1 cm\", \"1 cm\", \"1 cm\"], cells = [1, 1, 1], "
            "sets = [{name = \"corner\", lower = [\"9 mm\", \"9 mm\", \"9 mm\"]}]}");
  const Case cs = read(text);
  Model m = build(cs);
  try {
    run(cs, m, nullptr);
    FAIL() << "no failure";
  } catch (const PhysicsError& e) {
    EXPECT_SAYS(std::string(e.what()), "element 0");
    EXPECT_SAYS(std::string(e.what()), "inverted");
    EXPECT_SAYS(std::string(e.what()), "solid_0");  // last good fields
  }
  EXPECT_TRUE(std::filesystem::exists(folder / "out" / "solid_history.csv"));
  std::ifstream summary(folder / "out" / "solid_summary.json");
  const std::string json{std::istreambuf_iterator<char>(summary), {}};
  EXPECT_SAYS(json, "failed");
}

TEST_F(CaseFile, RunLeavesItsResults) {
  const Case cs = read(block(steel(),
                             "velocity = [0, 0, \"-50 m/s\"]\n[output]\nfields_every = \"10 us\"\nhistory_every = \"1 "
                             "us\"\n[[solid.condition]]\n"
                             "kind = \"rigid_wall\"\npoint = [0, 0, 0]\nnormal = [0, 0, 1]\n[[solid.probe]]\nkind = "
                             "\"wall_force\"\nname = \"wall\"\n"
                             "[[solid.probe]]\nkind = \"ring\"\nname = \"ring\"\n[[solid.probe]]\nkind = "
                             "\"node\"\nname = \"n\"\nposition = [0, 0, 0.01]\n"
                             "[[solid.probe]]\nkind = \"element\"\nname = \"e\"\nposition = [0, 0, 0]\n"));
  Model m = build(cs);
  EXPECT_EQ(run(cs, m, nullptr), 0);
  EXPECT_EQ(m.state.t, 20e-6);
  std::ifstream file(folder / "out" / "solid_history.csv");
  std::string line;
  int rows = -1;
  std::getline(file, line);
  EXPECT_SAYS(line, "wall fz [N]");
  EXPECT_SAYS(line, "n vz [m/s]");
  for (; std::getline(file, line);) ++rows;
  EXPECT_EQ(rows, 20);  // 0, 1, ... 20 us
  for (const char* name : {"solid_000000.vtkhdf", "solid_000002.vtkhdf", "solid.vtkhdf.series", "solid_summary.json"})
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
}

}  // namespace
}  // namespace bw::csd
