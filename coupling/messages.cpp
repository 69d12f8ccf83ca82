// SPDX-License-Identifier: Apache-2.0
#include "coupling/messages.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/parallel/exact_sums.h"
#include "coupling/channel.h"

namespace bw::coupling {
namespace {

template <size_t N>
void put(char (&to)[N], const std::string& from) {
  std::snprintf(to, N, "%s", from.c_str());
}
template <size_t N>
std::string text(const char (&from)[N]) {
  return std::string(from, strnlen(from, N));
}

std::string box(const double lower[3], const double upper[3]) {
  return fmt::format("[{:.6g}, {:.6g}] x [{:.6g}, {:.6g}] x [{:.6g}, {:.6g}] m", lower[0], upper[0], lower[1], upper[1],
                     lower[2], upper[2]);
}
bool differ(double a, double b, double relative) {
  return !(std::abs(a - b) <= relative * std::fmax(std::abs(a), std::abs(b)));
}
bool is_empty(const HelloBlock& h) { return !(h.lower[0] <= h.upper[0]); }
bool is_finite(const Vec3& a) { return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z); }

/// First entry that is not finite.
Verdict check_finite(const char* name, const char* what, const std::vector<Vec3>& values) {
  const auto add = [&](size_t i, std::array<double, 1>& s) { s[0] += 0 * (values[i].x + values[i].y + values[i].z); };
  if (exact_sums<1>(values.size(), add)[0] == 0) return {};  // else it is looked for
  for (size_t i = 0; i < values.size(); ++i)
    if (!is_finite(values[i]))
      return Fault{exit_bad_value,
                   fmt::format("{} of {} {} is ({}, {}, {})", name, what, i, values[i].x, values[i].y, values[i].z)};
  return {};
}
Verdict check_distinct(const char* name, const std::vector<int64_t>& ids) {
  const auto not_below = [](int64_t a, int64_t b) { return a >= b; };
  if (std::adjacent_find(ids.begin(), ids.end(), not_below) == ids.end()) return {};  // sorted already
  const auto occurs_twice = [&](int64_t id) {
    return Fault{exit_bad_value, fmt::format("SURFACE: {} {} occurs twice", name, id)};
  };
  const auto [least, most] = std::minmax_element(ids.begin(), ids.end());
  const uint64_t first = uint64_t(*least), span = uint64_t(*most) - first;
  if (span / 64 <= ids.size()) {  // dense, as a mesh's are
    std::vector<bool> seen(size_t(span) + 1);
    for (const int64_t id : ids) {
      const uint64_t at = uint64_t(id) - first;
      if (seen[at]) return occurs_twice(id);
      seen[at] = true;
    }
    return {};
  }
  std::vector<int64_t> sorted = ids;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) return occurs_twice(*twice);
  return {};
}

/// FNV-1a on words of 64 bits, an array's last one filled up with zeros; each next word of an array goes to the next of
/// some lanes, which don't wait for each other.
template <size_t lanes>
class LaneHash {
 public:
  template <class T>
  void take(const std::vector<T>& a) {
    const size_t bytes = a.size() * sizeof(T);
    const auto* data = reinterpret_cast<const char*>(a.data());
    size_t at = 0;
    for (; at + 8 * lanes <= bytes; at += 8 * lanes)
      for (size_t k = 0; k < lanes; ++k) mix(h_[k], data + at + 8 * k, 8);
    for (size_t k = 0; at < bytes; ++k, at += 8) mix(h_[k], data + at, std::min<size_t>(8, bytes - at));
  }
  uint64_t value() const {
    if (lanes == 1) return h_[0];
    uint64_t h = start;
    for (const uint64_t& lane : h_) mix(h, reinterpret_cast<const char*>(&lane), 8);
    return h;
  }

 private:
  static constexpr uint64_t start = 14695981039346656037ull;
  static void mix(uint64_t& h, const char* from, size_t count) {
    uint64_t word = 0;
    std::memcpy(&word, from, count);
    h = (h ^ word) * 1099511628211ull;
  }
  std::array<uint64_t, lanes> h_ = [] {
    std::array<uint64_t, lanes> h{};
    h.fill(start);
    return h;
  }();
};

template <size_t lanes>
uint64_t hash_in_lanes(const WetSurface& surface) {
  LaneHash<lanes> h;
  h.take(surface.quads), h.take(surface.node_id), h.take(surface.node_parent);
  h.take(surface.face_id), h.take(surface.body), h.take(surface.flags);
  return h.value();
}

void put(double (&to)[3], const Vec3& from) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
}

}  // namespace

// --- HELLO
// ----------------------------------------------------------------------------------------------------------------------

