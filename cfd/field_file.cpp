// SPDX-License-Identifier: Apache-2.0
#include "cfd/amr/levels.h"
#include "cfd/output.h"
#include "common/parallel/loop.h"

namespace bw::cfd {
namespace {

/// Fields of one level, box after box.
struct LevelFields {
  std::vector<double> rho, p;
  std::vector<std::vector<double>> alpha;  ///< of two materials the first, of more all
  std::vector<Vec3> v;
  std::vector<uint8_t> covered;
  void resize(size_t n, int fractions) {
    rho.resize(n), p.resize(n), v.resize(n), covered.assign(n, 0);
    alpha.assign(size_t(fractions), std::vector<double>(n));
  }
};

bool wanted(const Case& cs, const Forest& forest, int b) {
  const auto& box = cs.fluid.fields;
  if (!box) return true;
  const Vec3 lower = forest.lower(b), upper = lower + forest.extent(b);
  for (int d = 0; d < 3; ++d)
    if (lower[d] > box->upper[d] || upper[d] < box->lower[d]) return false;
  return true;
}

/// Conserved variables of a block on a level at or below its own, `across` of its cells side by side in one.
std::vector<double> on_level(const Model& m, int b, int across) {
  BlockShape s = m.forest.shape();
  std::vector<double> U(m.state.block(b), m.state.block(b) + m.state.block_size());
  for (; across > 1; across /= 2) {
    BlockShape coarse = s;
    for (size_t d = 0; d < 3; ++d)
      if (s.used[d]) coarse.n[d] /= 2;
    std::vector<double> mean(size_t(coarse.cells()) * size_t(m.state.rows()));
    for (int q = 0; q < m.state.rows(); ++q)
      for (int k = 0; k < coarse.n[2]; ++k)
        for (int j = 0; j < coarse.n[1]; ++j)
          for (int i = 0; i < coarse.n[0]; ++i)
            mean[size_t(q) * size_t(coarse.cells()) + coarse.at(k, j, i)] =
                mean_of_children(U.data() + size_t(q) * size_t(s.cells()), s, s.used[2] ? 2 * k : 0,
                                 s.used[1] ? 2 * j : 0, s.used[0] ? 2 * i : 0);
    U = std::move(mean), s = coarse;
  }
  return U;
}

void fill(const Model& m, int b, int across, size_t first, LevelFields& out) {
  const std::vector<double> U = on_level(m, b, across);
  const size_t cells = U.size() / size_t(m.state.rows());
  const std::vector<uint8_t> blocked = across == 1 ? blocked_cells(m, b) : std::vector<uint8_t>();
  std::visit(
      [&](const auto& pair) {
        for (size_t c = 0; c < cells; ++c) {
          double u[Cons::most], W[Prim::most];
          for (int q = 0; q < m.state.rows(); ++q) u[q] = U[size_t(q) * cells + c];
          pair.to_primitive(u, W, m.setup.medium.floors);
          const size_t at = first + c;
          out.rho[at] = m.setup.medium.density(u), out.p[at] = W[Prim::p];
          for (size_t k = 0; k < out.alpha.size(); ++k) out.alpha[k][at] = u[Cons::alpha(int(k))];
          out.v[at] = {W[Prim::v], W[Prim::v_y], W[Prim::v_z]};
          if (!blocked.empty()) out.covered[at] = blocked[c];
        }
      },
      m.setup.medium.mixture);
}

}  // namespace

void write_field_file(const std::string& path, const Case& cs, const Model& m) {
  const Forest& forest = m.forest;
  const int fractions = m.setup.medium.told_fractions();
  std::vector<VtkLevel> levels(size_t(forest.levels()) + 1);
  std::vector<LevelFields> fields(levels.size());
  int top = 0;
  for (int b = 0; b < forest.local_blocks(); ++b) top = std::max(top, forest.level(b));
  levels.resize(size_t(forest.comm().max(int64_t(top))) + 1);
  for (size_t l = 0; l < levels.size(); ++l) {
    VtkLevel& level = levels[l];
    level.spacing = forest.shape_of_level(int(l)).h;
    struct Part {
      int block, across;
      size_t first;
    };
    std::vector<Part> parts;
    size_t n = 0;
    for (int b = 0; b < forest.local_blocks(); ++b) {
      if (forest.level(b) < int(l) || !wanted(cs, forest, b)) continue;
      const int across = 1 << (forest.level(b) - int(l));
      std::array<int32_t, 6> box;
      size_t cells = 1;
      for (size_t d = 0; d < 3; ++d) {
        const int by = forest.shape().used[d] ? across : 1, count = forest.shape().n[d] / by,
                  first = forest.first_cell(b)[d] / by;
        box[2 * d] = first, box[2 * d + 1] = first + count - 1;
        cells *= size_t(count);
      }
      level.boxes.push_back(box);
      parts.push_back({b, across, n});
      n += cells;
    }
    LevelFields& f = fields[l];
    f.resize(n, fractions);
    parallel_for_dynamic(int64_t(parts.size()), [&](int64_t i) {
      const Part& part = parts[size_t(i)];
      fill(m, part.block, part.across, part.first, f);
    });
    level.fields = {VtkField::scalars("density", f.rho), VtkField::scalars("pressure", f.p),
                    VtkField::vectors("velocity", f.v)};
    for (size_t k = 0; k < f.alpha.size(); ++k)
      level.fields.push_back(VtkField::scalars("alpha_" + cs.fluid.material[k].name, f.alpha[k]));
    if (m.walls) level.fields.push_back({"covered", 1, std::span<const uint8_t>(f.covered)});
    for (VtkField& field : level.fields) field.exact = cs.run.output.exact;
  }
  write_vtkhdf(path, forest.size().lower, levels, forest.comm());
}

}  // namespace bw::cfd
