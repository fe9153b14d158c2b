// SPDX-License-Identifier: BSD-3-Clause
#include "common/files/whole_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

namespace waymark {
namespace {

using ::testing::HasSubstr;

TEST(WholeFile, ReadersOfTheOldFileKeepIt) {
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

}  // namespace
}  // namespace waymark
