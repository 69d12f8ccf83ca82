// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "common/app/error.h"
#include "coupling/commit.h"

namespace bw::coupling {
namespace {

namespace fs = std::filesystem;

struct Folder {
  fs::path path = fs::temp_directory_path() / ("commit_" + std::to_string(getpid()));
  Folder() { fs::remove_all(path), fs::create_directories(path); }
  ~Folder() { fs::remove_all(path); }
  void file(const std::string& name, size_t bytes) const { std::ofstream(path / name) << std::string(bytes, 'x'); }
  CommitMark mark(int64_t window) const {
    const std::string end = "_checkpoint_0000000" + std::to_string(window) + ".h5";
    file("solid" + end, 100), file("fluid" + end, 50);
    return {.window = window,
            .t = 1e-6 / 3 * double(window),
            .solid = "solid" + end,
            .fluid = "fluid" + end,
            .folder = path.string()};
  }
  int files() const { return int(std::distance(fs::directory_iterator(path), fs::directory_iterator{})); }
};

TEST(Commit, LatestMarkWithItsFiles) {
  const Folder folder;
  for (const int window : {1, 2, 3}) commit(folder.mark(window), 2);
  EXPECT_EQ(folder.files(), 2 * 3);
  const CommitMark found = find_commit(folder.path.string());
  EXPECT_EQ(found.window, 3);
  EXPECT_EQ(found.t, 1e-6 / 3 * 3);
  EXPECT_EQ(found.fluid_path(), folder.path.string() + "/fluid_checkpoint_00000003.h5");
  EXPECT_EQ(found.fluid_bytes, 50);
  EXPECT_NE(found.hash(), find_commit((folder.path / "pair_checkpoint_00000002.txt").string()).hash());
}

TEST(Commit, FilesThatWereNeverAgreedOnGoAndALeftRunsMarksToo) {
  const Folder folder;
  for (const int window : {2, 5}) commit(folder.mark(window), 9);
  folder.file("solid_checkpoint_00000007.h5", 10);  // killed before the fluid had its own
  folder.file("other.h5", 10);
  commit(folder.mark(3), 9);  // gone on from window 2
  EXPECT_EQ(find_commit(folder.path.string()).window, 3);
  EXPECT_EQ(folder.files(), 2 * 3 + 1);
}

TEST(Commit, CutShortOrAbsentIsRefused) {
  const Folder folder;
  EXPECT_THROW(find_commit(folder.path.string()), InputError);
  commit(folder.mark(1), 2);
  folder.file("fluid_checkpoint_00000001.h5", 49);
  EXPECT_THROW(find_commit(folder.path.string()), InputError);
  folder.file("fluid_checkpoint_00000001.h5", 50);
  EXPECT_NO_THROW(find_commit(folder.path.string()));
  EXPECT_THROW(find_commit((folder.path / "nothing.txt").string()), InputError);
  folder.file("pair_checkpoint_00000009.txt", 30);
  EXPECT_THROW(find_commit((folder.path / "pair_checkpoint_00000009.txt").string()), InputError);
}

}  // namespace
}  // namespace bw::coupling
