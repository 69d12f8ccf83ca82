// SPDX-License-Identifier: Apache-2.0
// Wire format, version 1: tags, fixed blocks and their checks. PROTOCOL.md is the same in words; the sizes and offsets
// asserted in tests/unit/coupling keep the two together.
#pragma once
#include <bit>
#include <cstdint>
#include <optional>
#include <string>

#include "coupling/case.h"
#include "coupling/loads.h"

namespace bw::coupling {

static_assert(std::endian::native == std::endian::little, "the wire is little-endian");

constexpr uint32_t protocol_major = 1, protocol_minor = 2;
constexpr uint32_t minor_of_fixed_windows = 1, minor_of_minor_needed = 2, minor_of_lanes = 2;
constexpr char protocol_magic[9] = "BWCOUPL\n";
constexpr uint32_t protocol_endian = 0x01020304;

enum Tag : int {
  tag_hello = 100,
  tag_step = 110,
  tag_x = 120,      // f64[n_nodes][3]
  tag_v = 121,      // f64[n_nodes][3]
  tag_quads = 122,  // i32[n_faces][4]
  tag_ids = 123,    // i64 node_id[n_nodes], node_parent[n_nodes], face_id[n_faces]
  tag_faces = 124,  // i32 body[n_faces], flags[n_faces]
  tag_load = 130,
  tag_p = 131,          // f64[n_faces]
  tag_traction = 132,   // f64[n_faces][3]
  tag_impedance = 133,  // f64[n_faces]
  tag_kept = 141,
  tag_bye = 180,
  tag_fail = 190,
  tag_ack = 191,
};

struct HelloBlock {
  char magic[8];
  uint32_t endian, major, minor, bytes;
  char role[16], program[32], version[32], units[32];
  double p_ref, t0, t_end;
  uint64_t features;
  int32_t scheme, ranks;
  double lower[3], upper[3];
  int64_t restart_id, restart_window;
  uint64_t restart_hash;
  double silence_limit;
  uint32_t minor_needed;  // that the other one must speak
  char reserved[36];
};
static_assert(sizeof(HelloBlock) == 296);

struct StepBlock {
  int64_t window, topo_version, n_nodes, n_faces;
  double t0, t1_max, dt_stable;
  uint32_t flags, reserved0;
  uint64_t hash;
  int64_t born, dead;
  double impulse[3], moment[3], work, volume_gap;  // the solid's books of the window before
  char reserved[40];
};
static_assert(sizeof(StepBlock) == 192);
enum StepFlag : uint32_t {
  step_connectivity = 1,
  step_last = 2,
  step_checkpoint = 4,
  step_mean_pressure = 8,
  step_fixed = 16
};

struct LoadBlock {
  int64_t window, topo_version, n_faces;
  double t1;
  uint32_t flags, reserved0;
  double impulse[3], moment[3], work, swept;  // the fluid's books of this window
  double mass, energy, momentum[3];
  double mass_covered, mass_uncovered, energy_covered, energy_uncovered;
  int64_t dry_faces;
  double dry_area;
  double dt_next;
  char reserved[56];
};
static_assert(sizeof(LoadBlock) == 256);
enum LoadFlag : uint32_t { load_traction = 1, load_impedance = 2, load_stop = 4, load_checkpoint = 8 };

struct KeptBlock {
  int64_t window;  // the fluid's state at its start is on the disk
  char file[248];  // in the output folder
};
static_assert(sizeof(KeptBlock) == 256);

struct ByeBlock {
  int32_t code, reserved0;  // code 0: finished as agreed
  char text[248];
};
static_assert(sizeof(ByeBlock) == 256);

struct FailBlock {
  int32_t code, rank;
  int64_t window;
  double t;
  char text[488];
};
static_assert(sizeof(FailBlock) == 512);

/// What one side says of itself in HELLO.
struct Hello {
  std::string program = {}, version = {};  ///< for people
  std::string units = "SI";                ///< native units of the program, for the log only; the wire is SI
  double t0 = 0, t_end = 0;                ///< s; t_end <= 0: no opinion
  Vec3 lower = {}, upper = {};  ///< m; solid: box of the wet surface (lower > upper: none yet), fluid: its domain
  uint64_t features = 0;        ///< bits of Feature
  int64_t first_window = 0;     ///< where a checkpoint of the pair goes on
  uint64_t restart_hash = 0;    ///< CommitMark::hash(); 0: a fresh start
};
enum Feature : uint64_t { feature_traction = 1, feature_impedance = 2, feature_checkpoint = 4 };

/// Something that must end the run: a CouplingExit and the reason.
struct Fault {
  int code;
  std::string text;
};
using Verdict = std::optional<Fault>;

HelloBlock pack(const Hello& hello, const CouplingCase& cs, const char* role, int ranks);
/// First of all: is this our protocol, in our version? `bytes` is what arrived.
Verdict check_protocol(const HelloBlock& other, size_t bytes);
/// Does each speak the minor version that the other one needs in this run? Before check_agreement: an old program may
/// not know what it contradicts.
Verdict check_minor(const HelloBlock& mine, const HelloBlock& other);
/// Do the two cases agree? And do surface and domain meet? Either may be the solid's.
Verdict check_agreement(const HelloBlock& mine, const HelloBlock& other);
/// Warning text when the surface lies partly outside the domain; empty when all is well.
std::string overlap_warning(const HelloBlock& solid, const HelloBlock& fluid);

StepBlock pack(const Window& window, const WetSurface& surface);
/// What the fluid knows before a STEP.
struct Known {
  int64_t window = -1;        ///< last one
  double t = 0;               ///< s, end of that window
  int64_t topo_version = -1;  ///< of the connectivity in hand
  uint64_t hash = 0;
  int64_t n_nodes = 0, n_faces = 0;
};
Verdict check_step(const StepBlock& step, const Known& known);
/// Indices within range, ids distinct, finite numbers: names array and entry.
Verdict check_surface(const WetSurface& surface);
/// The part of it that changes with the topology only.
Verdict check_connectivity(const WetSurface& surface);
/// The part of it that changes in every window: x and v, finite.
Verdict check_motion(const WetSurface& surface);
/// minor: that both programs speak.
uint64_t connectivity_hash(const WetSurface& surface, uint32_t minor = protocol_minor);

LoadBlock pack(const Loads& loads, const StepBlock& asked);
FluidTotals totals_of(const LoadBlock& load);
Verdict check_load(const LoadBlock& load, const StepBlock& asked);
/// Lengths and finite numbers; the text names the face, its id, place and area.
Verdict check_values(const Loads& loads, const WetSurface& surface);

}  // namespace bw::coupling
