// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/update.h"

#include <cmath>
#include <cstring>

#include "cfd/scheme/lane.h"

namespace bw::cfd {

namespace {

/// Extremes of a block, lane by lane.
struct Extremes {
  Pack rate = Pack(0.0), p_max = Pack(0.0);
  struct Range {
    Pack min = Pack(2.0), max = Pack(-1.0);
  };
  Range alpha[most_materials];  ///< of two materials, the first's alone
};

/// Lanes at and beyond `left` are neutral.
Pack first_lanes(Pack a, int left, double neutral) {
  for (int l = left; l < Pack::size; ++l) a.set(l, neutral);
  return a;
}

template <class Pair>
class Update {
  static constexpr int rows = Pair::n_cons, materials = Pair::materials, fractions = materials > 2 ? materials : 1;

 public:
  Update(const UpdateInput& in, const Pair& pair, const BlockShape& shape, const Vec3& lower)
      : in_(in), pair_(pair), floors_(in.medium->floors), shape_(shape), lower_(lower) {}

  /// All rows: traces, floors and the state's limits cell by cell where a pack needs it.
  void mixed_row(double* const (&row)[Cons::most], int k, int j, std::vector<uint8_t>& marks, Booked& booked,
                 UpdateResult& result, Extremes& extremes) {
    for (int i = 0; i < shape_.n[0]; i += Pack::size) {
      Pack U[rows], W[Pair::n_prim];
      for (int q = 0; q < rows; ++q) U[q] = Pack::load(row[q] + i);
      const int left = shape_.n[0] - i;
      Pack p = pair_.to_primitive(U, W, floors_);
      const auto alpha = [&](int m) {
        return materials == 2 && m == 1 ? Pack(1.0) - U[Cons::alpha1] : U[Cons::alpha(m)];
      };
      const auto is_trace = [&](Pack a) { return (a < Pack(alpha_trace)) & !((a >= Pack(0.0)) & (a <= Pack(0.0))); };
      Mask trace = is_trace(alpha(0)) | is_trace(alpha(1));
      Mask fine = (p >= Pack(floors_.p)) & (U[Cons::arho1] >= Pack(0.0)) & (U[Cons::arho2] >= Pack(0.0));
      Pack rho = U[Cons::arho1] + U[Cons::arho2];
      for (int m = 2; m < materials; ++m) {
        trace = trace | is_trace(alpha(m));
        fine = fine & (U[Cons::arho(m)] >= Pack(0.0));
        rho += U[Cons::arho(m)];
      }
      fine = fine & (rho >= Pack(floors_.rho)) & !trace;
      const bool skip = in_.blocked && any_blocked(shape_.at(k, j, i), left);
      if (!all(fine) || skip) {
        for (int l = 0; l < std::min(left, Pack::size); ++l) {
          const size_t cell = shape_.at(k, j, i + l);
          if (in_.blocked && in_.blocked[cell])
            for (Pack* q : {&W[Prim::v], &W[Prim::v_y], &W[Prim::v_z], &W[Prim::c], &p}) q->set(l, 0.0);
          else if (!fine[l])
            mend_cell(row, i + l, cell, k, j, W, l, marks, booked, result);
        }
        for (int l = 0; l < std::min(left, Pack::size); ++l)
          if (!in_.blocked || !in_.blocked[shape_.at(k, j, i + l)]) note_alpha(row, i + l, extremes);
      } else if (left < Pack::size) {
        for (int l = 0; l < left; ++l) note_alpha(row, i + l, extremes);
      } else {
        for (int m = 0; m < fractions; ++m) {
          Extremes::Range& range = extremes.alpha[m];
          range.min = min(range.min, U[Cons::alpha(m)]);
          range.max = max(range.max, U[Cons::alpha(m)]);
        }
      }
      extremes.rate = max(extremes.rate, first_lanes(rate(&W[Prim::v], W[Prim::c]), left, 0.0));
      extremes.p_max = max(extremes.p_max, first_lanes(p, left, 0.0));
    }
  }

