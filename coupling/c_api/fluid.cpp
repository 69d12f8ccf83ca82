// SPDX-License-Identifier: Apache-2.0
// The C functions of breakwave_coupling.h over FluidSide.
#include <unistd.h>

#include <cstring>
#include <optional>

#include "common/app/error.h"
#include "common/app/log.h"
#include "common/app/version.h"
#include "coupling/breakwave_coupling.h"
#include "coupling/fluid_side.h"
#include "coupling/join.h"
#include "coupling/wall_path.h"

using namespace bw;
using namespace bw::coupling;

static_assert(FSI_PROTOCOL_MAJOR == protocol_major && FSI_PROTOCOL_MINOR == protocol_minor);
static_assert(FSI_FACE_LIP == face_lip && FSI_FACE_THIN == face_thin);
static_assert(FSI_SCHEME_FLUID_FIRST == int(Scheme::fluid_first) && FSI_SCHEME_BOX1 == int(Scheme::box1) &&
              FSI_SCHEME_CONCURRENT == int(Scheme::concurrent));
static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(std::array<int32_t, 4>) == 4 * sizeof(int32_t));

// a struct of another size is another FSI_ABI
static_assert(FSI_ABI == 1 && (sizeof(void*) != 8 ||
                               (sizeof(fsi_options) == 128 && sizeof(fsi_surface) == 168 && sizeof(fsi_load) == 136)));

struct fsi_fluid {
  CouplingCase cs;
  bool owns_mpi = false;
  Joined joined;
  std::optional<FluidSide> side;
  WallPath path;
  std::vector<Vec3> area, centre;  // [n_faces]
  bool has_surface = false, over = false;
};

namespace {

[[noreturn]] void end(fsi_fluid* fluid, int code, const std::string& text) {
  if (fluid && fluid->joined.channel) fluid->joined.channel->fail(code, text);
  if (code == 0) code = exit_unspecified;
  error_line(text);
  int started = 0;
  MPI_Initialized(&started);
  if (started) MPI_Abort(MPI_COMM_WORLD, code);
  _exit(code);
}

/// No exception crosses the border to C.
template <class Work>
auto in_c(fsi_fluid* fluid, const Work& work) {
  try {
    return work();
  } catch (const InputError& e) {
    end(fluid, exit_input, e.what());
  } catch (const CodedError& e) {
    end(fluid, e.code, e.what());
  } catch (const std::exception& e) {
    end(fluid, exit_bug, e.what());
  }
}

void expect(fsi_fluid* fluid, bool condition, const char* text) {
  if (!condition) end(fluid, exit_bug, text);
}

std::string text_of(const char* text) { return text ? text : ""; }

CouplingCase case_of(const fsi_options& options) {
  CouplingCase cs;
  switch (options.scheme) {
    case FSI_SCHEME_NONE:
      cs.scheme = "";
      break;
    case FSI_SCHEME_FLUID_FIRST:
      cs.scheme = "fluid_first";
      break;
    case FSI_SCHEME_BOX1:
      cs.scheme = "box1";
      break;
    case FSI_SCHEME_CONCURRENT:
      cs.scheme = "concurrent";
      break;
    default:
      throw InputError(fmt::format("fsi_fluid_open: scheme {} is none of FSI_SCHEME_...", options.scheme));
  }
  cs.reference_pressure = options.p_ref;
  cs.silence_limit = options.silence_limit;
  cs.join_limit = options.join_limit;
  if (options.port_file) cs.join = "port", cs.port_file = options.port_file;
  if (!(cs.reference_pressure >= 0)) throw InputError("fsi_fluid_open: p_ref: a pressure >= 0 was expected");
  if (!(cs.silence_limit > 0) || !(cs.join_limit > 0))
    throw InputError("fsi_fluid_open: silence_limit, join_limit: times > 0 were expected");
  return cs;
}

Hello hello_of(const fsi_options& options) {
  const auto vec = [](const double* a) { return Vec3{a[0], a[1], a[2]}; };
  return {.program = text_of(options.program),
          .version = text_of(options.version),
          .units = text_of(options.units),
          .t0 = options.t0,
          .t_end = options.t_end,
          .lower = vec(options.lower),
          .upper = vec(options.upper),
          .features = feature_traction | feature_impedance};
}

const double* flat(const std::vector<Vec3>& a) { return a.empty() ? nullptr : &a[0].x; }

FluidTotals books_of(const fsi_load& load) {
  FluidTotals t;
  t.mass = load.mass, t.energy = load.energy;
  t.momentum = {load.momentum[0], load.momentum[1], load.momentum[2]};
  t.mass_covered = load.mass_covered, t.mass_uncovered = load.mass_uncovered;
  t.energy_covered = load.energy_covered, t.energy_uncovered = load.energy_uncovered;
  t.dry_faces = load.dry_faces, t.dry_area = load.dry_area;
  return t;
}

/// Books besides impulse, moment, work and swept volume, which are this function's.
Loads loads_of(const fsi_load& load, const WetSurface& surface, const Window& window, const WallPath& path) {
  const size_t n = surface.quads.size();
  Loads loads;
  loads.t1 = load.t1;
  loads.stop = load.stop != 0;
  loads.dt_next = load.dt_next;
  loads.p.assign(load.p, load.p + n);
  if (load.impedance) loads.impedance.assign(load.impedance, load.impedance + n);
  for (size_t f = 0; load.traction && f < n; ++f)
    loads.traction.push_back({load.traction[3 * f], load.traction[3 * f + 1], load.traction[3 * f + 2]});
  const FluidTotals wall = wall_totals(surface, loads, path.velocity(load.t1 - window.t0), window);
  loads.totals = books_of(load);
  loads.totals.impulse = wall.impulse, loads.totals.moment = wall.moment;
  loads.totals.work = wall.work, loads.totals.swept = wall.swept;
  return loads;
}

}  // namespace

