// SPDX-License-Identifier: Apache-2.0
#include "cfd/sweep.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "cfd/embed/refill.h"
#include "common/app/error.h"
#include "common/parallel/loop.h"

namespace bw::cfd {

namespace {

/// May a fresh cell begin with this?
bool usable(const Medium& medium, const double (&U)[Cons::most]) {
  double W[Prim::most];
  const double p = std::visit([&](const auto& pair) { return pair.to_primitive(U, W, medium.floors); }, medium.mixture);
  bool finite = std::isfinite(p) && std::isfinite(W[Prim::c]);
  for (int q = 0; q < medium.rows(); ++q) finite = finite && std::isfinite(U[q]);
  for (int k = 0; k < std::max(medium.count(), 2); ++k) finite = finite && U[Cons::arho(k)] >= 0;
  return finite && medium.density(U) >= medium.floors.rho;
}

/// Is a wall near any block of the finest level in cells [first, end)?
bool any_near(const CutCells& cut, const Index3& first, const Index3& end, const Index3& block) {
  for (int k = first[2]; k < end[2]; k += block[2])
    for (int j = first[1]; j < end[1]; j += block[1])
      for (int i = first[0]; i < end[0]; i += block[0])
        if (cut.near({i, j, k})) return true;
  return false;
}

}  // namespace

Sweep::Sweep(const Forest& forest, const FlowSetup& setup, Walls* walls)
    : forest_(forest), setup_(setup), walls_(walls) {
  fit();
  spaces_.resize(size_t(thread_count()));
  for (Space& space : spaces_) {
    space.patch = Patch(forest.shape(), setup.medium.count());
    space.change = BlockChange(forest.shape(), setup.medium.count());
    space.gas.emplace(forest.shape());
    if (setup.medium.count() > 2)
      space.many = make_many_kernel(setup.medium.mixture, forest.shape());
    else
      space.mixed.emplace(forest.shape());
    if (!walls_) continue;
    if (walls_->cut()) {
      space.cut_cell.emplace(forest.finest_shape());
      space.patch.whole = true;
      continue;
    }
    space.cuts = PatchCuts(forest.finest_shape());
    for (int m = 0; m < setup.medium.count(); ++m)
      if (setup.medium.is_gas[m]) space.cut_gas[m] = make_cut_scheme(setup.medium.gas[m], forest.finest_shape(), walls_->treatment());
    space.cut_mixed = make_cut_scheme(setup.medium.mixture, forest.finest_shape(), walls_->treatment());
  }
}

void Sweep::fit() {
  const size_t n = size_t(forest_.local_blocks());
  active_.clear();
  look_ = nullptr;
  result_.assign(n, {});
  gas_before_.assign(n, 0);
  pending_.assign(n, {});
  marks_.assign(n, {});
  first_order_.assign(n, {});
  near_.assign(n, far);
  wall_.assign(n, {});
  if (walls_ && walls_->conservative()) links_.assign(n, {});
  fluxes_.fit(forest_, setup_.medium.rows());
}

bool Sweep::burns(int block) const {
  if (!setup_.burn || !setup_.burn->active(t_, t_ + dt_)) return false;
  const Vec3 lower = forest_.lower(block);
  return setup_.burn->phase(lower, lower + forest_.extent(block), t_, t_ + dt_) == Burn::Phase::during;
}

void Sweep::select(const State& s, double dt) {
  t_ = s.t, dt_ = dt;
  active_.clear();
  asks_.assign(look_ ? size_t(forest_.local_blocks()) : 0, {});
  const Gather gather(forest_, s, setup_.boundary, setup_.medium);
  share_kernels(gather);
  for (int b = 0; b < forest_.local_blocks(); ++b) {
    pending_[size_t(b)] = Booked{};
    wall_[size_t(b)] = {};
    if (!links_.empty()) links_[size_t(b)].clear();
    fluxes_.forget(b);
    if (walls_) {
      const Index3 first = forest_.first_finest(b), n = forest_.finest_cells(b),
                   end{first[0] + n[0], first[1] + n[1], first[2] + n[2]};
      const bool finest = forest_.level(b) == forest_.levels();
      // a coarser block is in metal or away from it (cfd/amr/criteria.h)
      if (const CutCells* cut = walls_->cut())
        near_[size_t(b)] = any_near(*cut, first, end, forest_.shape().n) ? near : cut->closed(first) ? metal : far;
      else
        near_[size_t(b)] = finest && !walls_->near(first) ? far
                           : (finest || walls_->map().touches(first, end)) && walls_->map().all_blocked(first, end)
                               ? metal
                           : finest ? near
                                    : far;
      if (!finest && (near_[size_t(b)] == near || (near_[size_t(b)] == far && walls_->map().holds_any(first, end))))
        throw PhysicsError(fmt::format(
            "a wall reached a block of level {}, not the finest, at t = {:.9g} s: raise fluid.amr.wall_cells",
            forest_.level(b), s.t));
      if (near_[size_t(b)] == near) active_.push_back(b);
      if (near_[size_t(b)] != far) continue;
    }
    const bool inert = s.info[size_t(b)].material >= 2;
    if (!setup_.skip_quiet || !gather.quiet(b) || (!inert && (heat_ > 0 || burns(b))))
      active_.push_back(b);
    else
      rest_at_sides(s, b, pending_[size_t(b)]);
  }
}

void Sweep::share_kernels(const Gather& gather) {
  const auto& used = forest_.shape().used;
  if (setup_.medium.count() == 1 || int(used[0]) + used[1] + used[2] < 2) return;
  const size_t local = size_t(forest_.local_blocks());
  lone_gas_.resize(local + size_t(forest_.ghost_blocks()));
  for (size_t b = 0; b < local; ++b) {
    const int m = gather.material(int(b));
    lone_gas_[b] = m != 0 && setup_.medium.is_gas[m - 1];
  }
  forest_.exchange(1, [&](int b) { return &lone_gas_[size_t(b)]; }, lone_gas_.data() + local);
}

void Sweep::match_kernels(int block, Patch& patch) const {
  if (lone_gas_.empty()) return;
  const BlockShape& s = patch.shape();
  for (int d = 0; d < 3; ++d)
    for (const int upper : {0, 1}) {
      std::array<int, 3> offset{0, 0, 0};
      offset[size_t(d)] = upper ? 1 : -1;
      const int beside = s.used[size_t(d)] ? forest_.neighbour(block, offset) : -1;
      // of faces between levels the finer side's flux is that of both
      if (beside < 0 || lone_gas_[size_t(beside)]) continue;
      int first[3] = {0, 0, 0}, last[3] = {s.n[0], s.n[1], s.n[2]};
      first[d] = upper ? s.n[size_t(d)] : -1, last[d] = first[d] + 1;
      for (int k = first[2]; k < last[2]; ++k)
        for (int j = first[1]; j < last[1]; ++j)
          std::fill_n(patch.row(Prim::shock, k, j) + first[0], last[0] - first[0], no_damping);
    }
}

/// A block at rest still leans on the sides of the domain.
void Sweep::rest_at_sides(const State& s, int block, Booked& booked) const {
  const BlockShape& shape = forest_.shape(block);
  for (int d = 0; d < 3; ++d)
    for (int upper = 0; upper < 2; ++upper) {
      if (!shape.used[d] || !forest_.at_side(block, d, upper)) continue;
      const double* U = s.info[size_t(block)].U;
      double W[Prim::most];
      std::visit([&](const auto& mix) { mix.to_primitive(U, W, setup_.medium.floors); }, setup_.medium.mixture);
      const double area =
          shape.side_volume(forest_.lower(block).x, d, upper) / shape.h[d] * (shape.cells() / shape.n[d]);
      booked.side[2 * d + upper][Cons::mom + d] += W[Prim::p] * dt_ * area;
    }
}

void Sweep::one_block(State& s, int block, bool first_order, Space& space) {
  const Gather gather(forest_, s, setup_.boundary, setup_.medium);
  const BlockShape& shape = forest_.shape(block);
  Patch& patch = space.patch;
  BlockChange& change = space.change;
  Booked& booked = pending_[size_t(block)];
  booked = Booked{};
  gather.fill(block, patch, space.ghosts);
  if (look_) {
    const Stopwatch watch(space.ghosts.seconds);
    asks_[size_t(block)] = asks_of(patch, setup_.medium, *look_, forest_.level(block), forest_.levels());
  }
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
      &setup_.medium, setup_.burn ? &*setup_.burn : nullptr, patch.material < 2 && burns(block), t_, t_ + dt_,
      first_order};
  in.heat = heat_;
  const int m = patch.material;
  const bool is_gas_block = m != 0 && setup_.medium.is_gas[m - 1];
  patch.shocked = is_gas_block && find_shocks(patch);
  if (patch.shocked) match_kernels(block, patch);
  if (in.burns) fill_stored_energy(*setup_.burn, t_ + 0.5 * dt_, patch);
  change.book_sides = 0;
  for (int d = 0; d < 3; ++d)
    for (int upper = 0; upper < 2; ++upper)
      if (shape.used[size_t(d)] && forest_.at_side(block, d, upper)) change.book_sides |= 1u << (2 * d + upper);
  change.keep_sides = fluxes_.sides(block);
  change.make_sides();
  const CutFaces* cut = near_[size_t(block)] == near && !walls_->cut() ? cut_faces(block, space) : nullptr;
  if (shape.radial()) {
    unsigned mirror = 0;
    for (int upper = 0; upper < 2; ++upper)
      if (setup_.boundary.side[upper].kind == SideKind::wall && forest_.at_side(block, 0, upper)) mirror |= 1u << upper;
    if (space.many && !is_gas_block)
      space.many->advance_radial(patch, dt_, mirror, change);
    else
      advance_radial(patch, setup_.medium, dt_, mirror, space.radial, change);
  } else if (is_gas_block)
    space.gas->advance(patch, setup_.medium.gas[m - 1], dt_, change, cut);
  else if (space.many)
    space.many->advance(patch, dt_, change, cut);
  else
    space.mixed->advance(patch, mixed_flow(setup_.medium), dt_, change, cut);
  if (near_[size_t(block)] == near) in.blocked = meet_walls(s, block, cut, space);
  if (change.keep_sides) match_levels(block, space);
  in.others_hold = m != 0 && gas_before_[size_t(block)] == m;
  marks_[size_t(block)].clear();
  result_[size_t(block)] =
      update_block(in, patch, s.block(block), change, s.spare(block), marks_[size_t(block)], booked);
  for (int side = 0; side < 6; ++side) {
    const double volume = shape.side_volume(patch.lower.x, side / 2, side % 2);
    for (int q = 0; q < change.rows; ++q) booked.side[side][q] += change.side[side][q] * volume;
  }
  booked.scaled_cells += change.scaled_cells;
  booked.updates += shape.cells();
}

