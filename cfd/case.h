// SPDX-License-Identifier: Apache-2.0
// The case file as cfd reads it: [fluid] and the tables common to both programs.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "cfd/amr/criteria.h"
#include "cfd/embed/body.h"
#include "cfd/medium.h"
#include "cfd/records_case.h"
#include "cfd/regions.h"
#include "cfd/source/afterburn.h"
#include "cfd/source/light.h"
#include "cfd/start/case.h"
#include "cfd/start/vortex.h"
#include "common/app/cli.h"
#include "coupling/case.h"

namespace bw::cfd {

/// A material's state in numbers; `place` is for errors found after reading.
struct StateCase {
  std::string material;
  double density = 0, pressure = 0;
  Vec3 velocity;
  bool unburnt = false;
  std::string place, place_density, place_pressure, place_velocity;
  template <class K>
  void describe(K& k) {
    k.required("material", material, "name of a [[fluid.material]]");
    k.optional("unburnt", unburnt, "explosive before detonation: its density is that of its JWL set");
    if (k.is_manual())
      k.optional("density", density, dim::density, "needed unless unburnt");
    else if (!unburnt)
      k.required("density", density, dim::density, "needed unless unburnt");
    k.expect(unburnt || density > 0, "density", "a positive density");
    k.required("pressure", pressure, dim::pressure, "absolute pressure");
    k.optional("velocity", velocity, dim::velocity, "velocity");
    place = k.where("material"), place_density = k.where(unburnt ? "material" : "density"), place_pressure = k.where("pressure");
    place_velocity = k.where("velocity");
  }
};

struct ShapeTable {
  RegionShape shape;
  template <class K>
  void describe(K& k) {
    k.pick("kind", shape, "geometry", true);
  }
};

struct RegionCase : StateCase {
  RegionShape shape;
  template <class K>
  void describe(K& k) {
    ShapeTable table{shape};
    k.table("shape", table, "where; later regions paint over earlier ones");
    shape = table.shape;
    StateCase::describe(k);
  }
};

struct FineRegionCase : FineRegion {
  template <class K>
  void describe(K& k) {
    ShapeTable table{shape};
    k.table("shape", table, "where; blocks that it touches are of this level at least");
    shape = table.shape;
    k.required("level", level, "from 1 to levels");
    k.expect(!std::holds_alternative<CavityRegion>(shape), "shape", "any shape but a cavity");
  }
};

struct AmrCase {
  int levels = 1, block = 0;
  RefineRules rules;
  template <class K>
  void describe(K& k) {
    k.required("levels", levels, "how often cells may be halved; [fluid] cells counts those of level 0");
    k.optional("block", block, "cells per block and used direction, even, at least 8; 0: chosen, from 8 to 16");
    k.optional("every", rules.every, "steps between two looks at the grid");
    k.optional("follow_flow", rules.follow_flow, "refine where density or pressure jumps or bends (Lohner's indicator)");
    k.optional("refine", rules.refine, dim::none, "indicator, from 0 to 1, above which a cell asks for the next level");
    k.optional("coarsen", rules.coarsen, dim::none, "indicator below which no cell needs the level it is on");
    k.optional("buffer", rules.buffer, "cells around such a cell that are refined with it");
    k.optional("wall_cells", rules.wall_cells, "of the finest level around every wall that are of the finest level");
    std::vector<FineRegionCase> regions;
    k.tables("region", regions, "where the grid is fine from the start to the end");
    rules.region.assign(regions.begin(), regions.end());
    k.expect(levels >= 1 && levels <= 5, "levels", "a number from 1 to 5");
    k.expect(block == 0 || (block >= 8 && block % 2 == 0), "block", "0 or an even number of at least 8 cells");
    k.expect(rules.every >= 1, "every", "a positive number");
    k.expect(rules.refine > 0 && rules.refine <= 1, "refine", "a number in (0, 1]");
    k.expect(rules.coarsen >= 0 && rules.coarsen < rules.refine, "coarsen", "a number from 0 to below refine");
    k.expect(rules.buffer >= 1, "buffer", "a positive number");
    // walls move up to half a cell a step
    k.expect(2 * rules.wall_cells >= 10 + rules.every, "wall_cells", "at least 5 + every/2 cells");
    for (const FineRegion& r : rules.region) k.expect(r.level >= 1 && r.level <= levels, "region", "level from 1 to levels");
  }
};

struct InflowCase : StateCase {
  std::string side;
  template <class K>
  void describe(K& k) {
    k.choice("side", side, {"x_lower", "x_upper", "y_lower", "y_upper", "z_lower", "z_upper"},
             "the side of the domain, declared inflow, subsonic_inflow or far_field in boundary");
    StateCase::describe(k);
  }
};

struct MaterialCase {
  std::string name, library, place;
  std::optional<EosChoice> eos;
  template <class K>
  void describe(K& k) {
    k.required("name", name, "what regions call it");
    k.optional("library", library, "one of the materials known by name, e.g. \"TNT\", \"air\"; see the README");
    std::optional<EosTable> table;
    k.table("eos", table, "equation of state, unless library is given");
    if (table) eos = table->eos;
    place = k.where("name");
    if (!k.is_manual()) resolve(k);
  }

