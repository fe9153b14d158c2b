// SPDX-License-Identifier: BSD-3-Clause
// Which messages belong to a tick: named by channel and content hash in TICK and ACK.
#pragma once

#include "common/messages/channels.hpp"
#include "common/messages/message.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace waymark {

/// Ticks in flight at most: so many answers must be at hand to be sent again.
inline constexpr int kMaxWindowTicks = 100;

/// Lists messages by channel, hashes in the order of comes_before.
std::vector<channel_content_t> contents_of(std::vector<Message> messages);

/// Received messages that wait for the tick that names them. Bounded: the oldest go first.
class MessagePool {
 public:
  /// False when the message is here already or was taken a short while ago.
  bool add(Message message);

  bool has(std::int64_t hash) const { return messages_.contains(hash); }

  Message take(std::int64_t hash);

 private:
  void forget_oldest();

  std::map<std::int64_t, Message> messages_;
  std::deque<std::int64_t> by_arrival_;
  std::set<std::int64_t> recently_taken_;
  std::deque<std::int64_t> recently_taken_by_age_;
  std::size_t bytes_{0};
};

}  // namespace waymark
