// SPDX-License-Identifier: Apache-2.0
// The same answers on every rank and for every number of ranks; files of several ranks.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "common/io/vtkhdf.h"
#include "common/math/random.h"
#include "common/parallel/mpi.h"

using namespace bw;

namespace {

const Comm& world() {
  static const Comm comm(MPI_COMM_WORLD);
  return comm;
}

}  // namespace

TEST(Comm, reductions) {
  const Comm& c = world();
  const int r = c.rank(), n = c.size();
  EXPECT_EQ(c.min(double(r)), 0);
  EXPECT_EQ(c.max(double(r)), n - 1);
  EXPECT_EQ(c.sum(int64_t(r)), n * (n - 1) / 2);
  EXPECT_EQ(c.max(int64_t(r)), n - 1);
  double expected = 0;
  for (int i = 0; i < n; ++i) expected += uniform01(1, uint64_t(i));
  EXPECT_EQ(c.sum(uniform01(1, uint64_t(r))), expected);  // in rank order, to the last bit
  std::vector<double> both{uniform01(1, uint64_t(r)), 1};
  c.sum(both);
  EXPECT_EQ(both, (std::vector<double>{expected, double(n)}));
  c.barrier();
}

TEST(Comm, gathers_lists_of_different_length) {
  const Comm& c = world();
  std::vector<int> mine(size_t(c.rank()), c.rank()), expected;  // rank 0 has none
  for (int r = 0; r < c.size(); ++r) expected.insert(expected.end(), size_t(r), r);
  EXPECT_EQ(c.gather_all(mine), expected);
}

TEST(Comm, completes_what_each_rank_knows) {
  const Comm& c = world();
  std::vector<int> start{0};  // rank r knows r numbers
  for (int r = 0; r < c.size(); ++r) start.push_back(start.back() + r);
  std::vector<double> all(size_t(start.back()), -1), expected;
  for (int i = 0; i < start.back(); ++i) expected.push_back(uniform01(3, uint64_t(i)));
  for (int i = start[size_t(c.rank())]; i < start[size_t(c.rank()) + 1]; ++i) all[size_t(i)] = expected[size_t(i)];
  c.complete(all, start);
  EXPECT_EQ(all, expected);
  std::vector<int> ranks;
  for (int r = 0; r < c.size(); ++r) ranks.push_back(10 * r);
  EXPECT_EQ(c.gather_one(10 * c.rank()), ranks);
}

TEST(Comm, exchanges_in_pairs) {
  const Comm& c = world();
  const int me = c.rank();
  std::vector<std::vector<double>> send(size_t(c.size())), receive(size_t(c.size()));
  for (int r = 0; r < c.size(); ++r)
    if (r != me) {  // to the right neighbour nothing
      send[size_t(r)].assign(r == me + 1 ? 0 : size_t(me + 1), 100 * me + r);
      receive[size_t(r)].resize(me == r + 1 ? 0 : size_t(r + 1));
    }
  c.exchange(send, receive);
  for (int r = 0; r < c.size(); ++r)
    for (const double value : receive[size_t(r)]) EXPECT_EQ(value, 100 * r + me);
}

TEST(Comm, errors_have_text) {
  try {
    check_mpi(MPI_Send(nullptr, 1, MPI_INT, 99, 0, MPI_COMM_WORLD), "MPI_Send");
    ADD_FAILURE();
  } catch (const std::runtime_error& e) {
    EXPECT_NE(std::string(e.what()).find("MPI_Send: MPI_ERR"), std::string::npos) << e.what();
  }
}

TEST(Hdf5, ranks_write_one_after_the_other) {
  const Comm& c = world();
  const std::string path = testing::TempDir() + "bw_parallel_" + std::to_string(c.size()) + ".h5";
  for (const int64_t rows_per_rank : {3, 30000}) {  // plain, and compressed
    // the last rank has none, unless it is the only one
    const int64_t rows = c.size() > 1 && c.rank() == c.size() - 1 ? 0 : rows_per_rank;
    const int64_t first = c.rank() * rows_per_rank, total = rows_per_rank * std::max(1, c.size() - 1);
    std::vector<double> mine;
    for (int64_t i = 0; i < 3 * rows; ++i) mine.push_back(uniform01(2, uint64_t(3 * first + i)));
    {
      const h5::File file = h5::File::create(path, c);
      file.root().group("g").write("x", mine, 3);
      file.root().group("g").attribute("ranks", int64_t(c.size()));
    }
    const h5::Group g = h5::File::open(path, c).root().group("g");
    EXPECT_EQ(g.shape("x"), (std::array<int64_t, 2>{total, 3}));
    const std::vector<double> all = g.read<double>("x");
    ASSERT_EQ(int64_t(all.size()), 3 * total);
    for (size_t i = 0; i < all.size(); ++i) ASSERT_EQ(all[i], uniform01(2, uint64_t(i)));
    c.barrier();
  }
}

TEST(VtkHdf, a_part_per_rank) {
  const Comm& c = world();
  const std::string path = testing::TempDir() + "bw_parallel_" + std::to_string(c.size()) + ".vtkhdf";
  std::vector<Vec3> x;
  for (int i = 0; i < 8; ++i) x.push_back({double(i & 1), double((i >> 1) & 1), double(i >> 2) + c.rank()});
  VtkMesh mesh{x, {}, {0}, {}};
  mesh.add_cell(VtkCell::hexahedron, std::vector<int64_t>{0, 1, 3, 2, 4, 5, 7, 6});
  const std::vector<int32_t> rank{c.rank()};
  write_vtkhdf(path, mesh, {}, {VtkField::integers("rank", rank)}, c);
  c.barrier();
  EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));
  const h5::Group root = h5::File::open(path).root().group("VTKHDF");
  EXPECT_EQ(root.read<int64_t>("NumberOfPoints"), std::vector<int64_t>(size_t(c.size()), 8));
  EXPECT_EQ(root.read<int64_t>("Offsets").size(), 2u * size_t(c.size()));
  EXPECT_EQ(root.group("CellData").read<int32_t>("rank").back(), c.size() - 1);
}

TEST(VtkHdf, boxes_of_all_ranks) {
  const Comm& c = world();
  const std::string path = testing::TempDir() + "bw_parallel_amr_" + std::to_string(c.size()) + ".vtkhdf";
  const std::vector<double> p(64, c.rank());
  std::vector<VtkLevel> levels{
      {{1, 1, 1}, {{4 * c.rank(), 4 * c.rank() + 3, 0, 3, 0, 3}}, {VtkField::scalars("p", p)}}};
  write_vtkhdf(path, Vec3{}, levels, c);
  c.barrier();
  const h5::Group level = h5::File::open(path).root().group("VTKHDF").group("Level0");
  EXPECT_EQ(level.shape("AMRBox"), (std::array<int64_t, 2>{c.size(), 6}));
  EXPECT_EQ(level.group("CellData").read<double>("p").size(), 64u * size_t(c.size()));
}