HelloBlock pack(const Hello& hello, const CouplingCase& cs, const char* role, int ranks) {
  HelloBlock h{};
  std::memcpy(h.magic, protocol_magic, sizeof h.magic);
  h.endian = protocol_endian;
  h.major = protocol_major;
  h.minor = protocol_minor;
  h.bytes = sizeof h;
  put(h.role, role);
  put(h.program, hello.program);
  put(h.version, hello.version);
  put(h.units, hello.units);
  h.p_ref = cs.reference_pressure;
  h.t0 = hello.t0;
  h.t_end = hello.t_end;
  h.features = hello.features;
  h.restart_id = hello.restart_hash != 0;
  h.restart_window = hello.first_window;
  h.restart_hash = hello.restart_hash;
  h.scheme = int32_t(cs.kind());
  h.ranks = ranks;
  put(h.lower, hello.lower);
  put(h.upper, hello.upper);
  h.silence_limit = cs.silence_limit;
  if (std::string(role) == name_of(Role::solid) && (cs.window > 0 || cs.kind() == Scheme::concurrent))
    h.minor_needed = minor_of_fixed_windows;
  return h;
}

Verdict check_protocol(const HelloBlock& other, size_t bytes) {
  if (bytes < offsetof(HelloBlock, role) || std::memcmp(other.magic, protocol_magic, sizeof other.magic) != 0)
    return Fault{exit_protocol, "HELLO: the other program does not speak this protocol (magic)"};
  if (other.endian != protocol_endian) return Fault{exit_protocol, "HELLO: the other program has another byte order"};
  if (other.major != protocol_major)
    return Fault{exit_version, fmt::format("HELLO: protocol version {}.{} here, {}.{} in the other program",
                                           protocol_major, protocol_minor, other.major, other.minor)};
  if (bytes != sizeof other || other.bytes != sizeof other)
    return Fault{exit_malformed, fmt::format("HELLO has {} bytes, {} were expected", bytes, sizeof other)};
  return {};
}

Verdict check_minor(const HelloBlock& mine, const HelloBlock& other) {
  const auto speaks = [](const HelloBlock& listener, const HelloBlock& needs) -> Verdict {
    if (listener.minor >= needs.minor_needed) return {};
    const bool fixed = needs.minor_needed == minor_of_fixed_windows;
    return Fault{exit_version, fmt::format("HELLO: {} needs protocol {}.{} in this run{}, {} speaks {}.{} only",
                                           text(needs.program), needs.major, needs.minor_needed,
                                           fixed ? " (fixed windows: coupling.window, or scheme concurrent)" : "",
                                           text(listener.program), listener.major, listener.minor)};
  };
  if (auto fault = speaks(other, mine)) return fault;
  return speaks(mine, other);
}

Verdict check_agreement(const HelloBlock& mine, const HelloBlock& other) {
  if (text(mine.role) == text(other.role))
    return Fault{exit_disagreement, fmt::format("HELLO: both programs call themselves {}", text(mine.role))};
  const auto contradict = [&](const char* what, double a, double b, const char* unit) {
    return Fault{exit_disagreement, fmt::format("HELLO: {} is {:.9g} {} in {}, {:.9g} {} in {}", what, a, unit,
                                                text(mine.program), b, unit, text(other.program))};
  };
  if (differ(mine.p_ref, other.p_ref, 1e-12))
    return contradict("the reference pressure", mine.p_ref, other.p_ref, "Pa");
  if (mine.restart_id != other.restart_id || mine.restart_window != other.restart_window ||
      mine.restart_hash != other.restart_hash)
    return Fault{exit_disagreement,
                 fmt::format("HELLO: {} goes on from window {} of checkpoint {:016x}, {} from window {} of {:016x}",
                             text(mine.program), mine.restart_window, mine.restart_hash, text(other.program),
                             other.restart_window, other.restart_hash)};
  if (differ(mine.t0, other.t0, 1e-12)) return contradict("the start time", mine.t0, other.t0, "s");
  if (!std::isfinite(other.t_end)) return Fault{exit_bad_value, "HELLO: t_end is not a number"};
  if (mine.scheme != 0 && other.scheme != 0 && mine.scheme != other.scheme)
    return Fault{exit_disagreement, "HELLO: the two programs were given different coupling schemes"};
  if (!is_empty(mine) && !is_empty(other))
    for (int d = 0; d < 3; ++d)
      if (!(mine.lower[d] <= other.upper[d] && other.lower[d] <= mine.upper[d])) {
        const bool solid = text(mine.role) == name_of(Role::solid);
        const HelloBlock &s = solid ? mine : other, &f = solid ? other : mine;
        return Fault{exit_apart,
                     fmt::format("HELLO: the wet surface of the solid, {}, lies outside the fluid's domain, {}",
                                 box(s.lower, s.upper), box(f.lower, f.upper))};
      }
  return {};
}

