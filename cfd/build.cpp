// SPDX-License-Identifier: Apache-2.0
#include "cfd/build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cfd/adapt.h"
#include "cfd/afterburn.h"
#include "cfd/embed/cavity.h"
#include "cfd/eos/library.h"
#include "cfd/source/detonation.h"
#include "cfd/light.h"
#include "cfd/start/paint.h"
#include "cfd/start/vortex.h"
#include "common/app/log.h"
#include "common/math/random.h"
#include "common/parallel/loop.h"

namespace bw::cfd {
namespace {

constexpr double atmosphere = 101325;  ///< Pa, where an explosive's energy is counted from

/// An explosive that burns measures its energy from its unburnt state (Jwl::e_shift).
EosChoice for_run(const Case& cs, const MaterialCase& m) {
  EosChoice eos = *m.eos;
  if (!cs.fluid.burn.empty() && cs.fluid.burn[0].material == m.name) {
    Jwl& jwl = std::get<Jwl>(eos);
    jwl.e_shift = unburnt_energy(jwl, atmosphere);
  }
  return eos;
}

Medium make_medium(const Case& cs) {
  std::vector<std::string> names;
  std::vector<EosChoice> eos;
  for (const MaterialCase& m : cs.fluid.material) {
    names.push_back(m.name);
    eos.push_back(for_run(cs, m));
  }
  Medium medium(names, eos, cs.fluid.scheme.floors);
  if (cs.fluid.scheme.interface == "sharp" && medium.count() == 2) {
    medium.interface.sharpness = cs.fluid.scheme.sharpness;
    medium.interface.heaviest = 2;
    for (int m = 0; m < 2; ++m) {
      medium.interface.is_gas[m] = std::visit([](const auto& e) { return e.constant_reference; }, medium.eos[m]);
      medium.interface.Pi_gas[m] = medium.gas[m].Pi;
    }
  }
  return medium;
}

/// Conserved state of a cell full of one material.
void state_of(const Medium& medium, const Case& cs, const StateCase& s, double (&U)[Cons::most]) {
  const int m = cs.fluid.material_index(s.material, s.place);
  double W[Prim::most] = {};
  const double density = s.unburnt ? std::get<Jwl>(medium.eos[m]).rho0 : s.density;
  W[Prim::arho(m)] = density;
  for (int d = 0; d < 3; ++d) W[Prim::v + d] = s.velocity[d];
  W[Prim::p] = s.pressure;
  if (m == 0 || medium.count() > 2) W[Prim::alpha(m)] = 1;
  std::visit([&](const auto& pair) { pair.to_conserved(W, U); }, medium.mixture);
}

Boundary make_boundary(const Medium& medium, const Case& cs) {
  static constexpr const char* names[6] = {"x_lower", "x_upper", "y_lower", "y_upper", "z_lower", "z_upper"};
  Boundary b;
  for (size_t i = 0; i < 6; ++i) {
    const std::string& kind = cs.fluid.boundary.side[i];
    b.side[i].kind = kind == "outflow"    ? SideKind::outflow
                     : kind == "far_field"       ? SideKind::far_field
                     : kind == "subsonic_inflow" ? SideKind::subsonic_inflow
                     : kind == "periodic" ? SideKind::periodic
                     : kind == "inflow"   ? SideKind::inflow
                                          : SideKind::wall;
    b.side[i].across = cs.fluid.grid.upper[int(i / 2)] - cs.fluid.grid.lower[int(i / 2)];
    for (const InflowCase& in : cs.fluid.inflow)
      if (in.side == names[i]) state_of(medium, cs, in, b.side[i].U);
  }
  return b;
}

void report_detonation(const MaterialCase& m, const Jwl& jwl, const CjState& cj) {
  say("{}: D = {:.1f} m/s, P_CJ = {:.3f} GPa from its JWL set", m.name, cj.D, 1e-9 * cj.p);
  if (jwl.D > 0 && std::abs(cj.D / jwl.D - 1) > 0.005)
    warn("{}: the JWL set gives D = {:.1f} m/s, tabulated are {:.1f}: the set is not consistent; the computed one is used", m.name, cj.D, jwl.D);
  if (jwl.p_CJ > 0 && std::abs(cj.p / jwl.p_CJ - 1) > 0.02)
    warn("{}: the JWL set gives P_CJ = {:.3f} GPa, tabulated are {:.3f}", m.name, 1e-9 * cj.p, 1e-9 * jwl.p_CJ);
}

std::optional<Burn> make_burn(const Case& cs, const Forest& forest) {
  const BlockShape& shape = forest.finest_shape();  // explosives burn there
  const GridSize& grid = forest.size();
  if (cs.fluid.burn.empty()) return {};
  const BurnCase& b = cs.fluid.burn[0];
  const MaterialCase& m = cs.fluid.material[size_t(cs.fluid.material_index(b.material, b.place))];
  const Jwl jwl = std::get<Jwl>(*m.eos);
  const CjState cj = cj_state(jwl);
  report_detonation(m, jwl, cj);
  Burn burn;
  burn.points = b.points;
  burn.lines.assign(b.line.begin(), b.line.end());
  burn.discs.assign(b.plane.begin(), b.plane.end());
  burn.start = b.start;
  burn.D = cj.D;
  burn.width = b.width;
  burn.q = released_energy(jwl, atmosphere);
  burn.c_CJ = cj.c;
  for (int d = 0; d < 3; ++d)
    if (shape.used[size_t(d)]) {
      burn.h = std::max(burn.h, shape.h[d]);
      burn.margin = std::max(burn.margin, forest.shape().h[d]);
    } else {
      const double middle = 0.5 * (grid.lower[d] + grid.upper[d]);
      for (Vec3& p : burn.points) p[d] = middle;
      for (LineLight& l : burn.lines) l.from[d] = l.to[d] = middle;
      for (DiscLight& disc : burn.discs) disc.centre[d] = middle, disc.normal[d] = 0;
    }
  for (DiscLight& disc : burn.discs) {
    if (!(norm(disc.normal) > 0)) throw InputError(fmt::format("{}: expected planes whose normal has a part in a direction with cells", b.place));
    disc.normal = unit(disc.normal);
  }
  return burn;
}

Afterburn make_afterburn(const Case& cs) {
  Afterburn after = *cs.fluid.afterburn;
  const MaterialCase& m = cs.fluid.material[size_t(cs.fluid.material_index(cs.fluid.afterburn->material, cs.fluid.afterburn->place))];
  const Jwl& jwl = std::get<Jwl>(*m.eos);
  if (after.energy == 0) after.energy = *heat_of_combustion(m.library) - jwl.E0 / jwl.rho0;
  if (!(after.energy > 0)) throw InputError(fmt::format("{}: \"{}\" has no energy left to burn on with", cs.fluid.afterburn->place, m.name));
  say("{}: its products burn on with {:.4g} MJ/kg beside {:.4g} MJ/kg of detonation", m.name, 1e-6 * after.energy, 1e-6 * jwl.E0 / jwl.rho0);
  return after;
}

GhostRules ghost_rules(const Boundary& b) {
  GhostRules rules;
  for (size_t i = 0; i < 6; ++i)
    rules[i] = b.side[i].kind == SideKind::wall       ? GhostRule::mirror
               : b.side[i].kind == SideKind::periodic ? GhostRule::periodic
                                                      : GhostRule::copy;
  return rules;
}

/// Share of a shell's volume inside the shape, whose edges lie at the zeros of distance along the radius.
double share_of_shell(const auto& shape, double lower, const BlockShape& s, int i) {
  constexpr int samples = 8;
  const double r0 = lower + i * s.h.x;
  const auto inside = [&](double r) { return shape.distance({r, 0, 0}) < 0; };
  const auto volume = [&](double a, double b) {
    BlockShape part = s;
    part.h.x = b - a;
    return part.cell_volume(a, 0);
  };
  double share = 0;
  int whole = 0;
  for (int c = 0; c < samples; ++c) {
    double a = r0 + c * s.h.x / samples, b = r0 + (c + 1) * s.h.x / samples;
    const bool in_a = inside(a), in_b = inside(b);
    if (in_a && in_b) share += volume(a, b), ++whole;
    if (in_a == in_b) continue;
    const double from = a, to = b;
    for (int bisection = 0; bisection < 60; ++bisection) (inside(0.5 * (a + b)) == in_a ? a : b) = 0.5 * (a + b);
    share += in_a ? volume(from, a) : volume(b, to);
  }
  return whole == samples ? 1 : share / volume(r0, r0 + s.h.x);
}

/// Share of a cell inside the shape, from samples^3 points where its edge may pass through the cell.
double share_inside(const auto& shape, const Vec3& centre, const BlockShape& s) {
  double half_diagonal = 0;
  for (int d = 0; d < 3; ++d)
    if (s.used[size_t(d)]) half_diagonal += 0.25 * s.h[d] * s.h[d];
  half_diagonal = std::sqrt(half_diagonal);
  const double distance = shape.distance(centre);
  if (distance >= half_diagonal) return 0;
  if (distance <= -half_diagonal) return 1;
  constexpr int samples = 8;
  const int n[3] = {s.used[0] ? samples : 1, s.used[1] ? samples : 1, s.used[2] ? samples : 1};
  int inside = 0;
  for (int c = 0; c < n[2]; ++c)
    for (int b = 0; b < n[1]; ++b)
      for (int a = 0; a < n[0]; ++a) {
        const Vec3 x = centre + Vec3{((a + 0.5) / n[0] - 0.5) * s.h.x, ((b + 0.5) / n[1] - 0.5) * s.h.y,
                                     ((c + 0.5) / n[2] - 0.5) * s.h.z};
        inside += shape.distance(x) < 0;
      }
  return double(inside) / (n[0] * n[1] * n[2]);
}

/// U of a cell, its share `f` replaced by `fresh`.
void blend(State& state, int block, size_t cell, const double (&fresh)[Cons::most], double f) {
  for (int q = 0; q < state.rows(); ++q) {
    double& u = state.block(block, q)[cell];
    u = f == 1 ? fresh[q] : u + f * (fresh[q] - u);
  }
}

/// False if nothing of the shape is in any cell. Collective.
template <class Shape>
bool paint_shape(Model& m, const Shape& shape, const double (&U)[Cons::most]) {
  std::vector<uint8_t> painted(size_t(m.forest.local_blocks()), 0);
  parallel_for_dynamic(m.forest.local_blocks(), [&](int64_t b) {
    const BlockShape& s = m.forest.shape(int(b));
    const Vec3 lower = m.forest.lower(int(b));
    for (int k = 0; k < s.n[2]; ++k)
      for (int j = 0; j < s.n[1]; ++j)
        for (int i = 0; i < s.n[0]; ++i) {
          const Vec3 x = lower + Vec3{(i + 0.5) * s.h.x, (j + 0.5) * s.h.y, (k + 0.5) * s.h.z};
          const double f = s.radial() ? share_of_shell(shape, lower.x, s, i) : share_inside(shape, x, s);
          if (f > 0) blend(m.state, int(b), s.at(k, j, i), U, f), painted[size_t(b)] = 1;
        }
  });
  return m.forest.comm().max(int64_t(std::count(painted.begin(), painted.end(), 1))) > 0;
}

void paint_cavity(Model& m, const CavityRegion& shape, const RegionCase& region, const double (&U)[Cons::most], bool last) {
  if (!m.walls) throw InputError(fmt::format("{}: expected no cavity: it needs the surface of a body, from csd or from [[fluid.body]]", region.place));
  const Cavity cavity = find_cavity(m.walls->surface(), m.walls->map(), shape.seed);
  if (cavity.cells.empty()) throw InputError(fmt::format("{}: the cavity's seed lies in metal or outside the domain", region.place));
  if (cavity.reaches_boundary)
    throw InputError(fmt::format("{}: from the cavity's seed the side of the domain is reached: no closed surface is around it", region.place));
  for (const Index3& c : cavity.cells)
    if (const Forest::Cell at = m.forest.find_finest(c); at.block >= 0 && at.block < m.forest.local_blocks())
      blend(m.state, at.block, m.forest.shape().at(at.k, at.j, at.i), U, 1);
  const double density = m.setup.medium.density(U);
  m.cavity_mass += density * cavity.exact_volume;
  if (last) say("cavity of {:.6g} m^3 ({:.6g} in {} cells, {:+.3f} %): {:.6g} kg of {}", cavity.exact_volume, cavity.cell_volume, cavity.cells.size(),
      100 * (cavity.cell_volume / cavity.exact_volume - 1), density * cavity.cell_volume, region.material);
}

WallOptions make_wall_options(const WallsCase& walls) {
  WallOptions r;
  if (walls.slits != "centre") r.slits = walls.slits == "area" ? Slits::area : Slits::sealed;
  if (walls.treatment == "first_order") r.treatment = WallTreatment::first_order;
  if (walls.treatment == "mirror") r.treatment = WallTreatment::mirror;
  if (walls.treatment == "cut_cell") r.treatment = WallTreatment::cut_cell;
  r.conservative = walls.loads == "conservative";
  return r;
}

}  // namespace

Model::Model(const Comm& comm, const Case& cs)
    : forest(comm, cs.fluid.grid), state(forest, int(cs.fluid.material.size())) {
  setup.medium = make_medium(cs);
  setup.boundary = make_boundary(setup.medium, cs);
  setup.burn = make_burn(cs, forest);
  if (cs.fluid.afterburn) {
    setup.afterburn = make_afterburn(cs);
    afterburn_follows = !cs.fluid.afterburn->own_begin;
    afterburn_place = cs.fluid.afterburn->place;
  }
  setup.skip_quiet = cs.fluid.scheme.skip_quiet;
  wall_options = make_wall_options(cs.fluid.walls);
  if (cs.fluid.amr) refine = cs.fluid.amr->rules;
  if (cs.fluid.start_from) start = std::make_shared<Start>(begin_from(*cs.fluid.start_from, *this));
}

void add_walls(Model& m, double p_ref) {
  const GridSize& size = m.forest.size();
  const BlockShape& s = m.forest.finest_shape();
  Lattice lattice{size.lower, s.h, m.forest.cells_of_level(m.forest.levels())};
  m.walls.emplace(lattice, ghost_rules(m.setup.boundary), s.n, p_ref, m.wall_options);
}

std::vector<double> open_volumes(const Model& m, int block) {
  std::vector<double> open;
  const CutCells* cut = m.walls ? m.walls->cut() : nullptr;
  const Index3 first = m.forest.first_finest(block);
  if (!cut || m.forest.level(block) != m.forest.levels() || !cut->near(first)) return open;
  const BlockShape& s = m.forest.shape();
  for (int k = 0; k < s.n[2]; ++k)
    for (int j = 0; j < s.n[1]; ++j) {
      double before = -1;  // cells side by side that are not listed are all open or all closed
      for (int i = 0; i < s.n[0]; ++i) {
        const Index3 c{first[0] + i, first[1] + j, first[2] + k};
        const bool listed = cut->find(c) >= 0;
        open.push_back(!listed && before >= 0 ? before : cut->volume(c));
        before = listed ? -1 : open.back();
      }
    }
  return open;
}

std::vector<uint8_t> blocked_cells(const Model& m, int block) {
  std::vector<uint8_t> blocked;
  if (!m.walls) return blocked;
  if (const CutCells* cut = m.walls->cut()) {
    for (const double open : open_volumes(m, block)) blocked.push_back(!(open > 0));
    if (blocked.empty() && cut->closed(m.forest.first_finest(block)))
      blocked.assign(size_t(m.forest.shape().cells()), 1);
    return blocked;
  }
  const BlockShape& s = m.forest.shape();
  const Index3 first = m.forest.first_finest(block), n = m.forest.finest_cells(block);
  const bool finest = m.forest.level(block) == m.forest.levels();
  if (finest ? !m.walls->near(first) : !m.walls->map().touches(first, {first[0] + n[0], first[1] + n[1], first[2] + n[2]})) return blocked;
  if (!finest) {  // all metal, or none
    if (m.walls->map().blocked(first)) blocked.assign(size_t(s.cells()), 1);
    return blocked;
  }
  blocked.assign(size_t(s.cells()), 0);
  if (!m.walls->map().copy_blocked(first, s.n, blocked.data())) blocked.clear();
  return blocked;
}

void inspect(Model& m, const std::vector<int>& blocks) {
  parallel_for_dynamic(int64_t(blocks.size()), [&](int64_t i) {
    const int b = blocks[size_t(i)];
    const std::vector<uint8_t> blocked = blocked_cells(m, b);
    m.state.info[size_t(b)] = inspect_block(m.setup.medium, m.forest.shape(b), m.forest.lower(b), m.state.block(b), blocked.empty() ? nullptr : blocked.data());
  });
}

namespace {

void paint_regions(Model& m, const Case& cs, bool last) {
  m.cavity_mass = 0;
  for (const RegionCase& r : cs.fluid.region) {
    double U[Cons::most];
    state_of(m.setup.medium, cs, r, U);
    std::visit(
        [&](const auto& shape) {
          if constexpr (std::is_same_v<std::decay_t<decltype(shape)>, CavityRegion>)
            paint_cavity(m, shape, r, U, last);
          else if (!paint_shape(m, shape, U) && last)
            warn("{}: the region fills no part of any cell: it is outside of the domain, or far smaller than a cell", r.place);
        },
        r.shape);
  }
  double unpainted = 0;
  std::vector<int> all;
  for (int b = 0; b < m.forest.local_blocks(); ++b) {
    all.push_back(b);
    for (int c = 0; c < m.forest.shape().cells(); ++c) {
      double rho = 0;
      for (int k = 0; k < std::max(m.setup.medium.count(), 2); ++k) rho += m.state.block(b, Cons::arho(k))[c];
      if (!(rho > 0)) ++unpainted;
    }
  }
  if (const double n = m.forest.comm().sum(unpainted); n > 0)
    throw InputError(fmt::format("{}: fluid.region: {:g} cells belong to no region: begin with shape = {{kind = \"everywhere\"}}", cs.file, n));
  if (m.start) paint_profile(m, *m.start, last);
  for (const VortexCase& v : cs.fluid.vortex) paint_vortex(m, v);
  inspect(m, all);
}

}  // namespace

namespace {

/// Random densities; pressure, velocity and composition stay.
void perturb(Model& m, double amplitude) {
  const Index3 n = m.forest.cells_of_level(m.forest.levels());
  std::vector<int> all;
  for (int b = 0; b < m.forest.local_blocks(); ++b) {
    all.push_back(b);
    const BlockShape& s = m.forest.shape(b);
    const Index3 first = m.forest.first_finest(b), wide = m.forest.finest_cells(b);
    for (int k = 0; k < s.n[2]; ++k)
      for (int j = 0; j < s.n[1]; ++j)
        for (int i = 0; i < s.n[0]; ++i) {
          const uint64_t x = uint64_t(first[0] + i * (wide[0] / s.n[0])), y = uint64_t(first[1] + j * (wide[1] / s.n[1])),
                         z = uint64_t(first[2] + k * (wide[2] / s.n[2]));
          const double factor = 1 + amplitude * (2 * uniform01(1, (z * uint64_t(n[1]) + y) * uint64_t(n[0]) + x) - 1);
          double U[Cons::most], W[Prim::most];
          for (int q = 0; q < m.state.rows(); ++q) U[q] = m.state.block(b, q)[s.at(k, j, i)];
          std::visit(
              [&](const auto& pair) {
                pair.to_primitive(U, W, m.setup.medium.floors);
                for (int l = 0; l < std::max(m.setup.medium.count(), 2); ++l) W[Prim::arho(l)] *= factor;
                pair.to_conserved(W, U);
              },
              m.setup.medium.mixture);
          for (int q = 0; q < m.state.rows(); ++q) m.state.block(b, q)[s.at(k, j, i)] = U[q];
        }
  }
  inspect(m, all);
}

}  // namespace

void paint(Model& m, const Case& cs) {
  paint_regions(m, cs, !m.refine);
  if (m.refine) {
    for (int i = 0; i < m.forest.levels() && adapt_unpainted(m); ++i) paint_regions(m, cs, false);
    paint_regions(m, cs, true);
  }
  if (cs.fluid.perturbation > 0) perturb(m, cs.fluid.perturbation);
  if (m.setup.burn) light(m, cs);
  begin_afterburn(m);
}

}  // namespace bw::cfd