  /// One gas alone: its rows of the change are added here.
  void gas_row(const GasFlow& gas, const double* U_old, const BlockChange& change, double* out, int k, int j,
               std::vector<uint8_t>& marks, Booked& booked, UpdateResult& result, Extremes& extremes) {
    constexpr int w = Pack::size;
    const size_t cells = size_t(shape_.cells()), first = shape_.at(k, j, 0);
    const double *old[GasCons::count], *d[GasCons::count];
    double* to[GasCons::count];
    for (int q = 0; q < GasCons::count; ++q) {
      const size_t variable = size_t(gas.cons_row(q));
      old[q] = U_old + variable * cells + first;
      to[q] = out + variable * cells + first;
      d[q] = change.row(gas.cons_row(q), k, j);
    }
    for (int i = 0; i < shape_.n[0]; i += w) {
      Pack U[GasCons::count], W[GasPrim::stored];
      for (int q = 0; q < GasCons::count; ++q) U[q] = Pack::load(old[q] + i) + Pack::load(d[q] + i);
      const int left = shape_.n[0] - i;
      const bool skip = in_.blocked && any_blocked(first + size_t(i), left);
      const auto is_blocked = [&](int l) { return skip && in_.blocked[first + size_t(i + l)]; };
      for (int l = 0; skip && l < std::min(left, w); ++l)
        if (is_blocked(l))
          for (int q = 0; q < GasCons::count; ++q) U[q].set(l, old[q][i + l]);
      Pack p = gas_to_primitive(gas, U, W, floors_);
      const Mask fine = (p >= Pack(floors_.p)) & (U[GasCons::rho] >= Pack(floors_.rho));
      for (int q = 0; q < GasCons::count; ++q)
        if (left >= w)
          U[q].store(to[q] + i);
        else
          for (int l = 0; l < left; ++l) to[q][i + l] = U[q][l];
      if (!all(fine) || skip) {
        double* row[Cons::most];
        for (int q = 0; q < rows; ++q) row[q] = out + size_t(q) * cells + first;
        for (int l = 0; l < std::min(left, w); ++l)
          if (is_blocked(l)) {
            for (Pack* a : {&W[GasPrim::v], &W[GasPrim::v + 1], &W[GasPrim::v + 2], &W[GasPrim::c], &p}) a->set(l, 0.0);
          } else if (!fine[l]) {
            Pack all_W[Pair::n_prim];
            mend_cell(row, i + l, first + size_t(i + l), k, j, all_W, l, marks, booked, result);
            for (int q = 1; q < GasPrim::count; ++q) W[q].set(l, all_W[gas.prim_row(q)][l]);
            W[GasPrim::c].set(l, all_W[Prim::c][l]);
          }
      }
      extremes.rate = max(extremes.rate, first_lanes(rate(&W[GasPrim::v], W[GasPrim::c]), left, 0.0));
      extremes.p_max = max(extremes.p_max, first_lanes(p, left, 0.0));
    }
  }

 private:
  Pack rate(const Pack* v, Pack c) const {
    Pack sum(0.0);
    for (int d = 0; d < 3; ++d)
      if (shape_.used[d]) sum += (abs(v[d]) + c) * Pack(1 / shape_.h[d]);
    return sum;
  }
  bool any_blocked(size_t cell, int left) const {
    uint64_t some = 0;
    std::memcpy(&some, in_.blocked + cell, size_t(std::min(left, Pack::size)));
    return some != 0;
  }
  static void note_alpha(double* const (&row)[Cons::most], int i, Extremes& e) {
    for (int m = 0; m < fractions; ++m) {
      const Pack a(row[Cons::alpha(m)][i]);
      e.alpha[m].min = min(e.alpha[m].min, a);
      e.alpha[m].max = max(e.alpha[m].max, a);
    }
  }
  /// Energy per mass of explosive that is still to be released.
  double stored(int k, int j, int i) const {
    if (!in_.burn) return 0;
    const Vec3 x = lower_ + Vec3{(i + 0.5) * shape_.h.x, (j + 0.5) * shape_.h.y, (k + 0.5) * shape_.h.z};
    return in_.burn->stored(x, in_.t1);
  }

