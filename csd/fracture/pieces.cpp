// SPDX-License-Identifier: Apache-2.0
#include "csd/fracture/pieces.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/math/random.h"
#include "csd/fracture/cut.h"
#include "csd/load/sets.h"
#include "csd/mesh/hex.h"

namespace bw::csd {

using std::numbers::pi;

namespace {

constexpr int least_elements = 4;  // VALIDATION C.4

Vec3 centre_of(const Mesh& mesh, ElemId e) {
  Vec3 c;
  for (const NodeId n : mesh.hex[e]) c += 0.125 * mesh.X[n];
  return c;
}

}  // namespace

Pieces::Pieces(const PiecesInput& input, const Mesh& mesh)
    : input_(input),
      frame_(input.axis, input.point),
      volume_(size_t(mesh.elem_count())),
      place_(size_t(mesh.elem_count()), -1),
      bin_(size_t(mesh.elem_count()), -1),
      seen_(size_t(mesh.elem_count()), 0),
      let_go_(size_t(mesh.elem_count()), 0) {
  Field<char, ElemId> is_exempt(size_t(mesh.elem_count()), 0);
  for (const std::string& name : input.exempt)
    for (const ElemId e : elem_set(mesh, name, input.place)) is_exempt[e] = 1;
  Field<double, ElemId> z(size_t(mesh.elem_count()));
  for (int32_t i = 0; i < mesh.elem_count(); ++i) {
    const ElemId e(i);
    volume_[e] = hex_volume(corners(mesh.hex[e], mesh.X)).volume;
    z[e] = frame_.along(centre_of(mesh, e));
    const bool is_inside = input.range.empty() || (z[e] >= input.range[0] && z[e] <= input.range[1]);
    if (is_inside && !is_exempt[e]) order_.push_back(e);
  }
  std::sort(order_.begin(), order_.end(), [&](ElemId a, ElemId b) {
    if (mesh.body[a] != mesh.body[b]) return mesh.body[a] < mesh.body[b];
    return z[a] != z[b] ? z[a] < z[b] : mesh.elem_gid[a] < mesh.elem_gid[b];
  });
  z_.resize(order_.size());
  for (size_t p = 0; p < order_.size(); ++p) {
    place_[order_[p]] = int32_t(p), z_[p] = z[order_[p]];
    if (p == 0 || mesh.body[order_[p]] != mesh.body[order_[p - 1]]) edges_.insert(int32_t(p));
  }
  edges_.insert(int32_t(order_.size()));
}

int64_t Pieces::advance(Mesh& mesh, Topology& topology, double t, std::span<const ElemId> broken,
                        std::span<const double> fail, const Sampler& sample, std::vector<NodeSplit>& splits,
                        std::vector<ElemId>& changed, std::vector<ElemId>& taken, const IsWhole& is_whole) {
  ++step_;
  int64_t opened = 0;
  for (const ElemId e : broken)  // step 1
    if (is_free(e) && seen_[e] != step_)
      opened += examine(mesh, topology, t, e, fail, sample, splits, changed, taken, is_whole);
  return opened;
}

/// Steps 2 to 7 for the rings around an element.
int64_t Pieces::examine(Mesh& mesh, Topology& topology, double t, ElemId worst, std::span<const double> fail,
                        const Sampler& sample, std::vector<NodeSplit>& splits, std::vector<ElemId>& changed,
                        std::vector<ElemId>& taken, const IsWhole& is_whole) {
  const Range gap = gap_around(place_[worst]);
  const double z = z_[size_t(place_[worst])], extent = frame_.extent(corners(mesh.hex[worst], mesh.X));
  const Range near = between(gap, z - extent, z + extent);
  const RingState here = ring_state(near, sample);
  mark(near, seen_);
  const double x0 = here.speed > input_.least_speed ? width(input_.law, here) : 0;  // step 2, eq (17)
  if (!(x0 > 0)) {
    mark(near, let_go_);
    return 0;
  }
  const double l0 = 4 * x0, shortest = input_.shortest * x0;  // step 3
  // a remainder too short for a piece above or below belongs to the ring on the other side
  double start = z - 1e-3 * extent;  // the element's own layer is above, whatever the round-off of its members
  const double first = z_[size_t(gap.first)], last = z_[size_t(gap.last) - 1];
  if (last - start < shortest)
    start = last + 1e-3 * extent;
  else if (start - first < shortest)
    start = first;
  int64_t opened = 0;
  for (const bool is_top : {true, false}) {
    const Range ring = is_top ? between(gap, start, start + l0) : between(gap, start - l0, start);
    if (ring.size() == 0) continue;
    mark(ring, seen_);
    if (ring.size() < least_elements) {
      mark(ring, let_go_);
      continue;
    }
    if (mean_fail(ring, fail) < 1) continue;  // steps 4 and 5: it waits
    const RingState state = ring_state(ring, sample);
    if (!(state.speed > input_.least_speed && width(input_.law, state) > 0)) {
      mark(ring, let_go_);
      continue;
    }
    const std::vector<ElemId> row = make_row(mesh, topology, t, worst, gap, start, is_top, state, is_whole);
    opened += cut_between(mesh, topology, bin_, row, splits, changed);  // step 7
    taken.insert(taken.end(), row.begin(), row.end());
  }
  return opened;
}

/// Steps 6 and 7: the elements of a new row, in their bins; none where nothing is left to break.
std::vector<ElemId> Pieces::make_row(const Mesh& mesh, const Topology& topology, double t, ElemId worst, Range gap,
                                     double start, bool is_top, const RingState& state, const IsWhole& is_whole) {
  const auto random = [&](uint64_t k) {
    return uniform01(uint64_t(input_.seed), uint64_t(mesh.elem_gid[worst]), 3 * rows_.size() + k);
  };
  const auto ratio = [&](uint64_t k) { return input_.shortest + (input_.longest - input_.shortest) * random(k); };
  Row row;
  row.t = t, row.state = state, row.body = mesh.body[worst];
  row.width = width(input_.law, state);  // eq (17)
  row.ratio = ratio(0);
  const double length = row.ratio * row.width, rest = 0.5 * input_.shortest * row.width;
  Range range = is_top ? between(gap, start, start + length) : between(gap, start - length, start);
  const double left = is_top ? z_[size_t(gap.last) - 1] - (start + length) : (start - length) - z_[size_t(gap.first)];
  if (left < rest) (is_top ? range.last : range.first) = is_top ? gap.last : gap.first;
  std::vector<ElemId> elems;
  std::copy_if(order_.begin() + range.first, order_.begin() + range.last, std::back_inserter(elems),
               [&](ElemId e) { return !is_whole(e); });
  if (elems.empty()) {
    mark(range, let_go_);
    return {};
  }
  row.lower = z_[size_t(range.first)], row.upper = z_[size_t(range.last) - 1], row.elements = int(elems.size());
  row.around = std::max(1, int(std::lround(2 * pi * state.radius / row.width)));
  const BinShape shape = measure(mesh, frame_, volume_, elems);
  row.across = row.width / (shape.angle * state.radius);
  // the wall has become thinner as its radius grew
  const double thinning = shape.radius / state.radius;
  if (input_.layers) row.layers = layers(shape.thickness * thinning, shape.depth * thinning, row.width / ratio(2));
  row.first_bin = bin_count_;
  assign_bins(mesh, frame_, shape, row.around, row.layers, random(1), row.first_bin, elems, bin_);
  join_strays(topology, volume_, elems, bin_);
  row.bins = number_densely(elems, row.first_bin, bin_);
  bin_count_ += row.bins;
  edges_.insert({range.first, range.last});
  rows_.push_back(row);
  return elems;
}

RingState Pieces::ring_state(Range range, const Sampler& sample) const {
  RingState s;
  double mass = 0;
  for (const RingSample& a : sample({order_.data() + range.first, size_t(range.size())})) {
    mass += a.mass;
    s.radius += a.mass * a.radius, s.speed += a.mass * a.speed, s.stress += a.mass * a.stress,
        s.density += a.mass * a.density;
  }
  s.radius /= mass, s.speed /= mass, s.stress /= mass, s.density /= mass;
  return s;
}

double Pieces::mean_fail(Range range, std::span<const double> fail) const {
  double sum = 0, volume = 0;
  for (int32_t p = range.first; p < range.last; ++p) {
    const ElemId e = order_[size_t(p)];
    sum += volume_[e] * fail[size_t(e)];
    volume += volume_[e];
  }
  return sum / volume;
}

/// The free elements of one body around a place, up to the next row or the end.
Pieces::Range Pieces::gap_around(int32_t place) const {
  const auto after = edges_.upper_bound(place);
  return {*std::prev(after), *after};
}

/// Those of a gap with lower <= z < upper.
Pieces::Range Pieces::between(Range gap, double lower, double upper) const {
  const auto begin = z_.begin() + gap.first, end = z_.begin() + gap.last;
  const auto first = std::lower_bound(begin, end, lower);
  return {int32_t(first - z_.begin()), int32_t(std::lower_bound(first, end, upper) - z_.begin())};
}

void Pieces::mark(Range range, Field<int32_t, ElemId>& step) {
  for (int32_t p = range.first; p < range.last; ++p) step[order_[size_t(p)]] = step_;
}

}  // namespace bw::csd
