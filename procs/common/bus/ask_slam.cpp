// SPDX-License-Identifier: BSD-3-Clause
#include "common/bus/ask_slam.hpp"

#include "common/bus/bus.hpp"

#include <chrono>
#include <random>

namespace waymark {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kReplyTimeout{2000};
constexpr milliseconds kPoll{50};
constexpr milliseconds kResendPeriod{300};  // datagrams get lost

}  // namespace

const std::map<std::string, std::int8_t>& command_modes() {
  static const std::map<std::string, std::int8_t> modes{{"map", command_t::MODE_MAP},
                                                        {"localise", command_t::MODE_LOCALISE},
                                                        {"extend", command_t::MODE_EXTEND}};
  return modes;
}

std::optional<reply_t> ask_slam(const std::string& lcm_url, const ChannelNames& names,
                                command_t command) {
  std::random_device random;
  command.command_id = static_cast<std::int64_t>((std::uint64_t{random()} << 32U) | random());
  Bus bus{lcm_url, {{std::string{channels::kSlamReply.name}}}, LargeMessages::kRefused, names};
  const auto start = steady_clock::now();
  auto last_sent = start - kResendPeriod;
  while (steady_clock::now() - start < kReplyTimeout) {
    if (steady_clock::now() - last_sent >= kResendPeriod) {
      bus.publish(encode(channels::kSlamCommand, command));
      last_sent = steady_clock::now();
    }
    const auto message = bus.receive(kPoll);
    if (!message) continue;
    const auto reply = decode<reply_t>(message->payload).message;
    if (reply && reply->command_id == command.command_id) return *reply;
  }
  return std::nullopt;
}

}  // namespace waymark
