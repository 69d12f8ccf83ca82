// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/transfer.h"

#include <cstring>

#include "cfd/amr/levels.h"
#include "common/parallel/loop.h"

namespace bw::cfd {

namespace {

/// What energy per mass is stored at the centre of a block's cell.
class Stored {
 public:
  Stored(const Burn* burn, double t) : burn_(burn && t > burn->start && t < burn->t_all ? burn : nullptr), t_(t) {}
  bool any() const { return burn_ != nullptr; }
  double at(const Vec3& lower, const Vec3& h, int k, int j, int i) const {
    return burn_ ? burn_->stored(lower + Vec3{(i + 0.5) * h.x, (j + 0.5) * h.y, (k + 0.5) * h.z}, t_) : 0;
  }

 private:
  const Burn* burn_;
  double t_;
};

struct Space {
  Patch patch;
  LevelGhosts ghosts;
};

/// The children of one block.
struct Split {
  int old = 0;
  std::array<double*, 8> to{};
};
/// The parent of blocks old, old + 1 ...
struct Join {
  int old = 0;
  double* to = nullptr;
};

class Transfer {
 public:
  Transfer(const Forest& forest, const TransferInput& in, const State& state)
      : forest_(forest), in_(in), state_(state), stored_(in.burn, state.t), cells_(size_t(forest.shape().cells())) {}

  void split(const Split& job, Space& space) const {
    const Gather gather(forest_, state_, in_.boundary, in_.medium);
    if (space.patch.pitch() == 0) space.patch = Patch(forest_.shape(), in_.medium.count());
    gather.fill(job.old, space.patch, space.ghosts, true);
    std::visit([&](const auto& mix) { split_cells(mix, job, space.patch); }, in_.medium.mixture);
  }

  void join(const Join& job) const {
    const BlockShape &s = forest_.shape(), &fine = forest_.shape(job.old);
    Vec3 h = fine.h;
    for (int d = 0; d < 3; ++d)
      if (s.used[size_t(d)]) h[d] *= 2;
    const Vec3 lower = forest_.lower(job.old);
    for_each_child(s, [&](int child, const int(&offset)[3], const int(&)[3]) {
      const int b = job.old + child;
      int first[3], count[3], step[3];
      for (int d = 0; d < 3; ++d) {
        const size_t e = size_t(d);
        step[d] = s.used[e] ? 2 : 1, count[d] = s.n[e] / step[d], first[d] = offset[d] * count[d];
      }
      for (int k = 0; k < count[2]; ++k)
        for (int j = 0; j < count[1]; ++j)
          for (int i = 0; i < count[0]; ++i) {
            const int f[3] = {step[0] * i, step[1] * j, step[2] * k};
            const int c[3] = {first[0] + i, first[1] + j, first[2] + k};
            double* out = job.to + s.at(c[2], c[1], c[0]);
            for (int q = 0; q < state_.rows(); ++q)
              out[size_t(q) * cells_] = mean_of_children(state_.block(b, q), s, f[2], f[1], f[0]);
            if (stored_.any())
              out[size_t(Cons::rhoE) * cells_] += stored_above(b, f, stored_.at(lower, h, c[2], c[1], c[0]));
          }
    });
  }

 private:
  /// Mean over the finer cells of (what they store - per_mass) times their density of material 1.
  double stored_above(int b, const int (&f)[3], double per_mass) const {
    const BlockShape& s = forest_.shape(b);
    double sum = 0;
    for_each_child(s, [&](int, const int(&o)[3], const int(&)[3]) {
      const int k = f[2] + o[2], j = f[1] + o[1], i = f[0] + o[0];
      sum += (stored_.at(forest_.lower(b), s.h, k, j, i) - per_mass) * state_.block(b, Cons::arho1)[s.at(k, j, i)];
    });
    return sum / child_count(s);
  }

