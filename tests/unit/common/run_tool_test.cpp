// SPDX-License-Identifier: BSD-3-Clause
#include "common/command_line/run_tool.hpp"

#include "common/config/config.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

namespace waymark {
namespace {

using ::testing::internal::CaptureStderr;
using ::testing::internal::GetCapturedStderr;

TEST(RunTool, ReturnsTheCodeOfTheWork) {
  EXPECT_EQ(run_tool("waymark-map", [] { return kExitTimeout; }), kExitTimeout);
}

TEST(RunTool, AProblemOfTheSetUpIsReportedWithTheProgramAndCode2) {
  CaptureStderr();
  EXPECT_EQ(run_tool("waymark-map", []() -> int { throw SetupError{"a.lcm: no map"}; }),
            kExitUsage);
  EXPECT_EQ(GetCapturedStderr(), "waymark-map: a.lcm: no map\n");
}

TEST(RunTool, AWrongConfigurationIsAProblemOfTheSetUp) {
  const auto refuse = []() -> int {
    throw ConfigError{{"robot.toml:3: robot.x_m: got 'a'"}};
  };
  CaptureStderr();
  EXPECT_EQ(run_tool("waymark-faults", refuse), kExitUsage);
  EXPECT_EQ(GetCapturedStderr(), "waymark-faults: robot.toml:3: robot.x_m: got 'a'\n");
}

TEST(RunTool, AnyOtherErrorHasTheCodeThatTheToolChooses) {
  const auto fail = []() -> int {
    throw std::runtime_error{"the disk is full"};
  };
  CaptureStderr();
  EXPECT_EQ(run_tool("waymark-map", fail), kExitFailed);
  EXPECT_EQ(run_tool("waymark-evaluate", fail, kExitUsage), kExitUsage);
  EXPECT_EQ(GetCapturedStderr(),
            "waymark-map: the disk is full\nwaymark-evaluate: the disk is full\n");
}

TEST(RunTool, OutputThatCannotBeWrittenIsAFailure) {
  const auto print_to_full_disk = [] {
    if (std::freopen("/dev/full", "w", stdout) == nullptr) std::exit(99);
    std::exit(run_tool("waymark-map", [] { return std::puts("a line") < 0 ? 98 : 0; }));
  };
  EXPECT_EXIT(print_to_full_disk(), ::testing::ExitedWithCode(kExitFailed),
              "waymark-map: standard output cannot be written: No space left");
}

}  // namespace
}  // namespace waymark
