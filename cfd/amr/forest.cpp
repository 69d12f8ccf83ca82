// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/forest.h"

#include <p8est_bits.h>
#include <p8est_extended.h>
#include <p8est_ghost.h>

#include <cmath>
#include <map>

#include "common/app/error.h"

namespace bw::cfd {

namespace {

/// Relative cost per cell of blocks that are n long in a direction; x runs along packs.
double block_cost(int n, bool x) {
  const double width = x ? double((n + Pack::size - 1) / Pack::size * Pack::size) / n : 1.0;  // hanging packs
  const double ghosts = (n + 2.5) / n;  // gather and half steps of neighbours' cells
  const double cache = n > 32 ? 1 + 0.2 * std::log2(n / 32.0) : 1.0;
  const double threads = n > 16 ? 1 + 0.02 * (n - 16) / 16.0 : 1.0;  // fewer blocks to share out and to skip
  return width * ghosts * cache * threads;
}

struct TreePlace {
  int x, y, z;
};
TreePlace place_of_tree(const p8est_connectivity_t* c, p4est_topidx_t tree) {
  const double* corner = c->vertices + 3 * c->tree_to_vertex[size_t(tree) * P8EST_CHILDREN];
  return {int(std::lround(corner[0])), int(std::lround(corner[1])), int(std::lround(corner[2]))};
}

/// libsc and p4est want to be told once per process, and to leave signals alone. Collective over comm: the world may hold another
/// program, which would never come.
void start_p4est(const Comm& comm) {
  static const bool started = [&] {
    sc_init(comm.raw(), 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    return true;
  }();
  (void)started;
}

}  // namespace

std::array<int, 3> choose_block(const std::array<int, 3>& cells) {
  std::array<int, 3> n;
  for (int d = 0; d < 3; ++d) {
    n[d] = cells[d];
    for (int m = 2; m < cells[d]; ++m)
      if (cells[d] % m == 0 && block_cost(m, d == 0) < block_cost(n[d], d == 0)) n[d] = m;
  }
  return n;
}

struct Forest::Trees {
  p8est_connectivity_t* connectivity = nullptr;
  p8est_t* forest = nullptr;
  p8est_ghost_t* ghost = nullptr;
  ~Trees() {
    if (ghost) p8est_ghost_destroy(ghost);
    if (forest) p8est_destroy(forest);
    if (connectivity) p8est_connectivity_destroy(connectivity);
  }
};

Forest::Forest(const Comm& comm, const GridSize& size) : comm_(comm), size_(size), trees_(new Trees) {
  shape_.n = choose_block(size.cells);
  for (int d = 0; d < 3; ++d) {
    BW_CHECK(size.cells[d] > 0 && size.upper[d] > size.lower[d]);
    shape_.used[d] = size.cells[d] > 1;
    shape_.h[d] = (size.upper[d] - size.lower[d]) / size.cells[d];
    blocks_[d] = size.cells[d] / shape_.n[d];
  }
  start_p4est(comm);
  trees_->connectivity = p8est_connectivity_new_brick(blocks_[0], blocks_[1], blocks_[2], size.periodic[0],
                                                      size.periodic[1], size.periodic[2]);
  trees_->forest = p8est_new_ext(comm.raw(), trees_->connectivity, 0, 0, 1, 0, nullptr, nullptr);
  const p8est_t* f = trees_->forest;
  local_ = f->local_num_quadrants;
  first_global_ = f->global_first_quadrant[comm.rank()];
  for (p4est_topidx_t t = f->first_local_tree; t <= f->last_local_tree && local_ > 0; ++t) {
    const TreePlace p = place_of_tree(trees_->connectivity, t);
    place_.push_back({p.x, p.y, p.z});
  }
  BW_CHECK(int(place_.size()) == local_);
  if (comm.size() > 1) {
    trees_->ghost = p8est_ghost_new(trees_->forest, P8EST_CONNECT_FULL);
    const p8est_ghost_t* g = trees_->ghost;
    for (size_t i = 0; i < g->ghosts.elem_count; ++i) {
      const auto* q = p8est_quadrant_array_index(const_cast<sc_array_t*>(&g->ghosts), i);
      const TreePlace p = place_of_tree(trees_->connectivity, q->p.piggy3.which_tree);
      place_.push_back({p.x, p.y, p.z});
    }
    for (size_t i = 0; i < g->mirrors.elem_count; ++i)
      mirrors_.push_back(p8est_quadrant_array_index(const_cast<sc_array_t*>(&g->mirrors), i)->p.piggy3.local_num);
  }
  make_neighbours();
}

Forest::~Forest() = default;

void Forest::make_neighbours() {
  std::map<std::array<int, 3>, int> at;
  for (size_t b = 0; b < place_.size(); ++b) at.emplace(place_[b], int(b));
  neighbours_.assign(size_t(local_) * 27, -1);
  for (int b = 0; b < local_; ++b)
    for (int o = 0; o < 27; ++o) {
      const int offset[3] = {o % 3 - 1, o / 3 % 3 - 1, o / 9 - 1};
      std::array<int, 3> p = place_[size_t(b)];
      bool inside = true;
      for (int d = 0; d < 3; ++d) {
        p[d] += offset[d];
        if (size_.periodic[d]) p[d] = (p[d] + blocks_[d]) % blocks_[d];
        inside = inside && p[d] >= 0 && p[d] < blocks_[d];
      }
      if (!inside) continue;
      const auto found = at.find(p);
      BW_CHECK(found != at.end());
      neighbours_[size_t(b) * 27 + size_t(o)] = found->second;
    }
}

std::array<int, 3> Forest::first_cell(int block) const {
  const auto& p = place(block);
  return {p[0] * shape_.n[0], p[1] * shape_.n[1], p[2] * shape_.n[2]};
}

Vec3 Forest::lower(int block) const {
  const auto c = first_cell(block);
  return {size_.lower.x + c[0] * shape_.h.x, size_.lower.y + c[1] * shape_.h.y, size_.lower.z + c[2] * shape_.h.z};
}

Forest::Cell Forest::find(const Vec3& x) const {
  int cell[3], block[3];
  for (int d = 0; d < 3; ++d) {
    if (x[d] < size_.lower[d] || x[d] > size_.upper[d]) return {};
    cell[d] = std::min(int((x[d] - size_.lower[d]) / shape_.h[d]), size_.cells[d] - 1);
    block[d] = cell[d] / shape_.n[d];
  }
  for (int b = 0; b < local_; ++b)
    if (place_[size_t(b)] == std::array<int, 3>{block[0], block[1], block[2]})
      return {b, cell[0] % shape_.n[0], cell[1] % shape_.n[1], cell[2] % shape_.n[2]};
  return {};
}

void Forest::exchange_bytes(size_t bytes, std::vector<void*>& mirror, void* ghosts) const {
  p8est_ghost_exchange_custom(trees_->forest, trees_->ghost, bytes, mirror.data(), ghosts);
}

}  // namespace bw::cfd