std::string overlap_warning(const HelloBlock& solid, const HelloBlock& fluid) {
  if (is_empty(solid)) return "the solid has no wet surface";
  for (int d = 0; d < 3; ++d) {
    const double slack = 1e-9 * (fluid.upper[d] - fluid.lower[d]);
    if (solid.lower[d] < fluid.lower[d] - slack || solid.upper[d] > fluid.upper[d] + slack)
      return fmt::format(
          "a part of the wet surface, {}, lies outside the fluid's domain, {}: it gets the reference pressure",
          box(solid.lower, solid.upper), box(fluid.lower, fluid.upper));
  }
  return {};
}

// --- STEP and SURFACE
// -----------------------------------------------------------------------------------------------------------

StepBlock pack(const Window& window, const WetSurface& surface) {
  StepBlock s{};
  s.window = window.index;
  s.topo_version = surface.topo_version;
  s.n_nodes = int64_t(surface.x.size());
  s.n_faces = int64_t(surface.quads.size());
  s.t0 = window.t0;
  s.t1_max = window.t1_max;
  s.dt_stable = window.dt_stable;
  if (window.last) s.flags |= step_last;
  if (window.checkpoint) s.flags |= step_checkpoint;
  if (window.mean_pressure) s.flags |= step_mean_pressure;
  if (window.fixed) s.flags |= step_fixed;
  return s;
}

Verdict check_step(const StepBlock& s, const Known& known) {
  if (s.window != known.window + 1)
    return Fault{exit_malformed, fmt::format("STEP: window {} arrived, {} was expected", s.window, known.window + 1)};
  if (!(s.t1_max > s.t0) || !std::isfinite(s.t1_max))
    return Fault{exit_bad_value, fmt::format("STEP: t1_max = {:.9g} s is not after t0 = {:.9g} s", s.t1_max, s.t0)};
  if (differ(s.t0, known.t, 1e-12))
    return Fault{exit_bad_value,
                 fmt::format("STEP: t0 = {:.17g} s, but the window before ended at {:.17g} s", s.t0, known.t)};
  if (s.n_nodes < 0 || s.n_nodes > INT32_MAX || s.n_faces < 0 || s.n_faces > INT32_MAX)
    return Fault{exit_malformed, fmt::format("STEP: {} nodes and {} faces", s.n_nodes, s.n_faces)};
  if (s.flags & step_connectivity) return {};
  if (s.topo_version != known.topo_version || s.hash != known.hash || s.n_nodes != known.n_nodes ||
      s.n_faces != known.n_faces)
    return Fault{exit_malformed,
                 fmt::format("STEP: topology version {} ({} nodes, {} faces) without its connectivity; version {} ({} "
                             "nodes, {} faces) is known",
                             s.topo_version, s.n_nodes, s.n_faces, known.topo_version, known.n_nodes, known.n_faces)};
  return {};
}

Verdict check_motion(const WetSurface& surface) {
  if (auto fault = check_finite("SURFACE: x", "node", surface.x)) return fault;
  return check_finite("SURFACE: v", "node", surface.v);
}

Verdict check_connectivity(const WetSurface& surface) {
  const size_t nodes = surface.x.size(), faces = surface.quads.size();
  if (surface.v.size() != nodes || surface.node_id.size() != nodes || surface.node_parent.size() != nodes ||
      surface.face_id.size() != faces || surface.body.size() != faces || surface.flags.size() != faces)
    return Fault{exit_malformed, "SURFACE: arrays of different lengths"};
  uint32_t largest = 0;  // a negative one is larger than any that may be
  for (const auto& quad : surface.quads)
    for (const int32_t node : quad) largest = std::max(largest, uint32_t(node));
  for (size_t f = 0; f < faces && largest >= nodes; ++f)
    for (const int32_t node : surface.quads[f])
      if (node < 0 || size_t(node) >= nodes)
        return Fault{exit_bad_value, fmt::format("SURFACE: face {} names node {} of {}", f, node, nodes)};
  if (auto fault = check_distinct("node_id", surface.node_id)) return fault;
  return check_distinct("face_id", surface.face_id);
}

Verdict check_surface(const WetSurface& surface) {
  if (auto fault = check_connectivity(surface)) return fault;
  return check_motion(surface);
}

uint64_t connectivity_hash(const WetSurface& surface, uint32_t minor) {
  return minor < minor_of_lanes ? hash_in_lanes<1>(surface) : hash_in_lanes<4>(surface);
}

// --- LOAD
// -----------------------------------------------------------------------------------------------------------------------

