// SPDX-License-Identifier: BSD-3-Clause
// Command lines that ask for what cannot be: refused before anything is done.
#include "common/process/run_process.hpp"

#include "common/process/exit_codes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::HasSubstr;

struct Refused {
  int exit_code{0};
  std::string output{};
};

/// Runs a process whose node must not be made. Each needs a name of its own: loggers have them.
Refused run(std::string_view name, std::vector<std::string> words) {
  words.insert(words.begin(), "program");
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  ::testing::internal::CaptureStderr();
  const int exit_code = run_described_process(
      static_cast<int>(arguments.size()), arguments.data(),
      {.traits = {name, "Does nothing.", false},
       .option_set = {.log = true, .out_log = true},
       .make_node = [](const ProcessOptions&, Inbox&, Outbox&) -> std::unique_ptr<Node> {
         throw std::logic_error{"a node was made"};
       }});
  return {exit_code, ::testing::internal::GetCapturedStderr()};
}

TEST(RunProcess, OptionsOfLiveRunsAreRefusedWithALog) {
  const Refused real_time = run("fast", {"--log", "run.lcm", "--real-time"});
  EXPECT_EQ(real_time.exit_code, kExitUsage);
  EXPECT_THAT(real_time.output, HasSubstr("leave out --real-time"));

  const Refused network = run("networked", {"--log", "run.lcm", "--lcm-url", "nonsense"});
  EXPECT_EQ(network.exit_code, kExitUsage);
  EXPECT_THAT(network.output, HasSubstr("leave out --real-time and --lcm-url"));
}

TEST(RunProcess, AnOutputLogNeedsAnInputLog) {
  const Refused live = run("live", {"--out-log", "out.lcm"});
  EXPECT_EQ(live.exit_code, kExitUsage);
  EXPECT_THAT(live.output, HasSubstr("--out-log needs --log"));
}

}  // namespace
}  // namespace waymark
