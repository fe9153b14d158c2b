// SPDX-License-Identifier: BSD-3-Clause
// Which messages belong to a tick: named by channel and content hash in TICK and ACK.
#pragma once

#include "common/messages/channels.hpp"
#include "common/messages/message.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <span>
#include <vector>

namespace waymark {

/// Largest number of ticks in flight; a participant keeps as many answers for re-sending.
inline constexpr int kMaxWindowTicks = 100;

/// Content hashes by channel, in the order of comes_before().
std::vector<channel_content_t> contents_of(std::vector<Message> messages);

/// Received messages by their content hash. Messages have no sequence numbers: two ticks may name
/// the same bytes (a marker map that did not change), and the second copy cannot be distinguished
/// from a re-sent first one. So a message is kept after its use, for the next tick that names it.
/// Bounded: the oldest messages are dropped, and arrive again when their tick is re-sent.
class MessagePool {
 public:
  /// False when the pool already has a message with this channel and payload.
  bool add(Message message);

  bool has(std::int64_t hash) const { return messages_.contains(hash); }

  /// Marks the messages as used. @return copies; the messages stay in the pool for later ticks.
  /// Requires has() of each hash.
  std::vector<Message> use(std::span<const std::int64_t> hashes);

 private:
  /// Hashes in the order in which their messages are dropped.
  struct Queue {
    std::deque<std::int64_t> hashes{};
    std::size_t bytes{0};
  };

  struct Entry {
    Message message{};
    bool is_used{false};
  };

  void forget_oldest(Queue& queue);

  std::map<std::int64_t, Entry> messages_{};
  Queue waiting_{};  ///< not used yet; used ones are still listed, and skipped by forget_oldest()
  Queue used_{};
};

}  // namespace waymark
