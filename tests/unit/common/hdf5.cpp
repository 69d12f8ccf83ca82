// SPDX-License-Identifier: Apache-2.0
#include "common/io/hdf5.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "common/io/growing_file.h"
#include "common/math/random.h"

using namespace bw;

namespace {

template <class T>
void round_trip(const h5::Group& group, const std::string& name, size_t n, int columns) {
  std::vector<T> values(n * size_t(columns));
  for (size_t i = 0; i < values.size(); ++i) values[i] = T(100 * uniform01(1, i));
  group.write(name, values, columns);
  EXPECT_EQ(group.read<T>(name), values);
  EXPECT_EQ(group.shape(name), (std::array<int64_t, 2>{int64_t(n), columns}));
  if (n > 3) {
    EXPECT_EQ(group.read<T>(name, 1, 2), std::vector<T>(values.begin() + columns, values.begin() + 3 * columns));
  }
}

}  // namespace

TEST(Hdf5, arrays_and_attributes_round_trip) {
  const std::string path = testing::TempDir() + "bw_arrays.h5";
  {
    const h5::File file = h5::File::create(path);
    const h5::Group g = file.root().group("a").group("b");
    round_trip<double>(g, "double", 10, 1);
    round_trip<double>(g, "points", 7, 3);
    round_trip<float>(g, "float", 5, 2);
    round_trip<int64_t>(g, "int64", 6, 1);
    round_trip<int32_t>(g, "int32", 6, 6);
    round_trip<uint8_t>(g, "uint8", 9, 1);
    round_trip<double>(g, "empty", 0, 1);
    round_trip<double>(g, "empty_points", 0, 3);
    round_trip<double>(g, "large", 200000, 3);  // chunks and compression
    g.attribute("text", std::string("OverlappingAMR"));
    g.attribute("no_text", std::string());
    g.attribute("number", 3.5);
    const int64_t two[2] = {1, 0};
    g.attribute("two", std::span<const int64_t>(two));
  }
  const h5::File file = h5::File::open(path);
  const h5::Group g = file.root().group("a").group("b");
  EXPECT_EQ(g.read_text_attribute("text"), "OverlappingAMR");
  EXPECT_EQ(g.read_text_attribute("no_text"), "");
  EXPECT_EQ(g.read_attribute<double>("number"), std::vector<double>{3.5});
  EXPECT_EQ(g.read_attribute<int64_t>("two"), (std::vector<int64_t>{1, 0}));
  EXPECT_TRUE(g.has("points"));
  EXPECT_FALSE(g.has("none"));
  EXPECT_EQ(g.names(), (std::vector<std::string>{"double", "empty", "empty_points", "float", "int32", "int64", "large",
                                                 "points", "uint8"}));
  EXPECT_EQ(g.read<float>("double").size(), 10u);  // converted
  EXPECT_LT(std::filesystem::file_size(path), 8u * 600000u);
}

TEST(Hdf5, failures_name_the_file) {
  for (const auto& act : std::vector<std::function<void()>>{
           [] { h5::File::open("/nowhere/x.h5"); },
           [] { h5::File::create("/nowhere/x.h5"); },
           [] { h5::File::create(testing::TempDir() + "bw_x.h5").root().read<double>("none"); },
           [] {
             const h5::File f = h5::File::create(testing::TempDir() + "bw_x.h5");
             f.root().write("a", std::vector<double>{1, 2});
             f.root().read<double>("a", 1, 2);
           },
       }) {
    try {
      act();
      ADD_FAILURE();
    } catch (const std::runtime_error& e) {
      EXPECT_NE(std::string(e.what()).find("x.h5: HDF5: "), std::string::npos) << e.what();
    }
  }
}

TEST(Hdf5, a_growing_file_is_readable_while_it_grows) {
  const std::string path = testing::TempDir() + "bw_growing.h5";
  h5::GrowingFile file(path);
  file.table<double>("x", 3);
  file.table<int32_t>("n", 1);
  file.start();
  std::vector<double> all;
  for (int i = 0; i < 3; ++i) {
    std::vector<double> x(30000 * size_t(i));  // none, less than a chunk, several
    for (size_t k = 0; k < x.size(); ++k) x[k] = uniform01(4, all.size() + k);
    all.insert(all.end(), x.begin(), x.end());
    file.append("x", std::span<const double>(x));
    file.append("n", std::span<const int32_t>(&i, 1));
    file.flush();
    const h5::File reader = h5::File::open(path);
    EXPECT_EQ(reader.root().read<double>("x"), all);
    EXPECT_EQ(reader.root().shape("x"), (std::array<int64_t, 2>{int64_t(all.size()) / 3, 3}));
    EXPECT_EQ(reader.root().read<int32_t>("n").size(), size_t(i + 1));
  }
}
