// SPDX-License-Identifier: Apache-2.0
#include "cfd/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>

#include "cfd/afterburn.h"
#include "cfd/output.h"
#include "common/app/log.h"
#include "common/app/timers.h"

namespace bw::cfd {
namespace {

constexpr int64_t layout = 4;
constexpr const char* program = "fluid";

/// Numbers of the whole run, the same on all ranks.
struct Run {
  double t = 0, explosive_mass = 0, cavity_mass = 0, burn_over = 0, afterburnt = 0;
  int64_t step = 0;
};
/// Where the ways of a burn around corners are given.
struct WayBox {
  Vec3 lower, h;
  std::array<int, 3> n{};
  double most = 0;
};
/// Sums of Books that all ranks hold alike.
struct WallSums {
  Vec3 wall_impulse, face_impulse, lip_impulse;
  double wall_energy = 0, wall_mass = 0, face_work = 0;
  int64_t repeated = 0;
};

/// A leaf in an order of its own.
std::array<int, 4> key_of(const Leaf& leaf) { return {leaf.level, leaf.place[0], leaf.place[1], leaf.place[2]}; }

/// Splits blocks until the forest has the saved leaves.
void restore_forest(Forest& forest, const std::vector<Leaf>& saved) {
  std::vector<std::array<int, 4>> leaves;
  for (const Leaf& leaf : saved) leaves.push_back(key_of(leaf));
  std::sort(leaves.begin(), leaves.end());
  for (int pass = 0;; ++pass) {
    std::vector<int8_t> wish(size_t(forest.local_blocks()), 0);
    int64_t splits = 0;
    for (int b = 0; b < forest.local_blocks(); ++b)
      if (!std::binary_search(leaves.begin(), leaves.end(), key_of({forest.level(b), forest.place(b)})))
        wish[size_t(b)] = 1, ++splits;
    if (forest.comm().sum(splits) == 0) break;
    if (pass == forest.levels()) throw InputError("the checkpoint's blocks don't fit the case's grid");
    forest.adapt(wish);
    forest.settle();
  }
  if (forest.global_blocks() != int64_t(leaves.size()))
    throw InputError("the checkpoint's blocks don't fit the case's grid");
}

void save_blocks(const Model& m, const Saved& to) {
  const size_t n = size_t(m.forest.local_blocks());
  std::vector<Leaf> leaves;
  std::vector<double> U;
  for (size_t b = 0; b < n; ++b) {
    leaves.push_back({m.forest.level(int(b)), m.forest.place(int(b))});
    if (!m.state.info[b].at_rest)
      U.insert(U.end(), m.state.block(int(b)), m.state.block(int(b)) + m.state.block_size());
  }
  to.rows("leaves", leaves);
  to.rows("info", std::vector<BlockInfo>(m.state.info.begin(), m.state.info.begin() + ptrdiff_t(n)));
  to.rows("booked", m.state.booked);
  to.rows("U", U, int(m.state.block_size()));
}

void restore_blocks(Model& m, const Restored& from) {
  restore_forest(m.forest, from.rows<Leaf>("leaves"));
  m.state.fit(m.forest);
  const std::vector<BlockInfo> info = from.rows<BlockInfo>("info");
  const int n = m.forest.local_blocks();
  const int64_t first = n > 0 ? m.forest.global_number(0) : 0;
  const auto moving = [](const BlockInfo& i) { return !i.at_rest; };
  const int64_t before = std::count_if(info.begin(), info.begin() + first, moving),
                mine = std::count_if(info.begin() + first, info.begin() + first + n, moving);
  const std::vector<double> U = from.rows<double>("U", before, mine);
  const std::vector<Booked> booked = from.rows<Booked>("booked", first, n);
  const size_t size = m.state.block_size(), cells = size / size_t(m.state.rows());
  auto next = U.begin();
  for (int b = 0; b < n; ++b) {
    const BlockInfo& known = m.state.info[size_t(b)] = info[size_t(first + b)];
    m.state.booked[size_t(b)] = booked[size_t(b)];
    if (known.at_rest) {
      for (int q = 0; q < m.state.rows(); ++q) std::fill_n(m.state.block(b, q), cells, known.U[q]);
    } else {
      std::copy_n(next, size, m.state.block(b));
      next += ptrdiff_t(size);
    }
  }
}

void save_surface(const coupling::WetSurface& s, coupling::WallPath& path, const Saved& to) {
  to.number("version", s.topo_version);
  to.same("x", s.x), to.same("v", s.v);
  to.same("quads", s.quads);
  to.same("node_id", s.node_id), to.same("node_parent", s.node_parent), to.same("face_id", s.face_id);
  to.same("body", s.body), to.same("flags", s.flags);
  path.save(to);
}

}  // namespace

std::optional<Restart> open_restart(const Case& cs, const std::string& file_or_folder, const Comm& comm) {
  if (file_or_folder.empty()) return {};
  CheckpointHead head{program, layout, case_hash(cs.file)};
  CheckpointReader file(find_checkpoint(file_or_folder, program), head, comm);
  say("goes on from step {}, t = {:.6g} s (written by {} rank{})", head.step, head.t, head.ranks,
      head.ranks == 1 ? "" : "s");
  return Restart{head, std::move(file)};
}

std::string write_checkpoint(const Case& cs, const Model& m, const Books& books, Output& out,
                             coupling::WallPath* path) {
  Timed timed("checkpoint");
  const std::string name = checkpoint_path(cs.run.output.directory, program, m.state.step);
  CheckpointWriter file(name,
                        {program, layout, case_hash(cs.file), m.state.step, m.state.t}, m.forest.comm());
  const Saved run = file.section("run");
  run.number("numbers",
             Run{m.state.t, m.explosive_mass, m.cavity_mass, m.setup.burn ? m.setup.burn->t_all : 0,
                 m.setup.afterburn ? m.setup.afterburn->share : 0, m.state.step});
  if (m.setup.burn && !m.setup.burn->ways.empty()) {
    const WayTable& ways = m.setup.burn->ways;
    run.number("way_box", WayBox{ways.lower, ways.h, ways.n, ways.most});
    run.same("ways", ways.longer);
  }
  save_blocks(m, file.section("blocks"));
  const Saved sums = file.section("books");
  sums.rows("swept", std::vector<Swept>{books.swept});
  sums.number("walls", WallSums{books.wall_impulse, books.face_impulse, books.lip_impulse, books.wall_energy,
                                books.wall_mass, books.face_work, books.repeated});
  if (m.walls) m.walls->save(file.section("walls"));
  if (m.bodies && !m.bodies->free().empty()) m.bodies->save(file.section("bodies"));
  out.save(file.section("output"));
  if (path) save_surface(m.walls->surface(), *path, file.section("surface"));
  file.finish();
  return name.substr(name.find_last_of('/') + 1);
}

void write_checkpoint_alone(const Case& cs, const Model& m, const Books& books, Output& out, int keep) {
  write_checkpoint(cs, m, books, out, nullptr);
  if (m.forest.comm().root()) drop_old_checkpoints(cs.run.output.directory, program, keep);
  say("checkpoint at step {}, t = {:.6g} s", m.state.step, m.state.t);
}

coupling::WetSurface restore_surface(const Restart& from, coupling::WallPath& path) {
  const Restored saved = from.file.section("surface");
  coupling::WetSurface s;
  s.topo_version = saved.number<int64_t>("version");
  s.x = saved.same<Vec3>("x"), s.v = saved.same<Vec3>("v");
  s.quads = saved.same<std::array<int32_t, 4>>("quads");
  s.node_id = saved.same<int64_t>("node_id"), s.node_parent = saved.same<int64_t>("node_parent");
  s.face_id = saved.same<int64_t>("face_id");
  s.body = saved.same<int32_t>("body"), s.flags = saved.same<int32_t>("flags");
  path.restore(saved);
  return s;
}

void restore_model(Model& m, const Restart& from, const coupling::WetSurface* surface) {
  restore_blocks(m, from.file.section("blocks"));
  const Run run = from.file.section("run").number<Run>("numbers");
  m.state.t = run.t, m.state.step = run.step;
  m.explosive_mass = run.explosive_mass, m.cavity_mass = run.cavity_mass;
  if (m.setup.burn) m.setup.burn->t_all = run.burn_over;
  if (const Restored numbers = from.file.section("run"); m.setup.burn && numbers.has("ways")) {
    const WayBox box = numbers.number<WayBox>("way_box");
    m.setup.burn->ways = {box.lower, box.h, box.n, numbers.same<double>("ways"), box.most};
  }
  begin_afterburn(m);
  if (m.setup.afterburn) m.setup.afterburn->share = run.afterburnt;
  if (m.walls && surface) m.walls->restore(from.file.section("walls"), *surface);
}

void restore_books(Books& books, const Comm& comm, const Restart& from) {
  const Restored sums = from.file.section("books");
  // each rank its own; of other numbers of ranks, the first has them all
  const std::vector<Swept> swept = sums.rows<Swept>("swept");
  books.swept = {};
  if (int(swept.size()) == comm.size()) {
    books.swept = swept[size_t(comm.rank())];
  } else if (comm.root()) {
    for (const Swept& s : swept) {
      for (int q = 0; q < Cons::most; ++q) books.swept.lost[q] += s.lost[q], books.swept.made[q] += s.made[q];
      books.swept.covered += s.covered, books.swept.fresh += s.fresh;
    }
  }
  const WallSums w = sums.number<WallSums>("walls");
  books.wall_impulse = w.wall_impulse, books.face_impulse = w.face_impulse, books.lip_impulse = w.lip_impulse;
  books.wall_energy = w.wall_energy, books.wall_mass = w.wall_mass, books.face_work = w.face_work, books.repeated = w.repeated;
}

}  // namespace bw::cfd
