// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/options.hpp"

#include "common/errors/exit_codes.hpp"
#include "common/errors/setup_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

ParsedOptions result_of(std::vector<std::string> words) {
  words.insert(words.begin(), "program");
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  return parse_options(static_cast<int>(arguments.size()), arguments.data(),
                       {"slam", "Does nothing.", false}, {.maps = true});
}

ProcessOptions parsed(const std::vector<std::string>& words) {
  const ParsedOptions result = result_of(words);
  EXPECT_FALSE(result.exit_code);
  return result.options;
}

TEST(Options, ModeAndStartOverrideSet) {
  EXPECT_THAT(parsed({}).config_sources.overrides, IsEmpty());
  EXPECT_THAT(parsed({"--mode", "localise", "--set", "slam.mode=map", "--start", "anywhere"})
                  .config_sources.overrides,
              ElementsAre("slam.mode=map", "slam.mode=localise", "slam.start=anywhere"));
}

TEST(Options, HelpAndVersionAreASuccessAndUnknownOptionsAUsageError) {
  for (const char* word : {"--help", "--version"})
    EXPECT_EQ(result_of({word}).exit_code, kExitOk) << word;
  for (const char* word : {"--mod", "localise"})
    EXPECT_EQ(result_of({word}).exit_code, kExitUsage) << word;
}

TEST(Options, AFolderThatCannotBeExaminedIsASetupError) {
  const auto link = std::filesystem::path{::testing::TempDir()} /
                    ("link_to_itself_" + std::to_string(::getpid()));
  std::filesystem::create_symlink(link, link);
  ProcessOptions options;
  options.save_map = link / "a.map.lcm";
  EXPECT_THROW(check_options(options, {.maps = true}), SetupError);
  options.save_map = link;
  EXPECT_NO_THROW(check_options(options, {.maps = true}));
  std::filesystem::remove(link);
}

}  // namespace
}  // namespace waymark