void fsi_defaults(fsi_options* options) {
  *options = fsi_options{.program = "fluid",
                         .version = "",
                         .units = "SI",
                         .p_ref = 101325,
                         .t0 = 0,
                         .t_end = 0,
                         .lower = {-1e30, -1e30, -1e30},
                         .upper = {1e30, 1e30, 1e30},
                         .scheme = FSI_SCHEME_NONE,
                         .silence_limit = 600,
                         .join_limit = 120,
                         .port_file = nullptr};
}

const char* fsi_version() { return version(); }
int fsi_abi() { return FSI_ABI; }

fsi_fluid* fsi_fluid_open(const fsi_options* options) {
  return in_c(nullptr, [&] {
    int started = 0;
    MPI_Initialized(&started);
    set_speaker(text_of(options->program), true);
    auto* fluid = new fsi_fluid;
    fluid->cs = case_of(*options);
    fluid->owns_mpi = !started;
    int provided = 0;
    if (!started) check_mpi(MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &provided), "MPI_Init_thread");
    fluid->joined = join(Comm(MPI_COMM_WORLD), Role::fluid, fluid->cs);
    if (!fluid->joined.channel)
      end(nullptr, exit_join,
          fmt::format("no solid program in this run: mpirun -n 1 csd case.toml : -n {} {}", fluid->joined.mine.size(),
                      text_of(options->program)));
    set_speaker(text_of(options->program), fluid->joined.mine.root());
    fluid->side.emplace(*fluid->joined.channel, fluid->cs, hello_of(*options));
    return fluid;
  });
}

double fsi_t_end(const fsi_fluid* fluid) { return fluid->side->t_end(); }
int fsi_rank(const fsi_fluid* fluid) { return fluid->joined.mine.rank(); }
int fsi_size(const fsi_fluid* fluid) { return fluid->joined.mine.size(); }
int fsi_comm(const fsi_fluid* fluid) { return MPI_Comm_c2f(fluid->joined.mine.raw()); }