void Sweep::match_levels(int block, Space& space) {
  const Stopwatch watch(space.ghosts.seconds);
  fluxes_.record(block, space.change);
  std::vector<int> rows;
  for (int q = 0; q < (is_gas(space.patch) ? int(GasCons::count) : setup_.medium.rows()); ++q)
    rows.push_back(is_gas(space.patch) ? setup_.medium.gas[space.patch.material - 1].cons_row(q) : q);
  fluxes_.correct(block, space.patch, rows, space.change);
}

const CutFaces* Sweep::cut_faces(int block, Space& space) {
  space.cuts.gather(walls_->map(), walls_->rules(), forest_.first_cell(block));
  return space.cuts.any() ? &cut_scheme(space).prepare(space.patch, space.cuts, dt_) : nullptr;
}

const uint8_t* Sweep::meet_walls(const State& s, int block, bool cut, Space& space) {
  const Index3 first = forest_.first_cell(block);
  if (walls_->cut()) {
    wall_[size_t(block)] = {};
    links_[size_t(block)].clear();
    const GasFlow& gas = setup_.medium.gas[space.patch.material - 1];
    space.cut_cell->correct(space.patch, gas, dt_, first, s.block(block), *walls_->cut(), walls_->rules(), space.change,
                            wall_[size_t(block)], links_[size_t(block)], space.blocked);
    return space.blocked.data();
  }
  if (!cut) return nullptr;
  wall_[size_t(block)] = {};
  std::vector<LinkLoad>* links = links_.empty() ? nullptr : &links_[size_t(block)];
  if (links) links->clear();
  cut_scheme(space).correct(space.change, wall_[size_t(block)], links);
  load_probes(block, space, dt_);
  space.blocked.resize(size_t(forest_.shape().cells()));
  return space.cuts.copy_blocked(space.blocked.data()) ? space.blocked.data() : nullptr;
}

