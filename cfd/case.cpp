// SPDX-License-Identifier: Apache-2.0
#include "cfd/case.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "cfd/eos/library.h"
#include "common/app/log.h"

namespace bw::cfd {
namespace {

struct Root {
  RunControl& run;
  FluidCase& fluid;
  coupling::CouplingCase& coupling;
  void describe(Keys& k) {
    run.describe(k);
    k.table("fluid", fluid, "the fluid program, cfd");
    std::optional<coupling::CouplingCase> table;
    k.table("coupling", table, "how the two programs work together");
    if (table) coupling = *table;
  }
};

}  // namespace

void MaterialCase::resolve(Keys& k) {
  if (eos && !library.empty()) k.fail("library", "either library or eos, not both");
  if (!library.empty()) {
    eos = from_library(library);
    if (!eos) k.fail("library", fmt::format("one of {}, not \"{}\"", fmt::join(library_names(), ", "), library));
  }
  if (!eos) k.fail("eos", "an equation of state: eos = {kind = ...} or library = \"...\"");
}

void FluidCase::describe(Keys& k) {
  std::vector<int> cells(grid.cells.begin(), grid.cells.end());
  k.optional("threads", threads, "threads of the fluid program; 0: what OMP_NUM_THREADS or the machine gives");
  k.expect(threads >= 0, "threads", "a number of threads, or 0");
  std::string geometry = "planar";
  k.choice("geometry", geometry, {"planar", "cylindrical", "spherical"},
           "planar: a box; cylindrical, spherical: a 1-D run along the radius, which is x, of a cylinder of 1 m length or a whole sphere");
  const bool planar = geometry == "planar";
  if (planar || k.is_manual()) {
    k.required("lower", grid.lower, dim::length, "lower corner of the domain (planar)");
    k.required("upper", grid.upper, dim::length, "upper corner of the domain (planar)");
  }
  if (!planar || k.is_manual()) use_radius(k, geometry == "spherical" ? Geometry::spherical : Geometry::cylindrical);
  k.required("cells", cells, "cells in x, y, z; 1 leaves a direction out: 1-D and 2-D runs; along a radius [cells, 1, 1]");
  k.expect(cells.size() == 3, "cells", "three numbers of cells");
  for (size_t d = 0; d < 3 && d < cells.size(); ++d) {
    k.expect(cells[d] > 0, "cells", "positive numbers");
    k.expect(cells[d] != 2 && cells[d] != 3, "cells", "1 or at least 4 cells in a direction");
    k.expect(grid.upper[int(d)] > grid.lower[int(d)], "upper", "a point above lower in x, y and z");
    grid.cells[d] = cells[d];
    k.expect(planar || d == 0 || cells[d] == 1, "cells", "[cells, 1, 1] along a radius");
  }
  k.expect(planar || cells[0] > 1, "cells", "at least 4 cells along the radius");
  k.table("amr", amr, "blocks of cells that are halved where the flow or a wall needs it");
  if (amr) use_levels(k);
  k.table("boundary", boundary, "the six sides of the domain");
  for (size_t d = 0; d < 3; ++d) grid.periodic[d] = boundary.side[2 * d] == "periodic";
  k.table("scheme", scheme, "the flow solver");
  k.table("walls", walls, "how the surfaces of bodies act on the flow");
  k.tables("material", material, "from one to six materials; a cell may hold any of them together");
  k.tables("region", region, "the state at t = 0");
  k.table("start_from", start_from, "over the regions, what a run along a radius ended with");
  k.tables("vortex", vortex, "isentropic vortices in the gas of the regions");
  if (!planar && !vortex.empty()) k.fail("vortex", "no vortices along a radius");
  k.optional("perturbation", perturbation, dim::none,
             "the density of each cell is changed at the start by up to this part of it, at random, the same on any number of ranks: to see instabilities");
  k.expect(perturbation >= 0 && perturbation < 0.5, "perturbation", "a number from 0 to below 0.5");
  k.tables("inflow", inflow, "states of sides declared inflow, subsonic_inflow or far_field");
  k.tables("burn", burn, "programmed burn of an explosive");
  k.table("afterburn", afterburn, "products that burn on: further energy, released at the same pace in all of them");
  k.tables("body", body, "bodies with prescribed motion, or moved by the flow (fluid_body_<name>.csv), when cfd runs alone");
  k.tables("gauge", gauge, "pressure histories at points: fluid_gauges.csv; what they measured: fluid_gauges.json");
  k.tables("plane", plane, "slices through time, and maps of peak overpressure and impulse on them");
  k.table("map", map, "peak overpressure, impulse, arrival and duration in the whole domain: map_*.vtkhdf at the end");
  k.optional("arrival_overpressure", arrival_overpressure, dim::pressure,
             "of gauges, planes and the map: a wave has arrived when it passes this; 0: 1 % of the pressure there at the start");
  k.expect(arrival_overpressure >= 0, "arrival_overpressure", "a positive pressure, or 0");
  k.tables("line", line, "profiles along lines, at the times of the field files and at the end");
  k.table("fields", fields, "restricts field files to a part of the domain; absent: all of it");
  if (!k.is_manual()) check(k);
  // the flow kernels carry stored energy with material 1
  const std::string explosive = !burn.empty() ? burn[0].material : afterburn ? afterburn->material : "";
  for (size_t m = 1; m < material.size(); ++m)
    if (material[m].name == explosive) std::swap(material[0], material[m]);
}

void FluidCase::use_radius(Keys& k, Geometry geometry) {
  double inner = 0, outer = 0;
  k.required("radius", outer, dim::length, "outer radius of the domain (cylindrical, spherical)");
  k.optional("inner_radius", inner, dim::length, "inner radius, where x_lower is; 0: the centre, a wall (cylindrical, spherical)");
  k.expect(inner >= 0, "inner_radius", "a length, zero or positive");
  k.expect(outer > inner, "radius", "a length above inner_radius");
  if (k.is_manual()) return;
  grid.geometry = geometry;
  grid.lower = {inner, -0.5, -0.5}, grid.upper = {outer, 0.5, 0.5};
}

void FluidCase::check_radial(Keys& k) const {
  const bool at_centre = grid.lower.x == 0;
  if (boundary.side[0] == "periodic" || (at_centre && boundary.side[0] != "wall"))
    k.fail("boundary", at_centre ? "x_lower = \"wall\", the centre" : "any side but periodic along a radius");
  for (size_t s = 2; s < 6; ++s)
    if (boundary.side[s] != "wall") k.fail("boundary", "x_lower and x_upper alone along a radius");
  if (!body.empty()) k.fail("body", "no bodies along a radius");
  if (amr) k.fail("amr", "no levels along a radius: its cells are cheap");
  for (const auto& r : region)
    if (r.velocity.y != 0 || r.velocity.z != 0) throw InputError(fmt::format("{}: expected a velocity along x, the radius", r.place));
}

void FluidCase::use_levels(Keys& k) {
  grid.levels = amr->levels;
  const std::array<int, 3> n = choose_block(grid.cells, amr->levels);
  const int multiple = std::max(2, 1 << amr->levels);
  for (size_t d = 0; d < 3; ++d) {
    grid.block[d] = grid.cells[d] == 1 ? 1 : amr->block > 0 ? amr->block : n[d];
    if (k.is_manual() || grid.cells[d] == 1) continue;
    if (grid.block[d] == 0)
      k.fail("cells", fmt::format("cells that blocks of 8 to 16 cells, a multiple of {}, divide, for {} levels in [fluid.amr]: {} are not", multiple,
                                  amr->levels, grid.cells[d]));
    if (grid.cells[d] % grid.block[d] != 0 || grid.block[d] % multiple != 0)
      k.fail("amr", fmt::format("a block that divides the cells, here {}, and is a multiple of {}", grid.cells[d], multiple));
  }
}

int FluidCase::material_index(const std::string& name, const std::string& place) const {
  for (size_t m = 0; m < material.size(); ++m)
    if (material[m].name == name) return int(m);
  std::vector<std::string> names;
  for (const auto& m : material) names.push_back(m.name);
  throw InputError(fmt::format("{}: expected the name of a [[fluid.material]] ({}), not \"{}\"", place,
                               fmt::join(names, ", "), name));
}

void FluidCase::check_afterburn() const {
  const MaterialCase& m = material[size_t(material_index(afterburn->material, afterburn->place))];
  if (!std::holds_alternative<Jwl>(*m.eos))
    throw InputError(fmt::format("{}: expected an explosive (a JWL equation of state), \"{}\" is none", afterburn->place, m.name));
  if (!burn.empty() && burn[0].material != m.name)
    throw InputError(fmt::format("{}: expected \"{}\", the material of [[fluid.burn]]", afterburn->place, burn[0].material));
  if (afterburn->energy == 0 && !heat_of_combustion(m.library))
    throw InputError(fmt::format("{}: expected fluid.afterburn.energy: the heat of combustion of \"{}\" is not in the library", afterburn->place, m.name));
}

void FluidCase::check_inflow() const {
  static constexpr const char* names[6] = {"x_lower", "x_upper", "y_lower", "y_upper", "z_lower", "z_upper"};
  for (const InflowCase& i : inflow) {
    const size_t side = size_t(std::find(std::begin(names), std::end(names), i.side) - std::begin(names));
    const std::string& kind = boundary.side[side];
    const double in = (side % 2 ? -1 : 1) * i.velocity[int(side / 2)];
    if (kind == "far_field") continue;
    if (in < 0) throw InputError(fmt::format("{}: expected a velocity into the domain at {}, whose boundary is \"{}\"", i.place_velocity, i.side, kind));
    if (kind != "inflow" || i.unburnt) continue;
    const double c = std::visit([&](const auto& e) { return sound_speed(e, i.density, i.pressure); }, *material[size_t(material_index(i.material, i.place))].eos);
    if (in < c)
      warn("{}: {:g} m/s into the domain is slower than sound there, {:g} m/s: waves that come back are not let out by boundary = \"inflow\", which is for "
           "supersonic flow; subsonic_inflow and far_field let them out", i.place_velocity, in, c);
  }
}

void FluidCase::check_cut_cells() const {
  const auto fail = [&](const std::string& expected) {
    throw InputError(fmt::format("{}: expected {} beside treatment = \"cut_cell\"", walls.place, expected));
  };
  const auto is_gas = [](const auto& e) { return e.constant_reference && e.covolume() == 0; };
  if (material.size() != 1 || !std::visit(is_gas, *material[0].eos)) fail("one [[fluid.material]], an ideal or stiffened gas,");
  if (walls.slits != "centre") fail("slits = \"centre\", cell faces being as open as they are,");
  for (const BodyCase& b : body)
    if (b.thin || std::holds_alternative<PlaneShape>(b.shape) || std::holds_alternative<PistonShape>(b.shape))
      fail(fmt::format("a closed body (a box in place of a piston or plane) in place of \"{}\"", b.name));
}

void FluidCase::check(Keys& k) const {
  if (material.empty() || material.size() > size_t(most_materials))
    k.fail("material", fmt::format("one to {} [[fluid.material]] tables, not {}", most_materials, material.size()));
  std::set<std::string> material_names;
  for (const MaterialCase& m : material)
    if (!material_names.insert(m.name).second)
      throw InputError(fmt::format("{}: expected a name of its own, there are two \"{}\"", m.place, m.name));
  if (region.empty()) k.fail("region", "at least one [[fluid.region]]: the state at t = 0");
  const auto check_state = [&](const StateCase& s) {
    const int m = material_index(s.material, s.place);
    const auto& eos = *material[size_t(m)].eos;
    if (s.unburnt && !std::holds_alternative<Jwl>(eos))
      throw InputError(fmt::format("{}: expected a material with a JWL equation of state", s.place));
    const double covolume = std::visit([](const auto& e) { return e.covolume(); }, eos);
    if (!(s.density * covolume < 1))
      throw InputError(fmt::format("{}: expected a density below 1/covolume, {:g} kg/m^3, got {:g}", s.place_density, 1 / covolume, s.density));
    const double least = std::holds_alternative<StiffenedGas>(eos) ? -std::get<StiffenedGas>(eos).p_inf : 0;
    if (!(s.pressure > least))
      throw InputError(fmt::format("{}: expected a pressure above {:g} Pa, got {:g}", s.place_pressure, least, s.pressure));
  };
  for (const auto& r : region) check_state(r);
  for (const auto& i : inflow) check_state(i);
  static constexpr const char* names[6] = {"x_lower", "x_upper", "y_lower", "y_upper", "z_lower", "z_upper"};
  for (size_t s = 0; s < 6; ++s) {
    const auto states = std::count_if(inflow.begin(), inflow.end(), [&](const auto& i) { return i.side == names[s]; });
    const std::string& kind = boundary.side[s];
    if ((kind == "inflow" || kind == "subsonic_inflow" || kind == "far_field") != (states == 1))
      k.fail("boundary", fmt::format("one [[fluid.inflow]] for each side that is inflow, subsonic_inflow or far_field, and for no other: see {}", names[s]));
  }
  check_inflow();
  if (burn.size() > 1) k.fail("burn", "at most one [[fluid.burn]]; it may have several points");
  for (const auto& b : burn) {
    const int m = material_index(b.material, b.place);
    if (!std::holds_alternative<Jwl>(*material[size_t(m)].eos))
      throw InputError(fmt::format("{}: expected an explosive (a JWL equation of state), \"{}\" is none", b.place, b.material));
    if (std::none_of(region.begin(), region.end(), [&](const auto& r) { return r.material == b.material && r.unburnt; }))
      throw InputError(fmt::format("{}: there is no explosive: expected a [[fluid.region]] of \"{}\" with unburnt = true", b.place, b.material));
  }
  if (afterburn) check_afterburn();
  if (walls.treatment == "cut_cell") check_cut_cells();
  if (scheme.interface == "sharp" && !body.empty())
    throw InputError(fmt::format("{}: expected \"smooth\" beside bodies: their walls reconstruct by lines", scheme.place));
  if (scheme.interface == "sharp" && material.size() != 2)
    throw InputError(fmt::format("{}: expected \"smooth\" with {}", scheme.place,
                                 material.size() == 1 ? "one material: it has no interface"
                                                      : "more than two materials: sharp interfaces are of two"));
  if (scheme.interface == "sharp" && std::all_of(material.begin(), material.end(), [](const auto& m) { return std::holds_alternative<Jwl>(*m.eos); }))
    throw InputError(fmt::format("{}: expected \"smooth\": sharp interfaces need a gas or a stiffened gas on one side", scheme.place));
  if (grid.geometry != Geometry::planar) check_radial(k);
  if (start_from && !burn.empty()) k.fail("start_from", "no [[fluid.burn]] beside start_from: the profile is burnt, and nothing else burns yet");
  if (start_from && grid.geometry != Geometry::planar && norm(start_from->centre) > 0)
    throw InputError(fmt::format("{}: expected no centre along a radius: both are the same", start_from->place));
  const auto inside = [&](const Vec3& x) {
    for (int d = 0; d < 3; ++d)
      if (x[d] < grid.lower[d] || x[d] > grid.upper[d]) return false;
    return true;
  };
  for (const auto& g : gauge)
    if (!inside(g.position)) throw InputError(fmt::format("{}: expected a point inside the domain", g.place));
  const auto named_apart = [](const auto& list) {
    std::set<std::string> names;
    for (const auto& item : list)
      if (!names.insert(item.name).second) throw InputError(fmt::format("{}: expected a name of its own, there are two \"{}\"", item.place, item.name));
  };
  named_apart(gauge), named_apart(plane), named_apart(line);
  std::set<std::string> moved;
  for (const auto& b : body)
    if (const auto* free = std::get_if<FreeMotion>(&b.motion); free && (!moved.insert(b.name).second || b.name.find('/') != std::string::npos))
      throw InputError(fmt::format("{}: expected a body with a name of its own without /, not \"{}\": it names its file", free->place, b.name));
  for (const auto& l : line)
    if (!inside(l.from) || !inside(l.to)) throw InputError(fmt::format("{}: expected a line inside the domain", l.place));
  for (int d = 0; fields && d < 3; ++d)
    if (!(fields->lower[d] <= fields->upper[d] && fields->lower[d] <= grid.upper[d] && fields->upper[d] >= grid.lower[d]))
      throw InputError(fmt::format("{}: expected a box of which a part is inside the domain, lower below upper", fields->place));
}

Case read_case(const CommandLine& line) {
  Case cs;
  cs.file = line.case_file;
  Keys k = Keys::read_file(line.case_file);
  cs.has_solid = k.has("solid");
  Root{cs.run, cs.fluid, cs.coupling}.describe(k);
  k.finish({"solid"});
  line.apply(cs.run);
  cs.restart = line.restart;
  if (!line.replay.empty()) cs.coupling.replay = line.replay, cs.coupling.replay_place.clear();
  if (line.threads > 0) cs.fluid.threads = line.threads;
  return cs;
}

std::string case_manual() {
  Keys k = Keys::manual();
  Case cs;
  Root{cs.run, cs.fluid, cs.coupling}.describe(k);
  return k.manual_text();
}

}  // namespace bw::cfd