LoadBlock pack(const Loads& loads, const StepBlock& asked) {
  LoadBlock b{};
  b.window = asked.window;
  b.topo_version = asked.topo_version;
  b.n_faces = int64_t(loads.p.size());
  b.t1 = loads.t1;
  if (!loads.traction.empty()) b.flags |= load_traction;
  if (!loads.impedance.empty()) b.flags |= load_impedance;
  if (loads.stop) b.flags |= load_stop;
  if (loads.checkpoint) b.flags |= load_checkpoint;
  const FluidTotals& t = loads.totals;
  put(b.impulse, t.impulse);
  put(b.moment, t.moment);
  put(b.momentum, t.momentum);
  b.work = t.work;
  b.swept = t.swept;
  b.mass = t.mass;
  b.energy = t.energy;
  b.mass_covered = t.mass_covered;
  b.mass_uncovered = t.mass_uncovered;
  b.energy_covered = t.energy_covered;
  b.energy_uncovered = t.energy_uncovered;
  b.dry_faces = t.dry_faces;
  b.dry_area = t.dry_area;
  b.dt_next = loads.dt_next;
  return b;
}

FluidTotals totals_of(const LoadBlock& b) {
  FluidTotals t;
  t.impulse = {b.impulse[0], b.impulse[1], b.impulse[2]};
  t.moment = {b.moment[0], b.moment[1], b.moment[2]};
  t.momentum = {b.momentum[0], b.momentum[1], b.momentum[2]};
  t.work = b.work;
  t.swept = b.swept;
  t.mass = b.mass;
  t.energy = b.energy;
  t.mass_covered = b.mass_covered;
  t.mass_uncovered = b.mass_uncovered;
  t.energy_covered = b.energy_covered;
  t.energy_uncovered = b.energy_uncovered;
  t.dry_faces = b.dry_faces;
  t.dry_area = b.dry_area;
  return t;
}

Verdict check_load(const LoadBlock& load, const StepBlock& asked) {
  if (load.window != asked.window || load.topo_version != asked.topo_version || load.n_faces != asked.n_faces)
    return Fault{
        exit_malformed,
        fmt::format("LOAD answers window {}, topology {}, {} faces; asked were window {}, topology {}, {} faces",
                    load.window, load.topo_version, load.n_faces, asked.window, asked.topo_version, asked.n_faces)};
  if (!(load.t1 > asked.t0) || !(load.t1 <= asked.t1_max))
    return Fault{exit_bad_value,
                 fmt::format("LOAD: t1 = {:.17g} s is not in ({:.17g}, {:.17g}] s", load.t1, asked.t0, asked.t1_max)};
  if ((asked.flags & step_fixed) && load.t1 != asked.t1_max)
    return Fault{exit_bad_value,
                 fmt::format("LOAD: t1 = {:.17g} s, but the window is a fixed one that ends at t1_max = {:.17g} s",
                             load.t1, asked.t1_max)};
  if (!(load.dt_next >= 0)) return Fault{exit_bad_value, fmt::format("LOAD: dt_next is {} s", load.dt_next)};
  return {};
}

Verdict check_values(const Loads& loads, const WetSurface& surface) {
  const size_t n = surface.quads.size();
  if (loads.p.size() != n)
    return Fault{exit_malformed, fmt::format("LOAD: {} pressures for {} faces", loads.p.size(), n)};
  if ((!loads.traction.empty() && loads.traction.size() != n) ||
      (!loads.impedance.empty() && loads.impedance.size() != n))
    return Fault{exit_malformed, fmt::format("LOAD: {} tractions, {} impedances for {} faces", loads.traction.size(),
                                             loads.impedance.size(), n)};
  const auto bad = [&](const char* name, size_t f, const std::string& value) {
    const Vec3 x = face_mean(surface.x, surface.quads[f]);
    return Fault{
        exit_bad_value,
        fmt::format("LOAD: {} of face {} is {}; its id is {}, it lies at ({:.6g}, {:.6g}, {:.6g}) m with {:.3g} m^2",
                    name, f, value, surface.face_id[f], x.x, x.y, x.z, norm(area_vector(surface.x, surface.quads[f])))};
  };
  for (size_t f = 0; f < n; ++f)
    if (!std::isfinite(loads.p[f])) return bad("P", f, fmt::format("{}", loads.p[f]));
  for (size_t f = 0; f < loads.impedance.size(); ++f)
    if (!(loads.impedance[f] >= 0) || !std::isfinite(loads.impedance[f]))
      return bad("impedance", f, fmt::format("{}", loads.impedance[f]));
  for (size_t f = 0; f < loads.traction.size(); ++f)
    if (const Vec3& t = loads.traction[f]; !is_finite(t))
      return bad("traction", f, fmt::format("({}, {}, {})", t.x, t.y, t.z));
  return {};
}

}  // namespace bw::coupling