/// dt: of the step that the scheme was prepared for; the walls stand where they are at its middle.
void Sweep::load_probes(int block, Space& space, double dt) {
  const Index3 first = forest_.first_cell(block);
  const Walls::Range range = walls_->probes_of(first);
  for (size_t i = range.first; i < range.last; ++i) {
    const Probe& p = walls_->probes()[i];
    const Index3 cell{p.cell[0] - first[0], p.cell[1] - first[1], p.cell[2] - first[2]};
    walls_->set_load(i, cut_scheme(space).load(cell, p.x + 0.5 * dt * p.v, p.n, p.v));
  }
}

void Sweep::measure_loads(const State& s) {
  const Gather gather(forest_, s, setup_.boundary, setup_.medium);
  parallel_for_dynamic(forest_.local_blocks(), spaces_, [&](int64_t b, Space& space) {
    if (forest_.level(int(b)) != forest_.levels()) return;
    const Index3 first = forest_.first_cell(int(b));
    if (const Walls::Range range = walls_->probes_of(first); range.first == range.last) return;
    gather.fill(int(b), space.patch, space.ghosts);
    space.cuts.gather(walls_->map(), walls_->rules(), first);
    cut_scheme(space).begin(space.patch, space.cuts, 0);
    load_probes(int(b), space, 0);
  });
}