int fsi_recv_surface(fsi_fluid* fluid, fsi_surface* surface) {
  return in_c(fluid, [&] {
    expect(fluid, !fluid->has_surface, "fsi_recv_surface: the surface before has not been answered by fsi_send_load");
    if (fluid->over || !fluid->side->receive()) {
      fluid->over = true;
      return 0;
    }
    const WetSurface& wet = fluid->side->surface();
    const Window& window = fluid->side->window();
    fluid->has_surface = true;
    fluid->path.begin(window, wet);
    fluid->area.clear(), fluid->centre.clear();
    for (const auto& quad : wet.quads) {
      fluid->area.push_back(area_vector(wet.x, quad));
      fluid->centre.push_back(face_mean(wet.x, quad));
    }
    *surface = fsi_surface{.window = window.index,
                           .topo_version = wet.topo_version,
                           .n_nodes = int64_t(wet.x.size()),
                           .n_faces = int64_t(wet.quads.size()),
                           .t0 = window.t0,
                           .t1_max = window.t1_max,
                           .dt_stable = window.dt_stable,
                           .new_topology = fluid->side->topology_changed(),
                           .last = window.last,
                           .mean_pressure = window.mean_pressure,
                           .x = flat(wet.x),
                           .v = flat(wet.v),
                           .x_wall = flat(fluid->path.x()),
                           .quads = wet.quads.empty() ? nullptr : wet.quads[0].data(),
                           .node_id = wet.node_id.data(),
                           .node_parent = wet.node_parent.data(),
                           .face_id = wet.face_id.data(),
                           .body = wet.body.data(),
                           .flags = wet.flags.data(),
                           .area = flat(fluid->area),
                           .centre = flat(fluid->centre),
                           .fixed = window.fixed};
    return 1;
  });
}

void fsi_wall_velocity(fsi_fluid* fluid, double t1, double* nodes, double* faces) {
  in_c(fluid, [&] {
    expect(fluid, fluid->has_surface, "fsi_wall_velocity: no surface is in hand");
    expect(fluid, t1 > fluid->side->window().t0, "fsi_wall_velocity: t1 is not after t0");
    const std::vector<Vec3> v = fluid->path.velocity(t1 - fluid->side->window().t0);
    if (nodes && !v.empty()) std::memcpy(nodes, v.data(), v.size() * sizeof(Vec3));
    if (!faces) return;
    for (const auto& quad : fluid->side->surface().quads) {
      const Vec3 mean = face_mean(v, quad);
      *faces++ = mean.x, *faces++ = mean.y, *faces++ = mean.z;
    }
  });
}

void fsi_send_load(fsi_fluid* fluid, const fsi_load* load) {
  in_c(fluid, [&] {
    expect(fluid, fluid->has_surface, "fsi_send_load: no surface is in hand that could be answered");
    const WetSurface& surface = fluid->side->surface();
    const Window& window = fluid->side->window();
    expect(fluid, load->p || surface.quads.empty(), "fsi_send_load: p is NULL");
    fluid->side->send(loads_of(*load, surface, window, fluid->path));
    fluid->path.end(load->t1 - window.t0);
    fluid->has_surface = false;
  });
}

void fsi_fail(fsi_fluid* fluid, int code, const char* text) { end(fluid, code, text_of(text)); }

void fsi_poll(fsi_fluid* fluid) {
  in_c(fluid, [&] { fluid->joined.channel->poll(); });
}

void fsi_sum(fsi_fluid* fluid, double* values, int64_t n) {
  in_c(fluid, [&] { fluid->joined.mine.sum(std::span(values, size_t(n))); });
}

void fsi_close(fsi_fluid* fluid) {
  if (!fluid) return;
  if (!fluid->over) end(fluid, exit_left, "fsi_close was called while the coupling was open");
  const bool owns_mpi = fluid->owns_mpi;
  delete fluid;
  if (owns_mpi) MPI_Finalize();
}
