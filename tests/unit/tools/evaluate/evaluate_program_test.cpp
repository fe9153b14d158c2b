// SPDX-License-Identifier: BSD-3-Clause
// Exit codes of the program itself.
#include "unit/tools/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

namespace waymark::evaluate {
namespace {

int exit_code(const std::string& arguments) {
  const std::string command =
      WAYMARK_BUILD_DIR "/waymark-evaluate " + arguments + " > /dev/null 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(EvaluateProgram, HelpAndVersionGive0) {
  EXPECT_EQ(exit_code("--help"), 0);
  EXPECT_EQ(exit_code("run --help"), 0);
  EXPECT_EQ(exit_code("--version"), 0);
}

TEST(EvaluateProgram, PlacementNamesTheProgramThatWasCalled) {
  const TemporaryFolder folder;
  const std::string said = (folder.path() / "said").string();
  for (const char* program : {"waymark-placement", "waymark-evaluate placement"}) {
    const std::string command =
        std::string{WAYMARK_BUILD_DIR "/"} + program + " /no/such 2> " + said;
    EXPECT_NE(std::system(command.c_str()), 0);
    std::string line;
    std::getline(std::ifstream{said}, line);
    EXPECT_EQ(line,
              program + std::string{": /no/such: is not there; give the folder of a run or of "
                                    "its row, or a map file"});
  }
}

TEST(EvaluateProgram, WrongUsageAndMissingFilesGive2) {
  EXPECT_EQ(exit_code(""), 2);
  EXPECT_EQ(exit_code("measure"), 2);
  EXPECT_EQ(exit_code("length"), 2);
  EXPECT_EQ(exit_code("length /no/such.yaml"), 2);
  EXPECT_EQ(exit_code("run /no/such/folder"), 2);
  EXPECT_EQ(exit_code("trajectory /no/such.tum /no/such.tum"), 2);
  const TemporaryFolder folder;
  const std::string tum = folder.file("a.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n").string();
  EXPECT_EQ(exit_code("trajectory " + tum + " " + tum + " --align sideways"), 2);
  EXPECT_EQ(exit_code("trajectory " + tum + " " + tum + " --align se2 --json"), 0);
}

TEST(EvaluateProgram, TheTrueLengthMustBePositive) {
  const TemporaryFolder folder;
  const std::string said = (folder.path() / "said").string();
  for (const char* wrong : {"-3", "0", "nan", "long"}) {
    const std::string command = WAYMARK_BUILD_DIR "/waymark-evaluate run " +
                                folder.path().string() + " --true-length-m " + wrong + " 2> " +
                                said;
    EXPECT_NE(std::system(command.c_str()), 0);
    std::string line;
    std::getline(std::ifstream{said} >> std::ws, line);
    EXPECT_EQ(line, "--true-length-m: got " + std::string{wrong} + ", expected a number above 0");
  }
}

TEST(EvaluateProgram, SkippedRelationsGive1UnlessTolerated) {
  const TemporaryFolder folder;
  const std::string tum = folder.file("a.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n").string();
  const std::string both = folder.file("both", "0 1 1 0 0 0 0 0\n0 7 1 0 0 0 0 0\n").string();
  const std::string none = folder.file("none", "0 7 1 0 0 0 0 0\n").string();
  EXPECT_EQ(exit_code("relations " + tum + " " + both), 1);
  EXPECT_EQ(exit_code("relations --tolerant " + tum + " " + both), 0);
  EXPECT_EQ(exit_code("relations --tolerant " + tum + " " + none), 1);
}

TEST(EvaluateProgram, ConsistencyGives1WithoutStationsOrForABadLine) {
  const std::string columns =
      "travel_m,t,along_m,across_m,heading_rad,nees,sigma_along_m,sigma_across_m,sigma_heading_rad,"
      "health\n";
  const std::string station = "1,10.0,0.01,0.01,0.001,3.0,0.01,0.01,0.001,2\n";
  const auto code = [&](const std::string& lines) {
    const TemporaryFolder row;
    row.file("stations.csv", columns + lines);
    return exit_code("consistency " + row.path().string());
  };
  EXPECT_EQ(code(station), 0);
  EXPECT_EQ(code(station + "2,much\n"), 1);
  EXPECT_EQ(code(""), 1);
  EXPECT_EQ(code(station + "2,20.0,0.01,0.01,0.001,-1,-1,-1,-1,2\n"), 1);
}

}  // namespace
}  // namespace waymark::evaluate