  /// A cell with a trace, a floor or a broken state; sets lane l of W to what it became.
  void mend_cell(double* const (&row)[Cons::most], int i, size_t cell, int k, int j, Pack (&W)[Pair::n_prim], int l,
                 std::vector<uint8_t>& marks, Booked& booked, UpdateResult& result) {
    double U[rows], w[Pair::n_prim] = {};
    for (int q = 0; q < rows; ++q) U[q] = row[q][i];
    double p = pair_.to_primitive(U, w, floors_);
    volume_ = shape_.cell_volume(lower_.x, i);
    if (std::isfinite(p) && density(U) >= floors_.rho && remove_trace(U, w, booked)) {
      p = pair_.to_primitive(U, w, floors_);
      booked.cleaned[Cons::rhoE] += (row[Cons::arho1][i] - U[Cons::arho1]) * stored(k, j, i) * volume_;
    }
    const bool stores_energy = U[Cons::arho1] > 0 && stored(k, j, i) > 0;
    bool broken = !(density(U) >= floors_.rho) || !std::isfinite(p);
    for (int m = 0; m < materials; ++m) broken = broken || !(U[Cons::arho(m)] >= 0);
    const bool low = !(p >= floors_.p) && !stores_energy;
    if (broken || (low && !in_.last_try)) {
      if (marks.empty()) marks.assign(size_t(shape_.cells()), 0);
      marks[cell] = 1;
      if (result.bad++ == 0) result.first_bad = int(cell);
    } else if (low) {
      const double before = U[Cons::rhoE];
      pair_.to_conserved(w, U);  // with p at its floor
      booked.floor_energy += (U[Cons::rhoE] - before) * volume_;
      ++booked.floors;
    }
    for (int q = 0; q < rows; ++q) row[q][i] = U[q];
    for (int q = 0; q < Pair::n_prim; ++q) W[q].set(l, w[q]);
  }
  static double density(const double (&U)[rows]) {
    double rho = U[Cons::arho1] + U[Cons::arho2];
    for (int m = 2; m < materials; ++m) rho += U[Cons::arho(m)];
    return rho;
  }

  /// Takes a material out of the cell where its volume fraction is a trace; p and v stay. false: nothing to remove.
  bool remove_trace(double (&U)[rows], double (&w)[Pair::n_prim], Booked& booked) const {
    if constexpr (materials > 2) return remove_traces(U, w, booked);
    const double alpha1 = U[Cons::alpha1];
    if (alpha1 == 0 || alpha1 == 1 || (alpha1 >= alpha_trace && 1 - alpha1 >= alpha_trace)) {
      // round-off may leave a tiny density without volume behind
      if (alpha1 == 0 && U[Cons::arho1] != 0) return empty(U, w, 0, booked);
      if (alpha1 == 1 && U[Cons::arho2] != 0) return empty(U, w, 1, booked);
      return empty_negative(U, w, booked);
    }
    return empty(U, w, alpha1 < alpha_trace ? 0 : 1, booked);
  }
  /// The same of more than two: what is left keeps its densities and proportions.
  bool remove_traces(double (&U)[rows], double (&w)[Pair::n_prim], Booked& booked) const {
    double left = 0;
    int kept = 0, last = 0;
    bool some = false;
    for (int m = 0; m < materials; ++m) {
      double &alpha = w[Prim::alpha(m)], &arho = w[Prim::arho(m)];
      if (alpha >= alpha_trace) {
        left += alpha, ++kept, last = m;
      } else if (alpha != 0 || arho != 0) {
        alpha = arho = 0;
        some = true;
      }
    }
    if (!some) return empty_negative(U, w, booked);
    if (kept == 0) return false;
    for (int m = 0; m < materials; ++m) w[Prim::arho(m)] /= left, w[Prim::alpha(m)] /= left;
    if (kept == 1) w[Prim::alpha(last)] = 1;
    return settle(U, w, booked);
  }
  /// A density just below zero beside a small volume fraction.
  bool empty_negative(double (&U)[rows], double (&w)[Pair::n_prim], Booked& booked) const {
    const double rho = density(U);
    for (int m = 0; m < materials; ++m)
      if (U[Cons::arho(m)] < 0 && U[Cons::arho(m)] > -1e-6 * rho) {
        w[Prim::arho(m)] = 0;
        return settle(U, w, booked);
      }
    return false;
  }
  bool empty(double (&U)[rows], double (&w)[Pair::n_prim], int m, Booked& booked) const {
    // the other material keeps its own density: of a stiff one, 1e-8 less is a pressure
    const double other = m == 0 ? 1 - U[Cons::alpha1] : U[Cons::alpha1];
    w[Prim::arho1 + m] = 0;
    w[Prim::arho1 + 1 - m] /= other;
    w[Prim::alpha1] = m == 0 ? 0 : 1;
    return settle(U, w, booked);
  }
  bool settle(double (&U)[rows], double (&w)[Pair::n_prim], Booked& booked) const {
    double after[rows];
    pair_.to_conserved(w, after);
    for (int q = 0; q < rows; ++q) {
      booked.cleaned[q] += (U[q] - after[q]) * volume_;
      U[q] = after[q];
    }
    return true;
  }

