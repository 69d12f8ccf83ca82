// SPDX-License-Identifier: Apache-2.0
#include "cfd/embed/refill.h"

#include "cfd/embed/wall_gas.h"

namespace bw::cfd {
namespace {

/// Of two with one sign the smaller, else 0.
double smaller(double a, double b) { return a * b <= 0 ? 0 : std::abs(a) < std::abs(b) ? a : b; }

template <class Mix>
class Refill {
  using Gas = WallGas<MixtureAtWall<Mix>>;
  using State = typename Gas::State;

 public:
  Refill(const CutMap& map, const Mix& mix, const Floors& floors, const CellReader& read)
      : map_(map), mix_(mix), floors_(floors), read_(read), gas_{{mix}} {}

  bool operator()(const Index3& cell, State& out) const {
    State value[6];
    double weight[6], most = 0;
    int count = 0, primary = 0;
    for (int d = 0; d < 3; ++d) {
      if (!map_.lattice().active(d)) continue;
      for (int side = 0; side < 2; ++side) {
        Index3 a, b;
        if (!valid(cell, d, side, a)) continue;
        const State A = state(a), B = valid(a, d, side, b) ? state(b) : A;
        if (const WallSide* w = wall(cell, d, 1 - side)) {
          const State star = gas_.at_wall(Gas::beyond(A, B, 1 + w->s), w->n, w->v).w;
          value[count] = Gas::on_line(star, A, A, w->s / (1 + w->s));
          weight[count] = 0.01 + w->n[d] * w->n[d];
        } else {
          value[count] = Gas::beyond(A, B, 1);
          weight[count] = 0.005;
        }
        if (Gas::same_composition(A, B)) {
          Index3 c;
          const State C = valid(a, d, side, b) && valid(b, d, side, c) ? state(c) : B;
          const double last = gas_.denser_than_isentrope(A, B), before = gas_.denser_than_isentrope(B, C);
          gas_.put_on_isentrope(A, std::exp(smaller(last, before)), value[count]);
        }
        // behind a wall that runs away from its gas: near vacuum, but not less in every next cell
        if (Gas::rho(value[count]) < refill_share * Gas::rho(A))
          for (int k = 0; k < Gas::densities; ++k)
            value[count][size_t(FaceRow::arho(k))] = refill_share * A[size_t(FaceRow::arho(k))];
        value[count][Gas::p] = std::max(value[count][Gas::p], refill_share * A[Gas::p]);
        if (weight[count] > most) most = weight[count], primary = count;
        ++count;
      }
    }
    if (count == 0) return false;
    State sum{};
    double total = 0;
    for (int i = 0; i < count; ++i) {
      if (!Gas::same_composition(value[i], value[primary])) continue;
      total += weight[i];
      for (size_t q = 0; q < sum.size(); ++q) sum[q] += weight[i] * value[i][q];
    }
    for (size_t q = 0; q < sum.size(); ++q) out[q] = sum[q] / total;
    out[Prim::alpha1] = value[primary][Prim::alpha1];
    if constexpr (Mix::materials > 2)
      for (int k = 1; k < Mix::materials; ++k)
        out[size_t(FaceRow::alpha(k))] = value[primary][size_t(FaceRow::alpha(k))];
    return true;
  }

 private:
  const CutLink* link(const Index3& c, int d, int side) const {
    Index3 low = c;
    low[size_t(d)] -= side ? 0 : 1;
    return map_.link(low, d);
  }
  const WallSide* wall(const Index3& c, int d, int side) const {
    const CutLink* l = link(c, d, side);
    return !l ? nullptr : side ? &l->below : &l->above;
  }
  /// Is the neighbour over this side connected, with valid fluid?
  bool valid(const Index3& c, int d, int side, Index3& to) const {
    to = c;
    to[size_t(d)] += side ? 1 : -1;
    return map_.inside(to) && !link(c, d, side) && !(map_.flags(to) & (cell_blocked | cell_fresh));
  }
  State state(const Index3& c) const {
    double U[Mix::n_cons], W[Mix::n_prim];
    read_(c, U);
    mix_.to_primitive(U, W, floors_);
    State w;
    for (size_t q = 0; q < w.size(); ++q) w[q] = W[FaceRow::prim(int(q))];
    return w;
  }

  const CutMap& map_;
  const Mix& mix_;
  const Floors& floors_;
  const CellReader& read_;
  Gas gas_;
};

}  // namespace

bool refill(const CutMap& map, const Index3& cell, const Mixture& mixture, const Floors& floors, const CellReader& read,
            double* U) {
  return std::visit(
      [&]<class Mix>(const Mix& mix) {
        std::array<double, size_t(FaceRow::rows(Mix::materials))> w;
        if (!Refill<Mix>(map, mix, floors, read)(cell, w)) return false;
        double W[Mix::n_prim] = {};
        for (size_t q = 0; q < w.size(); ++q) W[FaceRow::prim(int(q))] = w[q];
        mix.to_conserved(W, U);
        return true;
      },
      mixture);
}

}  // namespace bw::cfd
