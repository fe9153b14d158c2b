// SPDX-License-Identifier: BSD-3-Clause
#include "common/files/whole_file.hpp"

#include "common/errors/setup_error.hpp"
#include "common/files/writable_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

namespace waymark {
namespace {

using ::testing::HasSubstr;

TEST(WholeFile, ReadersOfTheReplacedFileKeepItsContent) {
  const auto file = std::filesystem::path{::testing::TempDir()} / "whole_file_test";
  write_whole_file(file, "old content");
  std::ifstream reader{file};
  write_whole_file(file, "new");
  EXPECT_EQ((std::string{std::istreambuf_iterator<char>{reader}, {}}), "old content");
}

TEST(WholeFile, TheErrorNamesFileAndReason) {
  try {
    write_whole_file("/no/such/folder/map.pgm", "");
    FAIL() << "no error";
  } catch (const std::system_error& error) {
    EXPECT_THAT(error.what(), HasSubstr("/no/such/folder/map.pgm: cannot be written"));
    EXPECT_THAT(error.what(), HasSubstr("No such file"));
  }
}

TEST(WholeFile, AFailedWriteLeavesNoFile) {
  const auto folder = std::filesystem::path{::testing::TempDir()} / "whole_file_test_folder";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / ".map.pgm.part");  // cannot be opened for writing
  EXPECT_THROW(write_whole_file(folder / "map.pgm", "bytes"), std::system_error);
  EXPECT_FALSE(std::filesystem::exists(folder / "map.pgm"));
  std::filesystem::remove_all(folder);
}

TEST(WholeFile, OnlyTheFileIsLeftInTheFolder) {
  const auto folder = std::filesystem::path{::testing::TempDir()} / "whole_file_test_folder";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder / "taken");
  write_whole_file(folder / "map.pgm", "bytes");
  EXPECT_EQ(read_whole_file(folder / "map.pgm"), "bytes");
  EXPECT_THROW(write_whole_file(folder / "taken", "bytes"), std::system_error);  // it is a folder
  EXPECT_FALSE(std::filesystem::exists(folder / ".map.pgm.part"));
  EXPECT_FALSE(std::filesystem::exists(folder / ".taken.part"));
  std::filesystem::remove_all(folder);
}

TEST(WholeFile, AMissingFileCannotBeRead) {
  EXPECT_THROW(read_whole_file("/no/such/file"), std::system_error);
}

TEST(WritableFolder, IsMadeAndLeftEmpty) {
  const auto folder = std::filesystem::path{::testing::TempDir()} / "writable_folder_test";
  std::filesystem::remove_all(folder);
  make_writable_folder(folder / "deeper");
  EXPECT_TRUE(std::filesystem::is_empty(folder / "deeper"));
  std::filesystem::remove_all(folder);
}

TEST(WritableFolder, WhereNoneCanBeTheErrorNamesFolderAndReason) {
  const auto file = std::filesystem::path{::testing::TempDir()} / "writable_folder_test_file";
  write_whole_file(file, "");
  try {
    make_writable_folder(file);
    FAIL() << "no error";
  } catch (const SetupError& error) {
    EXPECT_THAT(error.what(), HasSubstr(file.string() + ": files cannot be written there ("));
  }
  EXPECT_THROW(check_writable_folder(file), SetupError);
  EXPECT_THROW(check_writable_folder(file / "deeper"), SetupError);
  std::filesystem::remove(file);
}

TEST(WritableFolder, IsCheckedWithoutBeingMade) {
  const auto folder = std::filesystem::path{::testing::TempDir()} / "checked_folder_test";
  EXPECT_NO_THROW(check_writable_folder(folder / "deeper"));
  EXPECT_NO_THROW(check_writable_folder("a_name_in_the_present_folder"));
  EXPECT_FALSE(std::filesystem::exists(folder));
}

TEST(OutputFile, IsRefusedWhereItCannotBeWrittenWithTheOptionsName) {
  const auto why_refused = [](const std::filesystem::path& file) -> std::string {
    try {
      check_output_file("--out", file);
      return "";
    } catch (const SetupError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(why_refused("/no/such/folder/a.toml"), "--out: there is no folder '/no/such/folder'");
  EXPECT_EQ(why_refused(::testing::TempDir()), "--out: '" + ::testing::TempDir() + "' is a folder");
  EXPECT_EQ(why_refused(std::filesystem::path{::testing::TempDir()} / "a.toml"), "");
  EXPECT_EQ(why_refused("a.toml"), "");
}

}  // namespace
}  // namespace waymark
