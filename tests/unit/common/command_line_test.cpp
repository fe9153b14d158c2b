// SPDX-License-Identifier: BSD-3-Clause
#include "common/command_line/command_line.hpp"

#include "common/errors/exit_codes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace waymark {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

struct Parsed {
  std::optional<int> exit_code{};
  std::string errors{};
};

/// A program with an option and two commands.
Parsed parse_with_commands(std::vector<const char*> words) {
  words.insert(words.begin(), "program");
  std::string file;
  std::string url;
  Program app{"Does nothing.", "program"};
  app.require_subcommand();
  app.add_option("--url", url, "");
  app.add_subcommand("info", "").add_option("FILE", file, "");
  app.add_subcommand("merge", "");
  ::testing::internal::CaptureStderr();
  const auto exit_code = app.parse(static_cast<int>(words.size()), words.data());
  return {exit_code, ::testing::internal::GetCapturedStderr()};
}

TEST(CommandLine, AMisspeltCommandIsNamedWithTheChoices) {
  for (const std::vector<const char*>& words :
       {std::vector{"inf", "a.map.lcm"}, std::vector{"--url", "merge", "inf"}}) {
    const Parsed parsed = parse_with_commands(words);
    EXPECT_EQ(parsed.exit_code, kExitUsage);
    EXPECT_THAT(parsed.errors,
                HasSubstr("there is no command 'inf', expected one of info, merge\n"));
  }
}

TEST(CommandLine, AMissingCommandAndMissingArgumentsAreNotTakenForMisspelt) {
  for (const std::vector<const char*>& words :
       {std::vector<const char*>{}, std::vector{"--url", "x"}}) {
    const Parsed parsed = parse_with_commands(words);
    EXPECT_EQ(parsed.exit_code, kExitUsage);
    EXPECT_THAT(parsed.errors, AllOf(HasSubstr("required"), Not(HasSubstr("no command"))));
  }
  EXPECT_FALSE(parse_with_commands({"info", "inf"}).exit_code);
}

}  // namespace
}  // namespace waymark