WallExchange Sweep::wall_exchange() const {
  FixedSum sums[5];
  int64_t links = 0;
  for (int b : active_) {
    const WallExchange& one = wall_[size_t(b)];
    const double values[5] = {one.mass, one.momentum.x, one.momentum.y, one.momentum.z, one.energy};
    for (size_t i = 0; i < 5; ++i) sums[i] += values[i];
    links += one.links;
  }
  FixedSum::sum(forest_.comm(), sums);
  return {sums[0].value(), {sums[1].value(), sums[2].value(), sums[3].value()}, sums[4].value(),
          forest_.comm().sum(links)};
}

std::vector<LinkLoad> Sweep::link_loads() const {
  std::vector<LinkLoad> mine;
  for (int b : active_) mine.insert(mine.end(), links_[size_t(b)].begin(), links_[size_t(b)].end());
  return forest_.comm().size() == 1 ? mine : forest_.comm().gather_all(mine);
}

void Sweep::refill(State& s, std::vector<int>& changed, Swept& swept) {
  const Changes& changes = walls_->changes();
  if (walls_->cut())  // these cells have their gas
    for (int layer = 1; layer <= changes.layers; ++layer) walls_->accept(layer);
  if (walls_->cut() || (changes.covered.empty() && changes.fresh.empty())) return;
  const BlockShape& shape = forest_.finest_shape();
  struct Place {
    int block;
    size_t cell;
  };
  const auto place_of = [&](const Index3& c) {
    const Forest::Cell at = forest_.find_finest(c);
    BW_CHECK(at.block >= 0 && forest_.level(at.block) == forest_.levels());
    return Place{at.block, shape.at(at.k, at.j, at.i)};
  };
  const auto is_local = [&](const Index3& c) {
    const int b = forest_.find_finest(c).block;
    return b >= 0 && b < forest_.local_blocks();
  };
  std::set<int> touched;
  const auto take = [&](const Index3& c) {
    const Place at = place_of(c);
    for (int q = 0; q < s.rows(); ++q) swept.lost[q] += s.block(at.block, q)[at.cell] * shape.cell_volume();
    ++swept.covered;
    touched.insert(at.block);
  };
  for (const Index3& c : changes.covered)
    if (is_local(c)) take(c);
  for (const FreshCell& f : changes.fresh)
    if (f.held_fluid && is_local(f.cell)) take(f.cell);
  const CellReader read = [&](const Index3& c, double* U) {
    const Place at = place_of(c);
    for (int q = 0; q < s.rows(); ++q) U[q] = s.block(at.block, q)[at.cell];
  };
  for (int layer = 1; layer <= changes.layers; ++layer) {
    exchange(s);
    struct Filled {
      Index3 cell;
      double U[Cons::most];
      bool found;
    };
    std::vector<Filled> filled;
    for (const FreshCell& f : changes.fresh)
      if (f.layer == layer && is_local(f.cell)) filled.push_back({f.cell, {}, false});
    parallel_for(int64_t(filled.size()), [&](int64_t i) {
      Filled& f = filled[size_t(i)];
      f.found = cfd::refill(walls_->map(), f.cell, setup_.medium.mixture, setup_.medium.floors, read, f.U) &&
                usable(setup_.medium, f.U);
    });
    for (const Filled& f : filled) {
      const Place at = place_of(f.cell);
      if (!f.found) {  // it opens with what it held
        s.info[size_t(at.block)].material = 0;
        continue;
      }
      for (int q = 0; q < s.rows(); ++q) {
        s.block(at.block, q)[at.cell] = f.U[q];
        s.spare(at.block)[size_t(q) * size_t(shape.cells()) + at.cell] = f.U[q];  // see UpdateInput::others_hold
        swept.made[q] += f.U[q] * shape.cell_volume();
      }
      ++swept.fresh;
      touched.insert(at.block);
      note(f.U, s.info[size_t(at.block)]);
    }
    walls_->accept(layer);
  }
  changed.insert(changed.end(), touched.begin(), touched.end());
}

