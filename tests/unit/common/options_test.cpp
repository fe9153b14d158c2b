// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

ProcessOptions parsed(std::vector<std::string> words) {
  words.insert(words.begin(), "program");
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  const ParsedOptions result = parse_options(static_cast<int>(arguments.size()), arguments.data(),
                                             {"slam", "Does nothing.", false}, {.maps = true});
  EXPECT_FALSE(result.exit_code);
  return result.options;
}

TEST(Options, ModeAndStartOverrideSet) {
  EXPECT_THAT(parsed({}).config_sources.overrides, IsEmpty());
  EXPECT_THAT(parsed({"--mode", "localise", "--set", "slam.mode=map", "--start", "anywhere"})
                  .config_sources.overrides,
              ElementsAre("slam.mode=map", "slam.mode=localise", "slam.start=anywhere"));
}

}  // namespace
}  // namespace waymark
