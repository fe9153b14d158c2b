// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/files/output_folder.hpp"

#include "common/node/node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace waymark::viewer {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;

class OutputFolderTest : public ::testing::Test {
 protected:
  OutputFolderTest() { fs::remove_all(root_); }

  ~OutputFolderTest() override { fs::remove_all(root_); }

  static std::string content_of(const fs::path& file) {
    std::ifstream stream{file, std::ios::binary};
    return {std::istreambuf_iterator<char>{stream}, {}};
  }

  static std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator{folder})
      names.push_back(entry.path().filename());
    return names;
  }

  const fs::path root_ = fs::path{::testing::TempDir()} /
                         ::testing::UnitTest::GetInstance()->current_test_info()->name();
};

TEST_F(OutputFolderTest, CreatesFoldersAndLeavesNothingButTheFiles) {
  OutputFolder folder{root_ / "a" / "b"};
  folder.write("map.pgm", std::string("x\0y", 3));
  folder.write("map.pgm", "new");

  EXPECT_THAT(names_in(folder.path()), ElementsAre("map.pgm"));
  EXPECT_EQ(content_of(folder.path() / "map.pgm"), "new");
  EXPECT_TRUE(folder.failed_files().empty());
}

TEST_F(OutputFolderTest, AFullDiskIsReportedAndLeavesNoFile) {
  // In place of the temporary file there is a link to /dev/full, a device that is always full.
  OutputFolder folder{root_};
  folder.write("a", "old");
  fs::create_symlink("/dev/full", root_ / ".a.part");

  folder.write("a", "new");

  EXPECT_EQ(content_of(root_ / "a"), "old");
  EXPECT_THAT(names_in(root_), ElementsAre("a"));
  EXPECT_THAT(folder.failed_files(), ElementsAre("a"));
}

TEST_F(OutputFolderTest, AFileThatCannotBeWrittenIsListedAndTheOthersAreWritten) {
  OutputFolder folder{root_};
  fs::create_directories(root_ / "map.png" / "in the way");

  folder.write("map.png", "new");
  folder.write("markers.csv", "fine");

  EXPECT_THAT(folder.failed_files(), ElementsAre("map.png"));
  EXPECT_EQ(content_of(root_ / "markers.csv"), "fine");
  EXPECT_FALSE(fs::exists(root_ / ".map.png.part"));
}

TEST_F(OutputFolderTest, APlaceThatCannotBeWrittenIsASetupError) {
  fs::create_directories(root_);
  std::ofstream{root_ / "file"} << "not a folder";
  EXPECT_THROW(OutputFolder{root_ / "file"}, SetupError);
  EXPECT_THROW(OutputFolder{root_ / "file" / "below"}, SetupError);
  EXPECT_THROW(OutputFolder{"/proc/waymark"}, SetupError);
}

}  // namespace
}  // namespace waymark::viewer
