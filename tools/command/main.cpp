// SPDX-License-Identifier: BSD-3-Clause
// waymark-command: sends one SLAM_COMMAND and waits for its SLAM_REPLY.
#include "command/command_line.hpp"
#include "common/bus/bus.hpp"
#include "common/config/config.hpp"
#include "common/errors/exit_codes.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <random>

namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kPatience{2000};
constexpr milliseconds kPoll{50};
constexpr milliseconds kSendAgain{300};  // datagrams get lost; the same id acts once

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
  command_t command = line.command;
  std::random_device random;  // no two commands have one id
  command.command_id = static_cast<std::int64_t>((std::uint64_t{random()} << 32U) | random());
  Bus bus{lcm_url_or_default(line.lcm_url),
          {{std::string{channels::kSlamReply.name}}},
          LargeMessages::kRefused,
          names};
  const auto start = steady_clock::now();
  auto last_sent = start - kSendAgain;
  while (steady_clock::now() - start < kPatience) {
    if (steady_clock::now() - last_sent >= kSendAgain) {
      bus.publish(encode(channels::kSlamCommand, command));
      last_sent = steady_clock::now();
    }
    const auto message = bus.receive(kPoll);
    if (!message) continue;
    const auto reply = decode<reply_t>(message->payload).message;
    if (!reply || reply->command_id != command.command_id) continue;
    const bool is_done = reply->state == reply_t::STATE_DONE;
    fmt::print(is_done ? stdout : stderr, "{}{}\n", is_done ? "" : "refused: ", reply->text);
    return is_done ? kExitOk : kExitFailed;
  }
  fmt::print(stderr, "waymark-command: no answer within 2 s; does slam run on this LCM network?\n");
  return kExitTimeout;
}

}  // namespace

int main(int argc, char** argv) {
  const waymark::CommandLine line = waymark::parse_command_line(argc, argv);
  if (line.exit_code) return *line.exit_code;
  try {
    return ask(line);
  } catch (const std::exception& error) {
    fmt::print(stderr, "waymark-command: {}\n", error.what());
    return waymark::kExitUsage;
  }
}
