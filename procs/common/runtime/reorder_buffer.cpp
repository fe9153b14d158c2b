// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/reorder_buffer.hpp"

#include "common/messages/codec.hpp"

#include <algorithm>

namespace waymark {

ReorderBuffer::ReorderBuffer(Duration window) : window_{window} {}

std::vector<Message> ReorderBuffer::add(Message message, Counters& counters) {
  if (message.time == Timestamp{} && message.channel == channels::kSlamCommand.name)
    return {stamped(std::move(message))};
  if (const Misfit why = misfit(message); why != Misfit::kNone) {
    if (why == Misfit::kLate) {
      counters.add(message.channel + " late, dropped", CountKind::kLoss);
    } else {
      counters.add(message.channel + " rejected: time jumps ahead", CountKind::kRejection);
    }
    if (!clock_watch_.see_misfit(message.time)) return {};
    counters.add("clock was set");
    return begin_anew(std::move(message));
  }
  clock_watch_.see_fitting();
  newest_ = has_any_ ? std::max(newest_, message.time) : message.time;
  has_any_ = true;
  const std::string channel = message.channel;
  if (!waiting_.insert(std::move(message)).second) counters.add(channel + " duplicates");
  return release_until(newest_ - window_);
}

/// Its sender knows no time, and wants it now: in a log it stands where it acts.
Message ReorderBuffer::stamped(Message message) const {
  const auto command = decode<command_t>(message.payload);
  if (!has_any_ || !command.message) return message;
  command_t timed = *command.message;
  timed.utime = to_us(newest_);
  return encode(channels::kSlamCommand, timed);
}

ReorderBuffer::Misfit ReorderBuffer::misfit(const Message& message) const {
  const auto released = released_.find(message.channel);
  if (released != released_.end() && message.time < released->second) return Misfit::kLate;
  if (has_any_ && message.time > newest_ + ClockWatch::kLongestPause) return Misfit::kAhead;
  return Misfit::kNone;
}

std::vector<Message> ReorderBuffer::begin_anew(Message message) {
  std::vector<Message> before = flush();
  newest_ = message.time;
  released_.clear();
  waiting_.insert(std::move(message));
  return before;
}

std::vector<Message> ReorderBuffer::flush() {
  return release_until(newest_);
}

std::vector<Message> ReorderBuffer::release_until(Timestamp time) {
  std::vector<Message> released;
  while (!waiting_.empty() && waiting_.begin()->time <= time) {
    released.push_back(std::move(waiting_.extract(waiting_.begin()).value()));
    released_[released.back().channel] = released.back().time;
  }
  return released;
}

}  // namespace waymark
