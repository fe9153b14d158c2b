// SPDX-License-Identifier: BSD-3-Clause
// waymark-command: sends one SLAM_COMMAND and waits for its SLAM_REPLY.
#include "command/command_line.hpp"
#include "common/bus/ask_slam.hpp"
#include "common/bus/bus.hpp"
#include "common/command_line/run_tool.hpp"
#include "common/config/config.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace {

struct ChannelsSection {
  waymark::ChannelNames channels{};

  void describe(waymark::Fields& fields) { fields.section("channels", channels); }
};

int ask(const waymark::CommandLine& line) {
  using namespace waymark;
  const ChannelNames names =
      line.channels_file.empty()
          ? ChannelNames{}
          : load_config<ChannelsSection>({{line.channels_file}, {}}).channels;
  const auto reply = ask_slam(lcm_url_or_default(line.lcm_url), names, line.command);
  if (!reply) {
    fmt::print(stderr,
               "waymark-command: no answer within 2 s; does slam run on this LCM network?\n");
    return kExitTimeout;
  }
  const bool is_done = reply->state == reply_t::STATE_DONE;
  fmt::print(is_done ? stdout : stderr, "{}{}\n", is_done ? "" : "refused: ", reply->text);
  return is_done ? kExitOk : kExitFailed;
}

}  // namespace

int main(int argc, char** argv) {
  const waymark::CommandLine line = waymark::parse_command_line(argc, argv);
  if (line.exit_code) return *line.exit_code;
  return waymark::run_tool(
      "waymark-command", [&] { return ask(line); }, waymark::kExitUsage);
}
