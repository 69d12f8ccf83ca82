// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/trees.h"

#include <p8est_bits.h>
#include <p8est_communication.h>
#include <p8est_extended.h>
#include <p8est_ghost.h>

#include <algorithm>
#include <cmath>

#include "common/app/error.h"

namespace bw::cfd {

namespace {

std::array<int, 3> place_of_tree(const p8est_connectivity_t* c, p4est_topidx_t tree) {
  const double* corner = c->vertices + 3 * c->tree_to_vertex[size_t(tree) * P8EST_CHILDREN];
  return {int(std::lround(corner[0])), int(std::lround(corner[1])), int(std::lround(corner[2]))};
}

/// libsc and p4est want to be told once per process, and to leave signals alone. Collective over comm: the world may
/// hold another program, which would never come.
void start_p4est(const Comm& comm) {
  static const bool started = [&] {
    sc_init(comm.raw(), 0, 0, nullptr, SC_LP_ERROR);
    p4est_init(nullptr, SC_LP_ERROR);
    return true;
  }();
  (void)started;
}

/// What p4est's callbacks see of the directions in use.
struct Callbacks {
  std::array<bool, 3> used;
};
bool carries(const p8est_t* f, const p8est_quadrant_t* q) {
  const auto& used = static_cast<const Callbacks*>(f->user_pointer)->used;
  return (used[0] || q->x == 0) && (used[1] || q->y == 0) && (used[2] || q->z == 0);
}
int wants_split(p8est_t* f, p4est_topidx_t, p8est_quadrant_t* q) { return carries(f, q) && q->p.user_int == 1; }
int wants_join(p8est_t* f, p4est_topidx_t, p8est_quadrant_t** family) {
  for (int c = 0; c < P8EST_CHILDREN; ++c)
    if (carries(f, family[c]) && family[c]->p.user_int != -1) return 0;
  return 1;
}
void no_wish(p8est_t*, p4est_topidx_t, p8est_quadrant_t* q) { q->p.user_int = 0; }
int weight(p8est_t* f, p4est_topidx_t, p8est_quadrant_t* q) { return carries(f, q); }

template <class Visit>
void for_each_leaf(p8est_t* f, const Visit& visit) {
  if (f->local_num_quadrants == 0) return;
  for (p4est_topidx_t t = f->first_local_tree; t <= f->last_local_tree; ++t) {
    sc_array_t* quadrants = &p8est_tree_array_index(f->trees, t)->quadrants;
    for (size_t i = 0; i < quadrants->elem_count; ++i) visit(t, p8est_quadrant_array_index(quadrants, i));
  }
}

Leaf leaf_of(const p8est_t* f, p4est_topidx_t tree, const p8est_quadrant_t* q) {
  if (!carries(f, q)) return {-1, {}};
  Leaf leaf{q->level, place_of_tree(f->connectivity, tree)};
  const p4est_qcoord_t corner[3] = {q->x, q->y, q->z};
  for (size_t d = 0; d < 3; ++d)
    leaf.place[d] = (leaf.place[d] << q->level) + (corner[d] >> (P8EST_MAXLEVEL - q->level));
  return leaf;
}

}  // namespace

struct Trees::P4est {
  p8est_connectivity_t* connectivity = nullptr;
  p8est_t* forest = nullptr;
  p8est_ghost_t* ghost = nullptr;
  Callbacks callbacks;
  ~P4est() {
    if (ghost) p8est_ghost_destroy(ghost);
    if (forest) p8est_destroy(forest);
    if (connectivity) p8est_connectivity_destroy(connectivity);
  }
};

Trees::Trees(const Comm& comm, const std::array<int, 3>& blocks, const std::array<bool, 3>& periodic,
             const std::array<bool, 3>& used)
    : comm_(comm), blocks_(blocks), used_(used), p4est_(new P4est) {
  start_p4est(comm);
  p4est_->callbacks = {used};
  p4est_->connectivity = p8est_connectivity_new_brick(blocks[0], blocks[1], blocks[2], periodic[0] && used[0],
                                                      periodic[1] && used[1], periodic[2] && used[2]);
  p4est_->forest = p8est_new_ext(comm.raw(), p4est_->connectivity, 0, 0, 1, 0, no_wish, &p4est_->callbacks);
  read_leaves();
  read_ghosts();
}

Trees::~Trees() = default;

void Trees::read_leaves() {
  leaves_.clear();
  for_each_leaf(p4est_->forest, [&](p4est_topidx_t tree, const p8est_quadrant_t* q) {
    if (const Leaf leaf = leaf_of(p4est_->forest, tree, q); leaf.level >= 0) leaves_.push_back(leaf);
  });
  first_.assign(1, 0);
  for (const int64_t n : comm_.gather_one(int64_t(leaves_.size()))) first_.push_back(first_.back() + n);
}

void Trees::read_ghosts() {
  ghosts_.clear();
  mirrors_.clear();
  if (comm_.size() == 1) return;
  p8est_t* f = p4est_->forest;
  if (p4est_->ghost) p8est_ghost_destroy(p4est_->ghost);
  p8est_ghost_t* g = p4est_->ghost = p8est_ghost_new(f, P8EST_CONNECT_FULL);
  for (size_t i = 0; i < g->ghosts.elem_count; ++i) {
    const p8est_quadrant_t* q = p8est_quadrant_array_index(&g->ghosts, i);
    ghosts_.push_back(leaf_of(f, q->p.piggy3.which_tree, q));
  }
  std::vector<int> number;  // of every local leaf among those that carry a block
  int next = 0;
  for_each_leaf(f, [&](p4est_topidx_t, const p8est_quadrant_t* q) { number.push_back(carries(f, q) ? next++ : -1); });
  for (size_t i = 0; i < g->mirrors.elem_count; ++i)
    mirrors_.push_back(number[size_t(p8est_quadrant_array_index(&g->mirrors, i)->p.piggy3.local_num)]);
}

int Trees::ghost_rank(int i) const {
  const p4est_locidx_t* first = p4est_->ghost->proc_offsets;
  return int(std::upper_bound(first, first + comm_.size() + 1, i) - first) - 1;
}

void Trees::adapt(const std::vector<int8_t>& wish) {
  p8est_t* f = p4est_->forest;
  size_t next = 0;
  for_each_leaf(f, [&](p4est_topidx_t, p8est_quadrant_t* q) { q->p.user_int = carries(f, q) ? wish[next++] : 0; });
  BW_CHECK(next == wish.size());
  p8est_refine_ext(f, 0, P8EST_QMAXLEVEL, wants_split, no_wish, nullptr);
  p8est_coarsen_ext(f, 0, 0, wants_join, no_wish, nullptr);
  p8est_balance_ext(f, P8EST_CONNECT_FULL, no_wish, nullptr);
  read_leaves();
}

bool Trees::partition() {
  first_before_ = first_;
  p8est_partition_ext(p4est_->forest, 1, weight);
  read_leaves();
  read_ghosts();
  return first_ != first_before_;
}

void Trees::transfer(size_t bytes, const void* from, void* to) const {
  const std::vector<p4est_gloidx_t> after(first_.begin(), first_.end()),
      before(first_before_.begin(), first_before_.end());
  p8est_transfer_fixed(after.data(), before.data(), comm_.raw(), 0, to, from, bytes);
}

void Trees::exchange(int lowest, int highest, size_t bytes, std::vector<void*>& mirror, void* ghosts) const {
  p8est_ghost_exchange_custom_levels(p4est_->forest, p4est_->ghost, lowest, highest, bytes, mirror.data(), ghosts);
}

}  // namespace bw::cfd
