// SPDX-License-Identifier: Apache-2.0
#include "cfd/sweep.h"

#include <algorithm>

#include "common/parallel/loop.h"

namespace bw::cfd {

Sweep::Sweep(const Forest& forest, const FlowSetup& setup)
    : forest_(forest),
      setup_(setup),
      result_(size_t(forest.local_blocks())),
      pending_(size_t(forest.local_blocks())),
      marks_(size_t(forest.local_blocks())),
      first_order_(size_t(forest.local_blocks())) {
  spaces_.resize(size_t(thread_count()));
  for (Space& space : spaces_) {
    space.patch = Patch(forest.shape());
    space.change = BlockChange(forest.shape());
    space.gas.emplace(forest.shape());
    space.mixed.emplace(forest.shape());
  }
}

void Sweep::exchange(State& s) const {
  if (forest_.comm().size() == 1) return;
  forest_.exchange(
      s.block_size() * sizeof(double), [&](int b) { return s.block(b); }, s.ghosts());
  forest_.exchange(
      sizeof(BlockInfo), [&](int b) { return &s.info[size_t(b)]; }, &s.info[size_t(forest_.local_blocks())]);
}

bool Sweep::burns(int block) const {
  if (!setup_.burn || !setup_.burn->active(t_, t_ + dt_)) return false;
  const Vec3 lower = forest_.lower(block);
  const BlockShape& s = forest_.shape();
  const Vec3 size{s.n[0] * s.h.x, s.n[1] * s.h.y, s.n[2] * s.h.z};
  return setup_.burn->phase(lower, lower + size, t_, t_ + dt_) == Burn::Phase::during;
}

void Sweep::select(const State& s, double dt) {
  t_ = s.t, dt_ = dt;
  active_.clear();
  const Gather gather(forest_, s, setup_.boundary, setup_.medium);
  for (int b = 0; b < forest_.local_blocks(); ++b) {
    pending_[size_t(b)] = Booked{};
    const bool inert = s.info[size_t(b)].material == 2;
    if (!setup_.skip_quiet || !gather.quiet(b) || (!inert && burns(b)))
      active_.push_back(b);
    else
      rest_at_sides(s, b, pending_[size_t(b)]);
  }
}

/// A block at rest still leans on the sides of the domain.
void Sweep::rest_at_sides(const State& s, int block, Booked& booked) const {
  const BlockShape& shape = forest_.shape();
  for (int d = 0; d < 3; ++d)
    for (int upper = 0; upper < 2; ++upper) {
      if (!shape.used[d] || !forest_.at_side(block, d, upper)) continue;
      double U[Cons::count], W[Prim::stored];
      std::copy_n(s.info[size_t(block)].U, int(Cons::count), U);
      std::visit([&](const auto& pair) { pair.to_primitive(U, W, setup_.medium.floors); }, setup_.medium.mixture);
      const double area = shape.cell_volume() / shape.h[d] * (shape.cells() / shape.n[d]);
      booked.side[2 * d + upper][Cons::mom + d] += W[Prim::p] * dt_ * area;
    }
}

void Sweep::one_block(State& s, int block, bool first_order, Space& space) {
  const Gather gather(forest_, s, setup_.boundary, setup_.medium);
  const BlockShape& shape = forest_.shape();
  Patch& patch = space.patch;
  BlockChange& change = space.change;
  Booked& booked = pending_[size_t(block)];
  booked = Booked{};
  gather.fill(block, patch);
  if (first_order)
    gather.fill_order(
        block,
        [&](int b) -> const uint8_t* {
          const size_t local = size_t(forest_.local_blocks());
          if (size_t(b) >= local) return &ghost_marks_[(size_t(b) - local) * size_t(shape.cells())];
          return first_order_[size_t(b)].empty() ? nullptr : first_order_[size_t(b)].data();
        },
        patch);
  UpdateInput in{
      &setup_.medium, setup_.burn ? &*setup_.burn : nullptr, patch.material != 2 && burns(block), t_, t_ + dt_,
      first_order};
  if (in.burns) fill_stored_energy(*setup_.burn, t_ + 0.5 * dt_, patch);
  change.book_sides = 0;
  for (int d = 0; d < 3; ++d)
    for (int upper = 0; upper < 2; ++upper)
      if (forest_.at_side(block, d, upper)) change.book_sides |= 1u << (2 * d + upper);
  const int m = patch.material;
  if (m != 0 && setup_.medium.is_gas[m - 1])
    space.gas->advance(patch, setup_.medium.gas[m - 1], dt_, change);
  else
    space.mixed->advance(patch, MixedFlow{setup_.medium.closure}, dt_, change);
  marks_[size_t(block)].clear();
  result_[size_t(block)] =
      update_block(in, patch, s.block(block), change, s.spare(block), marks_[size_t(block)], booked);
  for (int side = 0; side < 6; ++side)
    for (int q = 0; q < Cons::count; ++q) booked.side[side][q] += change.side[side][q] * shape.cell_volume();
  booked.scaled_cells += change.scaled_cells;
  booked.updates += shape.cells();
}

void Sweep::run_blocks(State& s, const std::vector<int>& blocks, bool first_order) {
  parallel_for_dynamic(int64_t(blocks.size()), spaces_,
                       [&](int64_t i, Space& space) { one_block(s, blocks[size_t(i)], first_order, space); });
  count_bad();
}

void Sweep::count_bad() {
  int64_t bad = 0;
  for (int b : active_) bad += result_[size_t(b)].bad;
  bad_ = forest_.comm().sum(bad);
}

void Sweep::advance(State& s) {
  for (auto& m : first_order_) m.clear();
  run_blocks(s, active_, false);
}

void Sweep::repeat_first_order(State& s) {
  const size_t cells = size_t(forest_.shape().cells());
  for (int b : active_) {
    auto& marks = marks_[size_t(b)];
    auto& kept = first_order_[size_t(b)];
    if (marks.empty()) continue;
    if (kept.empty()) kept.assign(cells, 0);
    for (size_t c = 0; c < cells; ++c) kept[c] |= marks[c];
  }
  ghost_marks_.assign(size_t(forest_.ghost_blocks()) * cells, 0);
  const std::vector<uint8_t> none(cells, 0);
  forest_.exchange(
      cells, [&](int b) { return first_order_[size_t(b)].empty() ? none.data() : first_order_[size_t(b)].data(); },
      ghost_marks_.data());
  const std::vector<int> again = around_marked();
  run_blocks(s, again, true);
  for (int b : again)
    if (!first_order_[size_t(b)].empty())
      pending_[size_t(b)].first_order += std::count(first_order_[size_t(b)].begin(), first_order_[size_t(b)].end(), 1);
}

/// Blocks that hold a marked cell or touch one that does; all of them are active, for nothing bad happens at rest.
std::vector<int> Sweep::around_marked() const {
  const size_t cells = size_t(forest_.shape().cells());
  const auto marked = [&](int b) {
    if (b < forest_.local_blocks()) return !first_order_[size_t(b)].empty();
    const auto from = ghost_marks_.begin() + ptrdiff_t((size_t(b) - size_t(forest_.local_blocks())) * cells);
    return std::find(from, from + ptrdiff_t(cells), 1) != from + ptrdiff_t(cells);
  };
  std::vector<int> blocks;
  for (int b : active_) {
    bool near = false;
    for (int o = 0; o < 27 && !near; ++o) {
      const int other = forest_.neighbour(b, {o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1});
      near = other >= 0 && marked(other);
    }
    if (near) blocks.push_back(b);
  }
  return blocks;
}

void Sweep::commit(State& s) {
  for (int b : active_) {
    s.flip(b);
    s.info[size_t(b)] = result_[size_t(b)].info;
  }
  for (int b = 0; b < forest_.local_blocks(); ++b) s.booked[size_t(b)] += pending_[size_t(b)];
  s.t = t_ + dt_;
  ++s.step;
}

BadCell Sweep::first_bad() const {
  for (int b : active_)
    if (result_[size_t(b)].bad > 0) return {b, result_[size_t(b)].first_bad};
  return {};
}

double Sweep::max_rate(const State& s) const {
  double rate = 0;
  for (int b = 0; b < forest_.local_blocks(); ++b) rate = std::max(rate, s.info[size_t(b)].rate);
  rate = forest_.comm().max(rate);
  if (const auto& burn = setup_.burn; burn && rate > 0 && burn->active(s.t, s.t + 1 / rate)) {
    double front = 0;
    for (int d = 0; d < 3; ++d)
      if (forest_.shape().used[d]) front += burn->c_CJ / forest_.shape().h[d];
    rate = std::max(rate, front + (burn->D - burn->c_CJ) / burn->h);
  }
  return rate;
}

}  // namespace bw::cfd
