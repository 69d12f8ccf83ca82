// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/forest.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/app/error.h"

namespace bw::cfd {

namespace {

/// Relative cost per cell of blocks of n cells (measured, cfd/scheme/block_kernel.h): along x packs hang over the end,
/// once more where half steps of both neighbours are wanted, and ghosts come one by one; across it whole rows of ghosts
/// do. Beyond some thousand cells a block's patch leaves the second cache; a row alone fills none.
double block_cost(const std::array<int, 3>& n, const std::array<int, 3>& domain) {
  const auto packs = [](int cells) { return (cells + Pack::size - 1) / Pack::size * double(Pack::size); };
  double cost = n[0] == 1 ? 1 : (0.5 * (packs(n[0] + 2) + packs(n[0])) + 6) / n[0];
  for (size_t d = 1; d < 3; ++d)
    if (n[d] > 1) cost *= (n[d] + 1.5) / n[d];
  for (size_t d = 0; d < 3; ++d)
    if (domain[d] > 1) cost *= 1 + 0.125 * n[d] / domain[d];  // fewer blocks to share out and to skip
  const double cells = double(n[0]) * n[1] * n[2], fit = n[1] == 1 && n[2] == 1 ? 128 : 8192;
  return cells > fit ? cost * (1 + 0.12 * std::log2(cells / fit)) : cost;
}

uint64_t key_of(const Leaf& leaf) {
  return uint64_t(leaf.level) << 57 | uint64_t(leaf.place[2]) << 38 | uint64_t(leaf.place[1]) << 19 |
         uint64_t(leaf.place[0]);
}

Leaf parent_of(Leaf leaf) {
  --leaf.level;
  for (int& p : leaf.place) p >>= 1;
  return leaf;
}

std::vector<BlockShape> shapes_of(const GridSize& size) {
  BlockShape s;
  s.geometry = size.geometry;
  s.n = size.block;
  for (size_t d = 0; d < 3; ++d)
    if (s.n[d] == 0) s.n[d] = (size.levels > 0 ? choose_block(size.cells, size.levels) : choose_block(size.cells))[d];
  for (int d = 0; d < 3; ++d) {
    BW_CHECK(size.cells[size_t(d)] > 0 && size.upper[d] > size.lower[d]);
    BW_CHECK(s.n[size_t(d)] > 0 && size.cells[size_t(d)] % s.n[size_t(d)] == 0);
    s.used[size_t(d)] = size.cells[size_t(d)] > 1;
    s.h[d] = (size.upper[d] - size.lower[d]) / size.cells[size_t(d)];
  }
  std::vector<BlockShape> shapes{s};
  for (int l = 0; l < size.levels; ++l) {
    for (int d = 0; d < 3; ++d)
      if (s.used[size_t(d)]) s.h[d] *= 0.5;
    shapes.push_back(s);
  }
  return shapes;
}

std::array<int, 3> blocks_of(const GridSize& size, const BlockShape& s) {
  return {size.cells[0] / s.n[0], size.cells[1] / s.n[1], size.cells[2] / s.n[2]};
}

}  // namespace

std::array<int, 3> choose_block(const std::array<int, 3>& cells) {
  std::array<int, 3> best = cells;
  const auto divisors = [](int n) {
    std::vector<int> all{n};
    for (int m = 2; m < n; ++m)
      if (n % m == 0) all.push_back(m);
    return all;
  };
  for (const int x : divisors(cells[0]))
    for (const int y : divisors(cells[1]))
      for (const int z : divisors(cells[2]))
        if (block_cost({x, y, z}, cells) < block_cost(best, cells)) best = {x, y, z};
  return best;
}

std::array<int, 3> choose_block(const std::array<int, 3>& cells, int levels) {
  std::array<int, 3> n{0, 0, 0};
  for (size_t d = 0; d < 3; ++d) {
    if (cells[d] == 1) n[d] = 1;
    for (int m = 8; m <= 16 && cells[d] > 1; m += 2) {
      const auto cost = [&](int cells_along) {
        std::array<int, 3> one{1, 1, 1};
        one[d] = cells_along;
        return block_cost(one, {1, 1, 1});
      };
      if (cells[d] % m == 0 && m % (1 << levels) == 0 && (n[d] == 0 || cost(m) < cost(n[d]))) n[d] = m;
    }
  }
  return n;
}

Forest::Forest(const Comm& comm, const GridSize& size)
    : comm_(comm),
      size_(size),
      blocks_(blocks_of(size, shapes_of(size).front())),
      shapes_(shapes_of(size)),
      trees_(comm, blocks_, size.periodic, shapes_.front().used) {
  make_tables();
}

int Forest::find_leaf(const Leaf& leaf) const {
  const auto found = number_.find(key_of(leaf));
  return found == number_.end() ? -1 : found->second;
}

void Forest::make_tables() {
  ++version_;
  leaf_ = trees_.leaves();
  local_ = int(leaf_.size());
  leaf_.insert(leaf_.end(), trees_.ghosts().begin(), trees_.ghosts().end());
  number_.clear();
  number_.reserve(2 * leaf_.size());
  for (size_t b = 0; b < leaf_.size(); ++b)
    if (leaf_[b].level >= 0) number_.emplace(key_of(leaf_[b]), int(b));
  neighbours_.assign(size_t(local_) * 27, outside);
  jumps_.clear();
  at_jump_.assign(size_t(local_), 0);
  around_.clear();
  first_around_.assign(1, 0);
  for (int b = 0; b < local_; ++b) {
    for (int o = 0; o < 27; ++o)
      neighbours_[size_t(b) * 27 + size_t(o)] = connect(b, {o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1});
    std::vector<int> near;
    for (int o = 0; o < 27; ++o) {
      const int n = neighbours_[size_t(b) * 27 + size_t(o)];
      if (n >= 0) near.push_back(n);
      if (n >= outside) continue;
      at_jump_[size_t(b)] = 1;
      for (int c : jump(n).block)
        if (c >= 0) near.push_back(c);
    }
    std::sort(near.begin(), near.end());
    near.erase(std::unique(near.begin(), near.end()), near.end());
    for (int n : near)
      if (n != b) around_.push_back(n);
    first_around_.push_back(around_.size());
  }
  make_pieces();
}

void Forest::make_pieces() {
  to_.assign(size_t(comm_.size()), {});
  from_.assign(size_t(comm_.size()), {});
  std::vector<Piece> copies{size_t(ghost_blocks())};
  for (int b = 0; b < local_; ++b) {
    std::map<int, Piece> mine;  // by rank
    for (const int other : around(b)) {
      if (other < local_) continue;
      const auto piece = mine.try_emplace(trees_.ghost_rank(other - local_), Piece{b, shape().n, {0, 0, 0}}).first;
      grow(piece->second, other);
      Piece& copy = copies[size_t(other - local_)];
      if (copy.last[0] == 0) copy = {other, shape().n, {0, 0, 0}};
      grow(copy, b);
    }
    for (const auto& [rank, piece] : mine) to_[size_t(rank)].push_back(piece);
  }
  for (const Piece& copy : copies)
    if (copy.last[0] > 0) from_[size_t(trees_.ghost_rank(copy.block - local_))].push_back(copy);
  for (auto* lists : {&to_, &from_})
    for (std::vector<Piece>& list : *lists)
      for (size_t i = 1; i < list.size(); ++i) list[i].start = list[i - 1].start + list[i - 1].cells();
}

/// By the cells that a block that touches it reads, also around periodic sides: the ghosts of its own level, two coarse
/// cells for slopes at another level, or what a cell freed by a wall is extrapolated from.
void Forest::grow(Piece& piece, int reader) const {
  const int layers = levels() > 0 ? 2 * ghost_layers : 3;
  const std::array<int, 3> a = first_finest(piece.block), b = first_finest(reader), b_cells = finest_cells(reader),
                           domain = cells_of_level(levels());
  int low[3][3], high[3][3];  // by direction and how often around the domain
  for (size_t d = 0; d < 3; ++d)
    for (int turn = -1; turn <= 1; ++turn) {
      const int from = b[d] + turn * domain[d] - a[d], to = from + b_cells[d], cell = finest_cells(piece.block)[d] / shape().n[d];
      const bool counts = turn == 0 || (size_.periodic[d] && shape().used[d]);
      low[d][turn + 1] = std::max(0, from / cell - layers);
      high[d][turn + 1] = counts ? std::min(shape().n[d], to / cell + layers) : 0;
    }
  for (int image = 0; image < 27; ++image) {
    const size_t turn[3] = {size_t(image % 3), size_t(image / 3 % 3), size_t(image / 9)};
    bool some = true;
    for (size_t d = 0; d < 3; ++d) some = some && low[d][turn[d]] < high[d][turn[d]];
    for (size_t d = 0; some && d < 3; ++d) {
      piece.first[d] = std::min(piece.first[d], low[d][turn[d]]);
      piece.last[d] = std::max(piece.last[d], high[d][turn[d]]);
    }
  }
}

/// What neighbour() says.
int Forest::connect(int block, const std::array<int, 3>& offset) {
  Leaf at = leaf_[size_t(block)];
  for (size_t d = 0; d < 3; ++d) {
    if (offset[d] != 0 && !shape().used[d]) return outside;
    const int end = shape().used[d] ? blocks_[d] << at.level : 1;
    at.place[d] += offset[d];
    if (size_.periodic[d]) at.place[d] = (at.place[d] + end) % end;
    if (at.place[d] < 0 || at.place[d] >= end) return outside;
  }
  if (const int same = find_leaf(at); same >= 0) return same;
  LevelJump jump;
  if (const int coarser = at.level > 0 ? find_leaf(parent_of(at)) : -1; coarser >= 0) {
    jump.block[0] = coarser;
  } else {
    jump.finer = true;
    bool any = false;
    for (int c = 0; c < 8; ++c) {
      Leaf child{at.level + 1, {}};
      bool touches = true;
      for (size_t d = 0; d < 3; ++d) {
        const int upper = c >> d & 1;
        child.place[d] = shape().used[d] ? 2 * at.place[d] + upper : 0;
        touches = touches && (shape().used[d] ? offset[d] == 0 || upper == (offset[d] < 0) : upper == 0);
      }
      if (!touches) continue;
      jump.block[size_t(c)] = find_leaf(child);
      BW_CHECK(jump.block[size_t(c)] >= 0);
      any = true;
    }
    BW_CHECK(any);
  }
  jumps_.push_back(jump);
  return -1 - int(jumps_.size());
}

bool Forest::at_side(int block, int d, bool upper) const {
  const size_t e = size_t(d);
  const int last = (shape().used[e] ? blocks_[e] << level(block) : 1) - 1;
  return !size_.periodic[e] && place(block)[e] == (upper ? last : 0);
}

std::array<int, 3> Forest::cells_of_level(int level) const {
  std::array<int, 3> cells = size_.cells;
  for (size_t d = 0; d < 3; ++d)
    if (shape().used[d]) cells[d] <<= level;
  return cells;
}

std::array<int, 3> Forest::first_cell(int block) const {
  const auto& p = place(block);
  return {p[0] * shape().n[0], p[1] * shape().n[1], p[2] * shape().n[2]};
}

std::array<int, 3> Forest::first_finest(int block) const {
  std::array<int, 3> c = first_cell(block);
  for (size_t d = 0; d < 3; ++d)
    if (shape().used[d]) c[d] <<= levels() - level(block);
  return c;
}

std::array<int, 3> Forest::finest_cells(int block) const {
  std::array<int, 3> n = shape().n;
  for (size_t d = 0; d < 3; ++d)
    if (shape().used[d]) n[d] <<= levels() - level(block);
  return n;
}

Vec3 Forest::lower(int block) const {
  const auto c = first_cell(block);
  const Vec3& h = shape(block).h;
  return {size_.lower.x + c[0] * h.x, size_.lower.y + c[1] * h.y, size_.lower.z + c[2] * h.z};
}

Vec3 Forest::extent(int block) const {
  const BlockShape& s = shape(block);
  return {s.n[0] * s.h.x, s.n[1] * s.h.y, s.n[2] * s.h.z};
}

Forest::Cell Forest::find(const Vec3& x) const {
  std::array<int, 3> cell;
  const std::array<int, 3> end = cells_of_level(levels());
  for (int d = 0; d < 3; ++d) {
    if (x[d] < size_.lower[d] || x[d] > size_.upper[d]) return {};
    cell[size_t(d)] = std::min(int((x[d] - size_.lower[d]) / finest_shape().h[d]), end[size_t(d)] - 1);
  }
  const Cell found = find_finest(cell);
  return found.block < local_ ? found : Cell{};
}

Forest::Cell Forest::find_finest(const std::array<int, 3>& cell) const {
  std::array<int, 3> c = cell;
  for (int l = levels(); l >= 0; --l) {
    const auto& n = shape().n;
    if (const int b = find_leaf({l, {c[0] / n[0], c[1] / n[1], c[2] / n[2]}}); b >= 0)
      return {b, c[0] % n[0], c[1] % n[1], c[2] % n[2]};
    for (size_t d = 0; d < 3; ++d)
      if (shape().used[d]) c[d] >>= 1;
  }
  return {};
}

std::vector<Origin> Forest::adapt(const std::vector<int8_t>& wish) {
  trees_.adapt(wish);
  std::vector<Origin> origins;
  for (const Leaf& leaf : trees_.leaves()) {
    if (const int same = find_leaf(leaf); same >= 0 && same < local_) {
      origins.push_back({0, same});
    } else if (const int parent = leaf.level > 0 ? find_leaf(parent_of(leaf)) : -1; parent >= 0 && parent < local_) {
      int child = 0;
      for (size_t d = 3; d-- > 0;)
        if (shape().used[d]) child = 2 * child + (leaf.place[d] & 1);
      origins.push_back({1, parent, child});
    } else {
      Leaf child{leaf.level + 1, leaf.place};
      for (size_t d = 0; d < 3; ++d)
        if (shape().used[d]) child.place[d] *= 2;
      const int first = find_leaf(child);
      BW_CHECK(first >= 0 && first < local_);
      origins.push_back({-1, first});
    }
  }
  return origins;
}

bool Forest::settle() {
  const bool moved = trees_.partition();
  make_tables();
  return moved;
}

}  // namespace bw::cfd