  const UpdateInput& in_;
  const Pair& pair_;
  const Floors& floors_;
  const BlockShape& shape_;
  Vec3 lower_;
  double volume_ = 0;  ///< of the cell being mended [m^3]
};

/// One material, the same bits everywhere, no momentum?
void describe_block(const BlockShape& s, int materials, const double* U, bool whole, const Extremes& e,
                    BlockInfo& info) {
  info.rate = info.p_max = 0;
  for (int l = 0; l < Pack::size; ++l) {
    info.rate = std::max(info.rate, e.rate[l]);
    info.p_max = std::max(info.p_max, e.p_max[l]);
  }
  info.material = BlockInfo::no_fluid;
  for (int m = 0; m < (materials > 2 ? materials : 1); ++m) {
    double low = 2, high = -1;
    for (int l = 0; l < Pack::size; ++l)
      low = std::min(low, e.alpha[m].min[l]), high = std::max(high, e.alpha[m].max[l]);
    if (low > high) continue;
    info.material = std::max(info.material, 0);
    if (low == 1 && high == 1) info.material = m + 1;
    if (materials <= 2 && low == 0 && high == 0) info.material = 2;
  }
  const size_t n = size_t(s.cells());
  bool rest = whole;
  for (int q = 0; q < Cons::rows(materials); ++q) {
    info.U[q] = U[size_t(q) * n];
    if (q >= Cons::mom && q <= Cons::mom_z) rest = rest && info.U[q] == 0;
    if (rest) rest = std::memcmp(U + size_t(q) * n, U + size_t(q) * n + 1, (n - 1) * sizeof(double)) == 0;
  }
  info.at_rest = rest;
}

/// Shells near the centre have more face for their volume than slabs: their share of the block's rate.
template <class Pair>
double rate_near_centre(const Pair& pair, const Floors& floors, const BlockShape& s, double lower, const double* U) {
  double most = 0;
  for (int i = 0; i < std::min(4, s.n[0]); ++i) {
    double u[Pair::n_cons], W[Pair::n_prim];
    for (int q = 0; q < Pair::n_cons; ++q) u[q] = U[q * s.n[0] + i];
    pair.to_primitive(u, W, floors);
    const double r = lower + i * s.h.x, faces = 0.5 * (area_at(s.geometry, r) + area_at(s.geometry, r + s.h.x)) * s.h.x;
    const double height = s.geometry == Geometry::cylindrical ? s.h.z : 1;
    most = std::max(most, faces * height / s.cell_volume(lower, i) * (std::abs(W[Prim::v]) + W[Prim::c]) / s.h.x);
  }
  return most;
}

/// Energy released (or carried in stored form): E += s(t0) arho1_old - s(t1) arho1_new.
void release(const UpdateInput& in, const Patch& patch, int k, int j, const double* arho_old, const double* arho_new,
             double* rhoE) {
  const BlockShape& s = patch.shape();
  for (int i = 0; i < s.n[0]; ++i) {
    const Vec3 x = patch.lower + Vec3{(i + 0.5) * s.h.x, (j + 0.5) * s.h.y, (k + 0.5) * s.h.z};
    const double r = in.burn->distance(x);
    rhoE[i] +=
        in.burn->q * ((1 - in.burn->burnt(r, in.t0)) * arho_old[i] - (1 - in.burn->burnt(r, in.t1)) * arho_new[i]);
  }
}

/// Products that burn on.
void burn_on(const UpdateInput& in, const Patch& patch, int k, int j, const double* arho, double* rhoE,
             Booked& booked) {
  const BlockShape& s = patch.shape();
  for (int i = 0; i < s.n[0]; ++i) {
    if (in.blocked && in.blocked[s.at(k, j, i)]) continue;
    const double heat = in.heat * std::max(arho[i], 0.0);
    rhoE[i] += heat;
    booked.afterburn += heat * s.cell_volume(patch.lower.x, i);
  }
}

}  // namespace

UpdateResult update_block(const UpdateInput& in, const Patch& patch, const double* U, const BlockChange& change,
                          double* out, std::vector<uint8_t>& marks, Booked& booked) {
  const BlockShape& s = patch.shape();
  const size_t cells = size_t(s.cells());
  const int m = patch.material;
  const bool by_gas_kernel = m != 0 && in.medium->is_gas[m - 1];  // its rows of `change` alone are made
  const bool gas = by_gas_kernel && !in.burns;
  UpdateResult result;
  result.gas = gas ? m : 0;
  const int variables = in.medium->rows(), materials = in.medium->count();
  Extremes extremes;
  if (gas)
    for (int a = 0; a < (materials > 2 ? materials : 1); ++a)
      extremes.alpha[a].min = extremes.alpha[a].max = Pack(a == m - 1 ? 1.0 : 0.0);
  thread_local Aligned<double> rows;
  const size_t pitch = size_t(change.pitch);
  rows.resize(pitch * size_t(variables));
  double* row[Cons::most];
  for (int q = 0; q < variables; ++q) row[q] = rows.data() + pitch * size_t(q);
  std::visit(
      [&](const auto& pair) {
        Update update(in, pair, s, patch.lower);
        if (gas) {
          const GasFlow& flow = in.medium->gas[m - 1];
          if (!in.others_hold)
            for (int q = 0; q < variables; ++q)
              if (q != flow.rho_cons && (q < Cons::mom || q > Cons::rhoE))
                std::memcpy(out + size_t(q) * cells, U + size_t(q) * cells, cells * sizeof(double));
          for (int k = 0; k < s.n[2]; ++k)
            for (int j = 0; j < s.n[1]; ++j)
              update.gas_row(flow, U, change, out, k, j, marks, booked, result, extremes);
          return;
        }
        for (int k = 0; k < s.n[2]; ++k)
          for (int j = 0; j < s.n[1]; ++j) {
            for (int q = 0; q < variables; ++q) {
              const double* old = U + size_t(q) * cells + s.at(k, j, 0);
              const double* d = change.row(q, k, j);
              if (!by_gas_kernel || (q >= Cons::mom && q <= Cons::rhoE) || q == in.medium->gas[m - 1].rho_cons)
                for (int i = 0; i < s.n[0]; ++i) row[q][i] = old[i] + d[i];
              else
                std::memcpy(row[q], old, size_t(s.n[0]) * sizeof(double));
            }
            if (in.blocked)
              for (int i = 0; i < s.n[0]; ++i)
                if (in.blocked[s.at(k, j, i)])
                  for (int q = 0; q < variables; ++q) row[q][i] = U[size_t(q) * cells + s.at(k, j, i)];
            if (in.burns) release(in, patch, k, j, U + s.at(k, j, 0), row[Cons::arho1], row[Cons::rhoE]);
            if (in.heat > 0 && m < 2) burn_on(in, patch, k, j, row[Cons::arho1], row[Cons::rhoE], booked);
            update.mixed_row(row, k, j, marks, booked, result, extremes);
            for (int q = 0; q < variables; ++q)
              std::memcpy(out + size_t(q) * cells + s.at(k, j, 0), row[q], size_t(s.n[0]) * sizeof(double));
          }
      },
      in.medium->mixture);
  describe_block(s, materials, out, in.blocked == nullptr, extremes, result.info);
  if (s.radial())
    std::visit(
        [&](const auto& pair) {
          result.info.rate =
              std::max(result.info.rate, rate_near_centre(pair, in.medium->floors, s, patch.lower.x, out));
        },
        in.medium->mixture);
  return result;
}

BlockInfo inspect_block(const Medium& medium, const BlockShape& shape, const Vec3& lower, const double* U,
                        const uint8_t* blocked) {
  UpdateInput in;
  in.medium = &medium;
  in.blocked = blocked;
  in.last_try = true;
  BlockChange none(shape, medium.count());
  Patch patch(shape, medium.count());
  patch.lower = lower;
  Aligned<double> copy(size_t(shape.cells()) * size_t(medium.rows()));
  std::vector<uint8_t> marks;
  Booked unused;
  return update_block(in, patch, U, none, copy.data(), marks, unused).info;
}

}  // namespace bw::cfd
