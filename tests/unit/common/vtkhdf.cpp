// SPDX-License-Identifier: Apache-2.0
#include "common/io/vtkhdf.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/data/field.h"

using namespace bw;

TEST(VtkHdf, unstructured_grid) {
  const std::string path = testing::TempDir() + "bw_solid.vtkhdf";
  std::vector<Vec3> x;
  for (int i = 0; i < 12; ++i) x.push_back({double(i & 1), double((i >> 1) & 1), double(i >> 2)});
  const std::vector<std::array<NodeId, 8>> hex{
      {NodeId(0), NodeId(1), NodeId(3), NodeId(2), NodeId(4), NodeId(5), NodeId(7), NodeId(6)},
      {NodeId(4), NodeId(5), NodeId(7), NodeId(6), NodeId(8), NodeId(9), NodeId(11), NodeId(10)}};
  VtkMesh mesh{x, {}, {0}, {}};
  mesh.add_hexahedra(hex);
  mesh.add_cell(VtkCell::quad, std::vector<int64_t>{0, 1, 3, 2});
  const std::vector<double> eqps{0.1, 0.2, 0.3};
  const std::vector<int32_t> body{0, 1, 1};
  VtkField precise = VtkField::scalars("t_failed", eqps);
  precise.exact = true;
  write_vtkhdf(path, mesh, {VtkField::vectors("v", x)},
               {VtkField::scalars("eqps", eqps), VtkField::integers("body", body), precise});
  EXPECT_FALSE(std::filesystem::exists(path + ".tmp"));

  const h5::File file = h5::File::open(path);
  const h5::Group root = file.root().group("VTKHDF");
  EXPECT_EQ(root.read_text_attribute("Type"), "UnstructuredGrid");
  EXPECT_EQ(root.read_attribute<int64_t>("Version"), (std::vector<int64_t>{1, 0}));
  EXPECT_EQ(root.read<int64_t>("NumberOfPoints"), std::vector<int64_t>{12});
  EXPECT_EQ(root.read<int64_t>("NumberOfCells"), std::vector<int64_t>{3});
  EXPECT_EQ(root.read<int64_t>("NumberOfConnectivityIds"), std::vector<int64_t>{20});
  EXPECT_EQ(root.read<int64_t>("Offsets"), (std::vector<int64_t>{0, 8, 16, 20}));
  EXPECT_EQ(root.read<uint8_t>("Types"), (std::vector<uint8_t>{12, 12, 9}));
  EXPECT_EQ(root.read<int64_t>("Connectivity", 8, 2), (std::vector<int64_t>{4, 5}));
  EXPECT_EQ(root.shape("Points"), (std::array<int64_t, 2>{12, 3}));
  EXPECT_EQ(root.group("PointData").shape("v"), (std::array<int64_t, 2>{12, 3}));
  EXPECT_EQ(root.group("CellData").read<float>("eqps"), (std::vector<float>{0.1f, 0.2f, 0.3f}));
  EXPECT_EQ(root.group("CellData").read<double>("t_failed"), eqps);
  EXPECT_EQ(root.group("CellData").read<int32_t>("body"), body);
}

TEST(VtkHdf, fields_of_wrong_size_are_bugs) {
  const std::vector<Vec3> x(3);
  const std::vector<double> two(2);
  EXPECT_THROW(
      write_vtkhdf(testing::TempDir() + "bw_wrong.vtkhdf", VtkMesh{x, {}, {0}, {}}, {VtkField::scalars("a", two)}, {}),
      std::logic_error);
}

TEST(VtkHdf, overlapping_amr) {
  const std::string path = testing::TempDir() + "bw_fluid.vtkhdf";
  std::vector<double> coarse(2 * 64), fine(64);
  for (size_t i = 0; i < coarse.size(); ++i) coarse[i] = double(i);
  for (size_t i = 0; i < fine.size(); ++i) fine[i] = 100.0 + double(i);
  const std::vector<Vec3> v_coarse(coarse.size()), v_fine(fine.size());
  std::vector<VtkLevel> levels(2);
  levels[0] = {{0.5, 0.5, 0.5},
               {{0, 3, 0, 3, 0, 3}, {4, 7, 0, 3, 0, 3}},
               {VtkField::scalars("p", coarse), VtkField::vectors("v", v_coarse)}};
  levels[1] = {
      {0.25, 0.25, 0.25}, {{0, 3, 0, 3, 0, 3}}, {VtkField::scalars("p", fine), VtkField::vectors("v", v_fine)}};
  write_vtkhdf(path, Vec3{-1, -1, -1}, levels);

  const h5::File file = h5::File::open(path);
  const h5::Group root = file.root().group("VTKHDF");
  EXPECT_EQ(root.read_text_attribute("Type"), "OverlappingAMR");
  EXPECT_EQ(root.read_text_attribute("GridDescription"), "XYZ");
  EXPECT_EQ(root.read_attribute<double>("Origin"), (std::vector<double>{-1, -1, -1}));
  EXPECT_EQ(root.group("Level1").read_attribute<double>("Spacing"), (std::vector<double>{0.25, 0.25, 0.25}));
  EXPECT_EQ(root.group("Level0").read<int32_t>("AMRBox"), (std::vector<int32_t>{0, 3, 0, 3, 0, 3, 4, 7, 0, 3, 0, 3}));
  EXPECT_EQ(root.group("Level0").group("CellData").read<double>("p"), coarse);
  EXPECT_EQ(root.group("Level1").group("CellData").shape("v"), (std::array<int64_t, 2>{64, 3}));
}

TEST(VtkHdf, series_of_times) {
  const std::string folder = testing::TempDir();
  VtkSeries s(folder, "bw_series");
  EXPECT_EQ(s.next_path(), folder + "/bw_series_000000.vtkhdf");
  s.add(0);
  s.add(1.5e-5);
  s.add(3e-5);
  EXPECT_EQ(s.next_path(), folder + "/bw_series_000003.vtkhdf");
  const auto text = [&] {
    std::ifstream in(folder + "/bw_series.vtkhdf.series");
    return std::string(std::istreambuf_iterator<char>(in), {});
  };
  EXPECT_NE(text().find("\"name\": \"bw_series_000001.vtkhdf\",\n      \"time\": 1.5e-05\n"), std::string::npos)
      << text();
  VtkSeries again(folder, "bw_series");
  again.resume(2e-5);
  EXPECT_EQ(again.count(), 2);
  again.add(2.5e-5);
  EXPECT_NE(text().find("\"time\": 2.5e-05"), std::string::npos);
  EXPECT_EQ(text().find("\"time\": 3e-05"), std::string::npos);
}