  template <class Mix>
  void split_cells(const Mix& mix, const Split& job, const Patch& patch) const {
    const BlockShape& s = patch.shape();
    Vec3 h = s.h;
    for (int d = 0; d < 3; ++d)
      if (s.used[size_t(d)]) h[d] *= 0.5;
    const Vec3 lower = forest_.lower(job.old);
    const ptrdiff_t step[3] = {1, patch.stride_j(), patch.stride_k()}, row = patch.stride_variable();
    const auto read = [&](const double* p, double* W) {
      for (int q = 0; q < Prim::stored; ++q) W[q] = p[q * row];
      for (int q = Prim::two_rows; q < Mix::n_prim; ++q) W[q] = p[q * row];
    };
    for (int k = 0; k < s.n[2]; ++k)
      for (int j = 0; j < s.n[1]; ++j)
        for (int i = 0; i < s.n[0]; ++i) {
          double U[Mix::n_cons], W[Mix::n_prim], out[8][Mix::n_cons], more[8] = {};
          for (int q = 0; q < Mix::n_cons; ++q) U[q] = state_.block(job.old, q)[s.at(k, j, i)];
          const double* here = patch.row(0, k, j) + i;
          read(here, W);
          CellSlopes<Mix::materials> slopes;
          for (int d = 0; d < 3; ++d) {
            if (!s.used[size_t(d)]) continue;
            double below[Mix::n_prim], above[Mix::n_prim];
            read(here - step[d], below), read(here + step[d], above);
            slopes.set(d, below, W, above);
          }
          const int c[3] = {i, j, k};
          const auto place_of = [&](const int(&o)[3],
                                    int d) {  // of the child among the cells of two blocks side by side
            return s.used[size_t(d)] ? 2 * c[d] + o[d] : 0;
          };
          if (stored_.any())
            for_each_child(s, [&](int child, const int(&o)[3], const int(&)[3]) {
              more[child] = stored_.at(lower, h, place_of(o, 2), place_of(o, 1), place_of(o, 0)) -
                            stored_.at(lower, s.h, k, j, i);
            });
          split_cell(mix, in_.medium.floors.p, s, U, W, slopes, more, out);
          for_each_child(s, [&](int child, const int(&o)[3], const int(&)[3]) {
            size_t block = 0;
            int at[3];
            for (int d = 2; d >= 0; --d) {
              at[d] = place_of(o, d);
              if (s.used[size_t(d)]) block = 2 * block + size_t(at[d] >= s.n[size_t(d)]);
              at[d] %= s.n[size_t(d)];
            }
            for (int q = 0; q < Mix::n_cons; ++q)
              job.to[block][size_t(q) * cells_ + s.at(at[2], at[1], at[0])] = out[child][q];
          });
        }
  }

  const Forest& forest_;
  const TransferInput& in_;
  const State& state_;
  Stored stored_;
  size_t cells_;
};

}  // namespace

void transfer_state(const Forest& forest, const TransferInput& in, const std::vector<Origin>& origins, State& state) {
  const int children = child_count(forest.shape());
  std::vector<double*> pieces(origins.size());
  std::vector<BlockInfo> info(origins.size());
  std::vector<Booked> booked(origins.size());
  std::vector<Split> splits;
  std::vector<Join> joins;
  for (size_t b = 0; b < origins.size(); ++b) {
    const Origin& o = origins[b];
    info[b].rate = -1;
    if (o.change == 0) {
      pieces[b] = state.block(o.old);
      info[b] = state.info[size_t(o.old)];
      booked[b] = state.booked[size_t(o.old)];
      continue;
    }
    pieces[b] = state.take();
    if (o.change > 0) {
      if (splits.empty() || splits.back().old != o.old) splits.push_back({o.old, {}});
      splits.back().to[size_t(o.child)] = pieces[b];
      if (o.child == 0) booked[b] = state.booked[size_t(o.old)];
    } else {
      joins.push_back({o.old, pieces[b]});
      for (int c = 0; c < children; ++c) booked[b] += state.booked[size_t(o.old + c)];
    }
  }
  const Transfer transfer(forest, in, state);
  std::vector<Space> spaces{size_t(thread_count())};
  parallel_for_dynamic(int64_t(splits.size()), spaces,
                       [&](int64_t i, Space& space) { transfer.split(splits[size_t(i)], space); });
  parallel_for_dynamic(int64_t(joins.size()), [&](int64_t i) { transfer.join(joins[size_t(i)]); });
  state.arrange(pieces);
  state.info = std::move(info);
  state.booked = std::move(booked);
}

void move_state(const Forest& forest, State& state) {
  const size_t U = state.block_size() * sizeof(double), bytes = U + sizeof(BlockInfo) + sizeof(Booked);
  const size_t before = state.booked.size(), after = size_t(forest.local_blocks());
  std::vector<char> from(before * bytes + 1), to(after * bytes + 1);
  for (size_t b = 0; b < before; ++b) {
    char* at = from.data() + b * bytes;
    std::memcpy(at, state.block(int(b)), U);
    std::memcpy(at + U, &state.info[b], sizeof(BlockInfo));
    std::memcpy(at + U + sizeof(BlockInfo), &state.booked[b], sizeof(Booked));
  }
  forest.transfer(bytes, from.data(), to.data());
  state.fit(forest);
  for (size_t b = 0; b < after; ++b) {
    const char* at = to.data() + b * bytes;
    std::memcpy(state.block(int(b)), at, U);
    std::memcpy(&state.info[b], at + U, sizeof(BlockInfo));
    std::memcpy(&state.booked[b], at + U + sizeof(BlockInfo), sizeof(Booked));
  }
}

}  // namespace bw::cfd