 private:
  struct EosTable {
    EosChoice eos;
    template <class K>
    void describe(K& k) {
      k.pick("kind", eos, "kind of equation of state", true);
    }
  };
  void resolve(Keys& k);
};

struct BurnLineCase : LineLight {
  template <class K>
  void describe(K& k) {
    k.required("from", from, dim::length, "one end");
    k.required("to", to, dim::length, "the other end");
    k.expect(norm(to - from) > 0, "to", "a point apart from `from`");
  }
};

struct BurnPlaneCase : DiscLight {
  template <class K>
  void describe(K& k) {
    k.required("point", centre, dim::length, "its centre, or a point of it");
    k.required("normal", normal, dim::none, "direction across it");
    k.optional("radius", radius, dim::length, "of a disc around `point`; absent: a whole plane");
    k.expect(norm(normal) > 0, "normal", "a direction");
    k.expect(radius > 0, "radius", "a positive length");
    if (norm(normal) > 0) normal = unit(normal);
  }
};

struct BurnCase {
  std::string material, place, path = "auto";
  std::vector<Vec3> points;
  std::vector<BurnLineCase> line;
  std::vector<BurnPlaneCase> plane;
  double start = 0, width = 3;
  template <class K>
  void describe(K& k) {
    k.required("material", material, "the explosive: a material with a JWL equation of state");
    k.optional("points", points, dim::length, "detonation points, inside the explosive");
    k.tables("line", line, "lines that detonate all along at once");
    k.tables("plane", plane, "planes or discs that detonate all over at once");
    k.choice("path", path, {"auto", "straight"},
             "auto: around corners, on the shortest way through the explosive, where straight lines leave it; straight: never");
    k.optional("start", start, dim::time, "time of detonation");
    k.optional("width", width, dim::none, "of the front, in cells");
    k.expect(!points.empty() || !line.empty() || !plane.empty(), "points", "at least one point, line or plane");
    k.expect(start >= 0, "start", "a time, zero or positive");
    k.expect(width >= 1, "width", "at least one cell");
    place = k.where(points.empty() ? "material" : "points");
  }
};

struct AfterburnCase : Afterburn {
  std::string material, place;
  bool own_begin = false;  ///< else it begins when the programmed burn is over
  template <class K>
  void describe(K& k) {
    std::string name = "constant";
    k.required("material", material, "the explosive: a material with a JWL equation of state");
    k.choice("kind", name, {"constant", "miller"},
             "constant: at one rate from begin to end; miller: rate (1 - burnt)^rest_exponent (p/1 Mbar)^pressure_exponent, p the mean over the products");
    kind = name == "miller" ? Kind::miller : Kind::constant;
    k.optional("energy", energy, dim::energy_per_mass,
               "per mass of explosive, on top of its E0; 0: heat of combustion less E0/rho0, for library explosives of one substance (TNT, PETN)");
    constexpr double never = -1e300;
    begin = never;
    k.optional("begin", begin, dim::time, "absent: when the programmed burn is over");
    own_begin = begin != never;
    if (!own_begin) begin = 0;
    k.optional("end", end, dim::time, "of the constant rate");
    k.optional("rate", rate, dim::frequency, "miller: of the burnt part at 1 Mbar and none burnt");
    k.optional("rest_exponent", m, dim::none, "miller");
    k.optional("pressure_exponent", n, dim::none, "miller");
    k.optional("least_pressure", least_pressure, dim::pressure, "miller: below it nothing burns");
    k.optional("burnt", share, dim::none, "part burnt at the start, of a run that begins from another's end");
    k.expect(energy >= 0, "energy", "a positive energy per mass, or 0");
    k.expect(begin >= 0, "begin", "a time, zero or positive");
    k.expect(k.is_manual() || kind != Kind::constant || end > begin, "end", "a time after begin");
    k.expect(k.is_manual() || kind != Kind::miller || rate > 0, "rate", "a positive rate");
    k.expect(m >= 0, "rest_exponent", "a number, zero or positive");
    k.expect(n >= 0, "pressure_exponent", "a number, zero or positive");
    k.expect(share >= 0 && share <= 1, "burnt", "a number from 0 to 1");
    place = k.where("material");
  }
};

struct LineCase {
  std::string name, place;
  Vec3 from, to;
  template <class K>
  void describe(K& k) {
    k.required("name", name, "names its file, fluid_line_<name>.csv");
    k.required("from", from, dim::length, "one end");
    k.required("to", to, dim::length, "the other end; a row for each cell that the line passes through");
    k.expect(norm(to - from) > 0, "to", "a point apart from the other end");
    place = k.where("name");
  }
};

/// Field files may be restricted to the blocks that touch a box: slices of large grids.
struct FieldsCase {
  Vec3 lower{-1e300, -1e300, -1e300}, upper{1e300, 1e300, 1e300};
  std::string place;
  template <class K>
  void describe(K& k) {
    k.required("lower", lower, dim::length, "lower corner of the box");
    k.required("upper", upper, dim::length, "upper corner of the box; blocks of cells that it touches are written");
    place = k.where("lower");
  }
};

struct SchemeCase {
  double cfl = 0.9;
  bool skip_quiet = true;
  Floors floors;
  std::string interface = "smooth", place;
  double sharpness = 1.6;
  template <class K>
  void describe(K& k) {
    k.choice("interface", interface, {"smooth", "sharp"},
             "between two materials: smooth: limited lines, as everything else; sharp: THINC, two to three cells wide");
    k.optional("sharpness", sharpness, dim::none, "of sharp interfaces, from 1 (wider) to 3");
    k.expect(sharpness >= 1 && sharpness <= 3, "sharpness", "a number from 1 to 3");
    place = k.where("interface");
    k.optional("cfl", cfl, dim::none, "of sum_d (|v_d| + c) dt/h_d, at most 0.9");
    k.optional("skip_quiet", skip_quiet, "leave out blocks in which nothing can happen; the results are the same bits");
    k.optional("density_floor", floors.rho, dim::density, "a lower density is a failed step");
    k.optional("pressure_floor", floors.p, dim::pressure, "a lower pressure is lifted, and counted");
    k.expect(cfl > 0 && cfl <= 0.9, "cfl", "a number in (0, 0.9]");
    k.expect(floors.rho > 0, "density_floor", "a positive density");
    k.expect(floors.p > 0, "pressure_floor", "a positive pressure");
  }
};

struct WallsCase {
  std::string treatment = "half_riemann", slits = "centre", loads = "pressure", place;
  template <class K>
  void describe(K& k) {
    k.choice("treatment", treatment, {"half_riemann", "first_order", "mirror", "cut_cell"},
             "of cut links. half_riemann: half a Riemann problem at the wall where it is, at the end of a line through the cells, second order; first_order: the mirror "
             "image of the cell, as if the wall were at the cell face; mirror: images of points before the wall on reconstructed gradients, the pressure with "
             "dp/dn = -rho a_n, second order. Cells that walls uncover are filled alike. cut_cell: open volumes and cell faces as they are, mass, momentum and energy conserved, "
             "closed bodies thicker than two cells, one gas");
    place = k.where("treatment");
    k.choice("slits", slits, {"centre", "area", "sealed"},
             "openings narrower than a cell, between walls thinner than one, and edges of such walls. centre: the line between two cell centres decides, all or "
             "nothing; area: gas flows through the open part of a cell face; sealed: nothing passes a cell face of which any part is blocked");
    k.choice("loads", loads, {"pressure", "conservative"},
             "of the walls' faces. pressure: the pressure at each face, from its own side, second order; conservative: the momentum that the flow gave through the cut "
             "links across each face, to round-off, as pressure and a traction beyond it: exact in the sum, noisy from face to face");
  }
};

struct BoundaryCase {
  std::array<std::string, 6> side{"wall", "wall", "wall", "wall", "wall", "wall"};
  template <class K>
  void describe(K& k) {
    static constexpr const char* names[6] = {"x_lower", "x_upper", "y_lower", "y_upper", "z_lower", "z_upper"};
    for (size_t i = 0; i < 6; ++i)
      k.choice(names[i], side[i], {"wall", "symmetry", "outflow", "far_field", "periodic", "inflow", "subsonic_inflow"},
               "rigid smooth wall; plane of symmetry (the same); outflow: the last cell once more; far_field: waves leave without reflection, what "
               "enters is at a given state; periodic (both sides); inflow: a given state (supersonic); subsonic_inflow: given density and velocity. "
               "States: [[fluid.inflow]]");
    for (size_t d = 0; d < 3; ++d)
      k.expect((side[2 * d] == "periodic") == (side[2 * d + 1] == "periodic"), names[2 * d + 1],
               "\"periodic\" on both sides of a direction or on none");
  }
};

struct FluidCase {
  int threads = 0;
  GridSize grid;
  std::optional<AmrCase> amr;
  BoundaryCase boundary;
  SchemeCase scheme;
  WallsCase walls;
  std::vector<MaterialCase> material;
  std::vector<RegionCase> region;
  std::optional<StartCase> start_from;
  std::vector<VortexCase> vortex;
  std::vector<InflowCase> inflow;
  std::vector<BurnCase> burn;
  std::optional<AfterburnCase> afterburn;
  std::vector<BodyCase> body;
  std::vector<GaugeCase> gauge;
  std::vector<LineCase> line;
  std::vector<PlaneCase> plane;
  std::optional<MapCase> map;
  double arrival_overpressure = 0;
  double perturbation = 0;
  std::optional<FieldsCase> fields;

  void describe(Keys& k);
  /// From 0, the material called `name`; InputError at `place` otherwise.
  int material_index(const std::string& name, const std::string& place) const;

 private:
  void use_radius(Keys& k, Geometry geometry);
  void check_radial(Keys& k) const;
  void check_inflow() const;
  void use_levels(Keys& k);
  void check_afterburn() const;
  void check_cut_cells() const;
  void check(Keys& k) const;
};

struct Case {
  std::string file;
  std::string restart;  ///< a checkpoint or a folder that holds some; empty: from the start
  RunControl run;
  FluidCase fluid;
  coupling::CouplingCase coupling;
  bool has_solid = false;  ///< the file has a table [solid]
};

/// Reads and checks what can be checked without a grid. InputError names file, line and key.
Case read_case(const CommandLine& line);
/// Every key, default and meaning.
std::string case_manual();

}  // namespace bw::cfd
