// SPDX-License-Identifier: BSD-3-Clause
// Which messages belong to a tick: named by channel and content hash in TICK and ACK.
#pragma once

#include "common/messages/channels.hpp"
#include "common/messages/message.hpp"

#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace waymark {

/// Ticks in flight at most: so many answers must be at hand to be sent again.
inline constexpr int kMaxWindowTicks = 100;

/// Lists messages by channel, hashes in the order of comes_before.
std::vector<channel_content_t> contents_of(std::vector<Message> messages);

/// Received messages by their content. A message has no number of its own: two ticks may name the
/// same bytes (a marker map that did not change), and the copy that comes second cannot be
/// distinguished from one that was sent again. So what was taken stays for a while, and satisfies
/// whoever names it next. Bounded: the oldest go first, and come back when their tick is sent
/// again.
class MessagePool {
 public:
  /// False when the same message is here already.
  bool add(Message message);

  bool has(std::int64_t hash) const { return messages_.contains(hash); }

  /// Needs has(hash).
  Message take(std::int64_t hash);

 private:
  /// Messages in the order in which they are to be forgotten.
  struct Queue {
    std::deque<std::int64_t> hashes{};
    std::size_t bytes{0};
  };

  struct Entry {
    Message message{};
    bool is_taken{false};
  };

  void forget_oldest(Queue& queue);

  std::map<std::int64_t, Entry> messages_{};
  Queue waiting_{};  ///< also holds hashes that have been taken since
  Queue taken_{};
};

}  // namespace waymark
