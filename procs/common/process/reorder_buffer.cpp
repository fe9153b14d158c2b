// SPDX-License-Identifier: BSD-3-Clause
#include "common/process/reorder_buffer.hpp"

#include <algorithm>

namespace waymark {
namespace {

// A gap of this length in all channels at once is a broken clock, not a pause.
constexpr Duration kLongestJump = std::chrono::minutes{10};

}  // namespace

ReorderBuffer::ReorderBuffer(Duration window) : window_{window} {}

std::vector<Message> ReorderBuffer::add(Message message, Counters& counters) {
  if (has_any_ && message.time < released_) {
    counters.add(message.channel + " late, dropped");
    return {};
  }
  if (has_any_ && message.time > newest_ + kLongestJump) {
    counters.add(message.channel + " rejected: time jumps ahead");
    return {};
  }
  newest_ = has_any_ ? std::max(newest_, message.time) : message.time;
  has_any_ = true;
  const std::string channel = message.channel;
  if (!waiting_.insert(std::move(message)).second) counters.add(channel + " duplicates");
  return release_until(newest_ - window_);
}

std::vector<Message> ReorderBuffer::flush() {
  return release_until(newest_);
}

std::vector<Message> ReorderBuffer::release_until(Timestamp time) {
  std::vector<Message> released;
  while (!waiting_.empty() && waiting_.begin()->time <= time) {
    released.push_back(std::move(waiting_.extract(waiting_.begin()).value()));
    released_ = released.back().time;
  }
  return released;
}

}  // namespace waymark
