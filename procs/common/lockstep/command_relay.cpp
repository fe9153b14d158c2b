// SPDX-License-Identifier: BSD-3-Clause
#include "common/lockstep/command_relay.hpp"

#include "common/messages/codec.hpp"

namespace waymark {

void CommandRelay::handle(const Message& message) {
  if (message.channel != channels::kSlamCommand.name) return;
  const auto command = decode<command_t>(message.payload);
  if (!command.message) {
    counters_.add(message.channel + " rejected: " + std::string{to_string(command.reason)},
                  CountKind::kRejection);
  } else if (command.message->in_tick != 0) {
    return;
  } else if (waiting_.size() >= kMaxPerTick) {
    counters_.add("SLAM_COMMAND dropped: too many", CountKind::kLoss);
  } else {
    waiting_.push_back(message);
  }
}

void CommandRelay::move_into(std::vector<Message>& tick, Timestamp tick_end) {
  for (const Message& message : waiting_) {
    command_t command = *decode<command_t>(message.payload).message;
    command.utime = to_us(tick_end);
    command.in_tick = 1;
    tick.push_back(encode(channels::kSlamCommand, command));
  }
  waiting_.clear();
}

}  // namespace waymark