/// One more cell of a block: its bounds grow with it.
void Sweep::note(const double (&U)[Cons::most], BlockInfo& info) const {
  double W[Prim::most];
  std::visit([&](const auto& pair) { pair.to_primitive(U, W, setup_.medium.floors); }, setup_.medium.mixture);
  double rate = 0;
  const BlockShape& s = forest_.finest_shape();
  for (int d = 0; d < 3; ++d)
    if (s.used[size_t(d)]) rate += (std::abs(W[Prim::v + d]) + W[Prim::c]) / s.h[d];
  info.rate = std::max(info.rate, rate);
  info.at_rest = 0;
  const int material = setup_.medium.material_of(U);
  if (info.material == BlockInfo::no_fluid) info.material = material;
  if (material != info.material) info.material = 0;
}

void Sweep::run_blocks(State& s, const std::vector<int>& blocks, bool first_order) {
  std::vector<int> of_level;
  for (int level = forest_.levels(); level >= 0; --level) {  // finer ones leave their fluxes for coarser ones
    of_level.clear();
    for (int b : blocks)
      if (forest_.level(b) == level) of_level.push_back(b);
    parallel_for_dynamic(int64_t(of_level.size()), spaces_,
                         [&](int64_t i, Space& space) { one_block(s, of_level[size_t(i)], first_order, space); });
    if (level > 0) fluxes_.exchange(level);
  }
  if (walls_ && walls_->cut()) mix_cut_cells(s);
  count_bad();
}

void Sweep::count_bad() {
  int64_t bad = 0;
  for (int b : active_) bad += result_[size_t(b)].bad + (cut_bad_.empty() ? 0 : cut_bad_[size_t(b)]);
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
  std::vector<uint8_t> again(size_t(forest_.local_blocks()), 0);
  for (int b : active_) {
    bool near = marked(b);
    for (int other : forest_.around(b)) near = near || marked(other);
    again[size_t(b)] = near;
  }
  for (int b : active_) {
    // fluxes of finer neighbours may change: all that may step again are asked, other ranks' too
    bool beside = again[size_t(b)];
    for (int other : forest_.around(b)) beside = beside || forest_.level(other) > forest_.level(b);
    if (beside) blocks.push_back(b);
  }
  return blocks;
}

double Sweep::seconds_between_levels() const {
  double sum = 0;
  for (const Space& space : spaces_) sum += space.ghosts.seconds;
  return sum / double(spaces_.size());
}

void Sweep::commit(State& s) {
  stepped_ = active_.size();
  for (int b : active_) {
    s.flip(b);
    s.info[size_t(b)] = result_[size_t(b)].info;
    gas_before_[size_t(b)] = int8_t(result_[size_t(b)].gas);
  }
  for (int b = 0; walls_ && !walls_->cut() && b < forest_.local_blocks(); ++b)
    if (BlockInfo& info = s.info[size_t(b)]; near_[size_t(b)] == metal) info.material = BlockInfo::no_fluid, info.rate = info.p_max = 0;
  if (walls_ && walls_->cut()) walls_->cut()->commit();
  for (int b = 0; b < forest_.local_blocks(); ++b) s.booked[size_t(b)] += pending_[size_t(b)];
  s.t = t_ + dt_;
  ++s.step;
}

BadCell Sweep::first_bad() const {
  for (int b : active_)
    if (result_[size_t(b)].bad + (cut_bad_.empty() ? 0 : cut_bad_[size_t(b)]) > 0) return {b, result_[size_t(b)].first_bad};
  return {};
}

double Sweep::max_rate(const State& s) const {
  double rate = 0;
  for (int b = 0; b < forest_.local_blocks(); ++b) rate = std::max(rate, s.info[size_t(b)].rate);
  rate = forest_.comm().max(rate);
  if (const auto& burn = setup_.burn; burn && rate > 0 && burn->active(s.t, s.t + 1 / rate)) {
    double front = 0;
    for (int d = 0; d < 3; ++d)
      if (forest_.shape().used[d]) front += burn->c_CJ / forest_.finest_shape().h[d];
    rate = std::max(rate, front + (burn->D - burn->c_CJ) / burn->h);
  }
  return rate;
}

}  // namespace bw::cfd
