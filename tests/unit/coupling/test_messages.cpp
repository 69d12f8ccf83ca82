// SPDX-License-Identifier: Apache-2.0
// The wire format as PROTOCOL.md states it, and what the checks say of bad messages.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>

#include "coupling/channel.h"
#include "coupling/messages.h"

namespace bw::coupling {
namespace {

WetSurface square() {
  WetSurface s;
  s.x = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  s.v.assign(4, {});
  s.quads = {{0, 1, 2, 3}};
  s.node_id = {7, 8, 9, 10};
  s.node_parent.assign(4, -1);
  s.face_id = {3};
  s.body = {0};
  s.flags = {0};
  return s;
}

/// "| offset | type | name |" rows of the block's table in PROTOCOL.md.
size_t offset_in_protocol(const std::string& block, const std::string& field) {
  std::ifstream file(SOURCE_DIR "/coupling/PROTOCOL.md");
  std::string line;
  bool inside = false;
  while (std::getline(file, line)) {
    if (line.starts_with("#")) inside = line.find(block) != line.npos;
    if (!inside || line.find("`" + field + "`") == line.npos) continue;
    return size_t(std::stoul(line.substr(line.find('|') + 1)));
  }
  return size_t(-1);
}

#define EXPECT_OFFSET(block, type, field) \
  EXPECT_EQ(offset_in_protocol(block, #field), offsetof(type, field)) << block << " " #field

TEST(Wire, BlocksLieAsTheProtocolSays) {
  EXPECT_OFFSET("HELLO", HelloBlock, endian);
  EXPECT_OFFSET("HELLO", HelloBlock, role);
  EXPECT_OFFSET("HELLO", HelloBlock, p_ref);
  EXPECT_OFFSET("HELLO", HelloBlock, t_end);
  EXPECT_OFFSET("HELLO", HelloBlock, features);
  EXPECT_OFFSET("HELLO", HelloBlock, scheme);
  EXPECT_OFFSET("HELLO", HelloBlock, lower);
  EXPECT_OFFSET("HELLO", HelloBlock, restart_id);
  EXPECT_OFFSET("HELLO", HelloBlock, silence_limit);
  EXPECT_OFFSET("HELLO", HelloBlock, minor_needed);
  EXPECT_OFFSET("STEP", StepBlock, window);
  EXPECT_OFFSET("STEP", StepBlock, n_faces);
  EXPECT_OFFSET("STEP", StepBlock, t1_max);
  EXPECT_OFFSET("STEP", StepBlock, flags);
  EXPECT_OFFSET("STEP", StepBlock, hash);
  EXPECT_OFFSET("STEP", StepBlock, impulse);
  EXPECT_OFFSET("STEP", StepBlock, volume_gap);
  EXPECT_OFFSET("LOAD", LoadBlock, t1);
  EXPECT_OFFSET("LOAD", LoadBlock, flags);
  EXPECT_OFFSET("LOAD", LoadBlock, impulse);
  EXPECT_OFFSET("LOAD", LoadBlock, swept);
  EXPECT_OFFSET("LOAD", LoadBlock, momentum);
  EXPECT_OFFSET("LOAD", LoadBlock, dry_faces);
  EXPECT_OFFSET("LOAD", LoadBlock, dry_area);
  EXPECT_OFFSET("LOAD", LoadBlock, dt_next);
  EXPECT_OFFSET("BYE", ByeBlock, text);
  EXPECT_OFFSET("FAIL", FailBlock, window);
  EXPECT_OFFSET("FAIL", FailBlock, text);
  EXPECT_EQ(sizeof(Vec3), 24u);
}

TEST(Wire, HelloRoundTripAgrees) {
  CouplingCase cs;
  const Hello solid{.program = "csd", .version = "1", .t_end = 1, .lower = {0, 0, 0}, .upper = {1, 1, 1}};
  const Hello fluid{.program = "cfd", .version = "1", .t_end = 1, .lower = {-1, -1, -1}, .upper = {2, 2, 2}};
  const HelloBlock a = pack(solid, cs, "solid", 1), b = pack(fluid, cs, "fluid", 2);
  EXPECT_FALSE(check_protocol(a, sizeof a));
  EXPECT_FALSE(check_agreement(a, b));
  EXPECT_EQ(overlap_warning(a, b), "");
  cs.scheme = "box1";
  EXPECT_EQ(check_agreement(a, pack(fluid, cs, "fluid", 2))->code, exit_disagreement);
}

TEST(Wire, MinorVersionsThatARunNeeds) {
  CouplingCase cs;
  HelloBlock fluid = pack({.program = "old", .lower = {0, 0, 0}, .upper = {1, 1, 1}}, cs, "fluid", 1);
  const auto of_solid = [&] { return pack({.program = "csd"}, cs, "solid", 1); };
  fluid.minor = 0;
  EXPECT_FALSE(check_minor(of_solid(), fluid));
  cs.window = 1e-6;
  EXPECT_EQ(check_minor(of_solid(), fluid)->code, exit_version);
  EXPECT_EQ(check_minor(fluid, of_solid())->text, check_minor(of_solid(), fluid)->text);
  EXPECT_NE(check_minor(of_solid(), fluid)->text.find("needs protocol 1.1"), std::string::npos);
  cs.window = 0, cs.scheme = "concurrent";
  EXPECT_EQ(check_minor(of_solid(), fluid)->code, exit_version);
  fluid.minor = 1;
  EXPECT_FALSE(check_minor(of_solid(), fluid));
  fluid.minor_needed = protocol_minor + 1;
  EXPECT_EQ(check_minor(of_solid(), fluid)->code, exit_version);
}

TEST(Wire, PartlyOutsideWarnsApartFails) {
  const CouplingCase cs;
  Hello solid{.program = "csd", .lower = {0, 0, 0}, .upper = {1, 1, 3}};
  const Hello fluid{.program = "cfd", .lower = {-1, -1, -1}, .upper = {2, 2, 2}};
  const HelloBlock b = pack(fluid, cs, "fluid", 1);
  EXPECT_FALSE(check_agreement(pack(solid, cs, "solid", 1), b));
  EXPECT_NE(overlap_warning(pack(solid, cs, "solid", 1), b).find("outside"), std::string::npos);
  solid.lower.z = 2.5;
  EXPECT_EQ(check_agreement(pack(solid, cs, "solid", 1), b)->code, exit_apart);
  EXPECT_EQ(check_agreement(b, pack(solid, cs, "solid", 1))->code, exit_apart);
  solid.lower.z = 1e300, solid.upper.z = -1e300, solid.lower.x = 2, solid.upper.x = 1;  // nothing wet
  EXPECT_FALSE(check_agreement(pack(solid, cs, "solid", 1), b));
}

TEST(Wire, StepMustFollowTheOneBefore) {
  const WetSurface s = square();
  const Window w{.index = 5, .t0 = 1, .t1_max = 2, .dt_stable = 0.1};
  StepBlock step = pack(w, s);
  step.hash = connectivity_hash(s);
  const Known known{.window = 4, .t = 1, .topo_version = 0, .hash = step.hash, .n_nodes = 4, .n_faces = 1};
  EXPECT_FALSE(check_step(step, known));
  Known other = known;
  other.window = 3;
  EXPECT_EQ(check_step(step, other)->code, exit_malformed);
  other = known;
  other.hash += 1;
  EXPECT_EQ(check_step(step, other)->code, exit_malformed);
  other = known;
  other.t = 0.9;
  EXPECT_EQ(check_step(step, other)->code, exit_bad_value);
  step.t1_max = 1;
  EXPECT_EQ(check_step(step, known)->code, exit_bad_value);
}

TEST(Wire, SurfaceFaultsAreNamed) {
  WetSurface s = square();
  EXPECT_FALSE(check_surface(s));
  s.quads[0] = {0, 1, 2, 2};  // a triangle
  EXPECT_FALSE(check_surface(s));
  s.quads[0][3] = 4;
  EXPECT_EQ(check_surface(s)->text, "SURFACE: face 0 names node 4 of 4");
  s = square();
  s.node_id[2] = 7;
  EXPECT_EQ(check_surface(s)->text, "SURFACE: node_id 7 occurs twice");
  s.node_id = {int64_t(1) << 60, 5, -(int64_t(1) << 62), 6};  // not dense
  EXPECT_FALSE(check_surface(s));
  s.node_id[3] = s.node_id[2];
  EXPECT_EQ(check_surface(s)->text, "SURFACE: node_id -4611686018427387904 occurs twice");
  s = square();
  s.x[1].z = std::numeric_limits<double>::infinity();
  EXPECT_EQ(check_surface(s)->text, "SURFACE: x of node 1 is (1, 0, inf)");
  s = square();
  s.body.clear();
  EXPECT_EQ(check_surface(s)->code, exit_malformed);
}

/// Of the text in PROTOCOL.md, word by word.
uint64_t told_hash(const WetSurface& s, size_t lanes) {
  const auto mix = [](uint64_t& h, uint64_t word) { h = (h ^ word) * 1099511628211ull; };
  std::vector<uint64_t> h(lanes, 14695981039346656037ull);
  const auto take = [&](const auto& array) {
    std::vector<uint64_t> words((array.size() * sizeof array[0] + 7) / 8);
    std::memcpy(words.data(), array.data(), array.size() * sizeof array[0]);
    for (size_t i = 0; i < words.size(); ++i) mix(h[i % lanes], words[i]);
  };
  take(s.quads), take(s.node_id), take(s.node_parent), take(s.face_id), take(s.body), take(s.flags);
  if (lanes == 1) return h[0];
  uint64_t all = 14695981039346656037ull;
  for (const uint64_t lane : h) mix(all, lane);
  return all;
}

TEST(Wire, HashIsAsTheProtocolSays) {
  WetSurface s = square();
  for (int64_t i = 0; i < 7; ++i) {
    s.quads.push_back({0, 1, 2, int32_t(i % 4)}), s.face_id.push_back(11 * i), s.body.push_back(int32_t(i));
    s.flags.push_back(1), s.node_id.push_back(20 + i), s.node_parent.push_back(-1);
    EXPECT_EQ(connectivity_hash(s, 1), told_hash(s, 1));
    EXPECT_EQ(connectivity_hash(s, 2), told_hash(s, 4));
  }
}

TEST(Wire, EveryArrayCountsInTheHash) {
  const uint64_t h = connectivity_hash(square());
  WetSurface s = square();
  s.x[0].x = 5;  // geometry does not
  EXPECT_EQ(connectivity_hash(s), h);
  for (int i = 0; i < 6; ++i) {
    s = square();
    if (i == 0) std::swap(s.quads[0][0], s.quads[0][1]);
    if (i == 1) s.node_id[0] = 1;
    if (i == 2) s.node_parent[0] = 1;
    if (i == 3) s.face_id[0] = 1;
    if (i == 4) s.body[0] = 1;
    if (i == 5) s.flags[0] = 1;
    EXPECT_NE(connectivity_hash(s), h) << i;
  }
}

TEST(Wire, LoadTotalsSurviveTheTrip) {
  Loads loads;
  loads.t1 = 1.5;
  loads.p = {1};
  loads.stop = true;
  loads.totals = {.impulse = {1, 2, 3},
                  .moment = {4, 5, 6},
                  .work = 7,
                  .swept = 8,
                  .mass = 9,
                  .energy = 10,
                  .momentum = {11, 12, 13},
                  .mass_covered = 14,
                  .mass_uncovered = 15,
                  .energy_covered = 16,
                  .energy_uncovered = 17,
                  .dry_faces = 18,
                  .dry_area = 19};
  const StepBlock asked = pack(Window{.index = 2, .t0 = 1, .t1_max = 2}, square());
  const LoadBlock b = pack(loads, asked);
  EXPECT_FALSE(check_load(b, asked));
  StepBlock fixed = asked;
  fixed.flags |= step_fixed;
  EXPECT_EQ(check_load(b, fixed).has_value(), b.t1 != asked.t1_max);
  fixed.t1_max = b.t1;
  EXPECT_FALSE(check_load(b, fixed));
  EXPECT_EQ(b.flags, uint32_t(load_stop));
  const FluidTotals t = totals_of(b);
  EXPECT_EQ(t.momentum, (Vec3{11, 12, 13}));
  EXPECT_EQ(t.moment, (Vec3{4, 5, 6}));
  EXPECT_EQ(t.dry_faces, 18);
  EXPECT_EQ(t.energy_uncovered, 17);
  loads.t1 = 1;
  EXPECT_EQ(check_load(pack(loads, asked), asked)->code, exit_bad_value);
  loads.t1 = std::nan("");
  EXPECT_EQ(check_load(pack(loads, asked), asked)->code, exit_bad_value);
}

TEST(Wire, LoadValues) {
  const WetSurface s = square();
  Loads loads;
  loads.p = {1};
  EXPECT_FALSE(check_values(loads, s));
  loads.p = {1, 2};
  EXPECT_EQ(check_values(loads, s)->code, exit_malformed);
  loads.p = {std::nan("")};
  EXPECT_EQ(check_values(loads, s)->text,
            "LOAD: P of face 0 is nan; its id is 3, it lies at (0.5, 0.5, 0) m with 1 m^2");
  loads.p = {1};
  loads.traction = {{0, std::nan(""), 0}};
  EXPECT_EQ(check_values(loads, s)->code, exit_bad_value);
  loads.traction.clear();
  loads.impedance = {-1};
  EXPECT_EQ(check_values(loads, s)->code, exit_bad_value);
}

}  // namespace
}  // namespace bw::coupling
