// SPDX-License-Identifier: Apache-2.0
#include "common/io/csv.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>

#include "common/app/error.h"

using namespace bw;

namespace {

std::string text_of(const std::string& path) {
  std::ifstream in(path);
  return {std::istreambuf_iterator<char>(in), {}};
}
const std::vector<History::Column> columns{{"t", "s"}, {"energy", "J"}};

}  // namespace

TEST(History, rows_under_a_header_with_units) {
  const std::string path = testing::TempDir() + "bw_history.csv";
  {
    History h(path, columns);
    EXPECT_EQ(text_of(path), "t [s],energy [J]\n");
    h.row({0, 1.0 / 3});
    h.row({1e-7, -2e10});
    h.flush();
    EXPECT_EQ(text_of(path), "t [s],energy [J]\n0,0.333333333333\n1e-07,-20000000000\n");
  }
  EXPECT_THROW(History("/nowhere/x.csv", columns), std::runtime_error);
}

TEST(History, refuses_nan_and_wrong_rows) {
  const std::string path = testing::TempDir() + "bw_history_nan.csv";
  History h(path, columns);
  try {
    h.row({0.5, std::nan("")});
    ADD_FAILURE();
  } catch (const PhysicsError& e) {
    EXPECT_NE(std::string(e.what()).find("energy is nan in the row of t = 0.5"), std::string::npos) << e.what();
  }
  EXPECT_THROW(h.row({0.5}), std::logic_error);
}

TEST(History, resumes_after_a_restart) {
  const std::string path = testing::TempDir() + "bw_history_resume.csv";
  {
    History h(path, columns);
    for (int i = 0; i < 5; ++i) h.row({0.1 * i, 1.0 * i});
  }
  std::ofstream(path, std::ios::app) << "0.15,3";  // cut by a crash
  {
    History h = History::resume(path, columns, 0.25);
    h.row({0.3, 33});
  }
  EXPECT_EQ(text_of(path), "t [s],energy [J]\n0,0\n0.1,1\n0.2,2\n0.3,33\n");
  const std::vector<History::Column> others{{"t", "s"}, {"mass", "kg"}};
  EXPECT_THROW(History::resume(path, others, 1), InputError);
  EXPECT_EQ(text_of(path), "t [s],energy [J]\n0,0\n0.1,1\n0.2,2\n0.3,33\n");
}

TEST(History, resumes_by_number_of_rows) {
  const std::string path = testing::TempDir() + "bw_history_rows.csv";
  int64_t rows = 0;
  {
    History h(path, columns);
    for (int i = 0; i < 5; ++i) {
      h.row({i / 3.0, 1.0 * i});  // the text is rounded: a time could not tell
      if (i == 2) rows = h.rows();
    }
    EXPECT_EQ(h.rows(), 5);
  }
  {
    History h = History::resume_rows(path, columns, rows);
    EXPECT_EQ(h.rows(), 3);
    h.row({1, 33});
    EXPECT_EQ(h.rows(), 4);
  }
  EXPECT_EQ(text_of(path), "t [s],energy [J]\n0,0\n0.333333333333,1\n0.666666666667,2\n1,33\n");
  std::remove(path.c_str());
  EXPECT_EQ(History::resume_rows(path, columns, 7).rows(), 0);
}
