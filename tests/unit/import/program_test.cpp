// SPDX-License-Identifier: BSD-3-Clause
// Exit codes of waymark-import.
#include "import_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

namespace waymark {
namespace {

using ::testing::HasSubstr;

int exit_code(const std::string& arguments) {
  const std::string command = std::string{WAYMARK_BUILD_DIR} + "/waymark-import " + arguments +
                              " >" + (test_folder() / "stdout.txt").string() + " 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

std::string carmen(const std::filesystem::path& file) {
  return "carmen " + file.string() + " --first-angle-deg -45 --angle-step-deg 30 --out " +
         (test_folder() / "out.lcm").string();
}

TEST(ImportProgram, AGoodLogGives0) {
  EXPECT_EQ(exit_code(carmen(data_file("small.clf"))), 0);
  EXPECT_TRUE(std::filesystem::exists(test_folder() / "out.lcm"));
  EXPECT_TRUE(std::filesystem::exists(test_folder() / "robot.toml"));
}

TEST(ImportProgram, SkippedLinesGive1UnlessTolerated) {
  EXPECT_EQ(exit_code(carmen(data_file("bad.clf"))), 1);
  std::filesystem::remove(test_folder() / "out.lcm");
  EXPECT_EQ(exit_code(carmen(data_file("bad.clf")) + " --tolerant"), 0);
}

TEST(ImportProgram, AnExistingOutputGives2) {
  EXPECT_EQ(exit_code(carmen(data_file("small.clf"))), 0);
  EXPECT_EQ(exit_code(carmen(data_file("small.clf"))), 2);
  EXPECT_THAT(read_file(test_folder() / "stdout.txt"), HasSubstr("out.lcm: is there already"));
}

TEST(ImportProgram, InvalidNumbersGive2) {
  for (const char* option : {"--lidar-x-m", "--lidar-y-m", "--lidar-yaw-deg", "--first-angle-deg",
                             "--angle-step-deg", "--min-range-m", "--max-range-m"}) {
    for (const char* number : {"nan", "inf", "-inf"}) {
      const std::string arguments = "carmen " + data_file("small.clf").string() + " --out " +
                                    (test_folder() / "out.lcm").string() + " " + option + "=" +
                                    number;
      EXPECT_EQ(exit_code(arguments), 2) << option << " " << number;
      EXPECT_THAT(read_file(test_folder() / "stdout.txt"),
                  HasSubstr(std::string{option} + ": got " + number + ", expected"));
    }
  }
  EXPECT_FALSE(std::filesystem::exists(test_folder() / "out.lcm"));
}

TEST(ImportProgram, EmptyOrMissingLogsAndIncompleteArgumentsGive2) {
  EXPECT_EQ(exit_code(carmen(write_file("empty.clf", ""))), 2);
  EXPECT_EQ(exit_code(carmen("/nowhere/log.clf")), 2);
  EXPECT_EQ(exit_code("mbot " + write_file("empty.lcm", "").string() +
                      " --encoder-channel A --out x.lcm"),
            2);
  EXPECT_EQ(exit_code(""), 2);
  EXPECT_EQ(exit_code("carmen a.clf"), 2) << "--out is missing";
}

TEST(ImportProgram, TheLogItselfIsNeverOverwritten) {
  const auto file = write_file("out.lcm", read_file(data_file("small.clf")));
  EXPECT_EQ(exit_code(carmen(file)), 2);
  EXPECT_EQ(read_file(file), read_file(data_file("small.clf")));
}

TEST(ImportProgram, HelpAndVersionGive0) {
  EXPECT_EQ(exit_code("--help"), 0);
  EXPECT_EQ(exit_code("carmen --help"), 0);
  EXPECT_EQ(exit_code("--version"), 0);
}

}  // namespace
}  // namespace waymark
