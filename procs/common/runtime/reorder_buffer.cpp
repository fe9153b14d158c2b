// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/reorder_buffer.hpp"

#include "common/messages/codec.hpp"

#include <algorithm>

namespace waymark {
namespace {

template <class Type>
Message with_stamp(Channel<Type> channel, Message message, Timestamp time) {
  const auto decoded = decode<Type>(message.payload);
  if (!decoded.message) return message;
  Type stamped = *decoded.message;
  stamped.utime = to_us(time);
  return encode(channel, stamped);
}

}  // namespace

bool is_unstamped(const Message& message) {
  return message.time == Timestamp{} && (message.channel == channels::kSlamCommand.name ||
                                         message.channel == channels::kSlamReply.name);
}

ReorderBuffer::ReorderBuffer(Duration window) : window_{window} {}

std::vector<Message> ReorderBuffer::add(Message message, Counters& counters) {
  if (is_unstamped(message)) return {stamped(std::move(message))};
  if (const OrderProblem problem = order_problem_of(message); problem != OrderProblem::kNone) {
    if (problem == OrderProblem::kLate) {
      counters.add(message.channel + " late, dropped", CountKind::kLoss);
    } else {
      counters.add(message.channel + " rejected: time jumps ahead", CountKind::kRejection);
    }
    if (!clock_steps_.note_inconsistent(message.time)) return {};
    counters.add("clock was set");
    return begin_anew(std::move(message));
  }
  clock_steps_.note_consistent();
  Stream& stream = streams_[message.channel];
  resolve_aside(stream, message.time, counters);
  if (waiting_.contains(message) ||
      std::ranges::find(stream.aside, message) != stream.aside.end()) {
    counters.add(message.channel + " duplicates");
    return {};
  }
  if (leads(stream, message.time)) {
    if (stream.aside.size() == kMaxSetAside) {
      counters.add(message.channel + " of one time, dropped", CountKind::kLoss);
      return {};
    }
    stream.aside.push_back(std::move(message));
    return {};
  }
  put_into_order(stream, std::move(message));
  return release_until(newest_ - window_);
}

/// A command without a stamp (utime 0) acts now: it gets the newest stamp, so that a replay of the
/// log executes it at the same place. So does slam's reply to one that came before all sensors.
/// Without any message before, they stay as they are; the order begins with a stamped message.
Message ReorderBuffer::stamped(Message message) const {
  if (!has_any_) return message;
  if (message.channel == channels::kSlamReply.name)
    return with_stamp(channels::kSlamReply, std::move(message), newest_);
  return with_stamp(channels::kSlamCommand, std::move(message), newest_);
}

ReorderBuffer::OrderProblem ReorderBuffer::order_problem_of(const Message& message) const {
  const auto stream = streams_.find(message.channel);
  if (stream != streams_.end() && stream->second.released &&
      message.time < *stream->second.released)
    return OrderProblem::kLate;
  if (has_any_ && message.time > newest_ + ClockStepDetector::kLongestPause)
    return OrderProblem::kAhead;
  return OrderProblem::kNone;
}

bool ReorderBuffer::leads(const Stream& stream, Timestamp time) const {
  if (!has_any_ || time <= newest_ + kLead) return false;
  return !stream.newest || time > *stream.newest + 2 * stream.usual_step;
}

/// Decides on the messages set aside: a later stamp confirms them, an earlier one drops them.
/// @param time  stamp of the channel's next message.
void ReorderBuffer::resolve_aside(Stream& stream, Timestamp time, Counters& counters) {
  if (stream.aside.empty() || stream.aside.front().time == time) return;
  if (time > stream.aside.front().time) {
    for (Message& message : std::exchange(stream.aside, {}))
      put_into_order(stream, std::move(message));
  } else {
    counters.add(stream.aside.front().channel + " rejected: time jumps ahead",
                 CountKind::kRejection, std::ssize(stream.aside));
    stream.aside.clear();
  }
}

void ReorderBuffer::put_into_order(Stream& stream, Message message) {
  const Timestamp time = message.time;
  newest_ = has_any_ ? std::max(newest_, time) : time;
  has_any_ = true;
  if (!stream.newest) {
    stream.newest = time;
  } else if (time > *stream.newest) {
    stream.usual_step = std::min(time - *stream.newest, 2 * stream.usual_step);
    stream.newest = time;
  }
  waiting_.insert(std::move(message));
}

std::vector<Message> ReorderBuffer::begin_anew(Message message) {
  std::vector<Message> before = flush();
  streams_.clear();
  has_any_ = false;
  put_into_order(streams_[message.channel], message);
  return before;
}

std::vector<Message> ReorderBuffer::flush() {
  for (auto& [channel, stream] : streams_) {
    for (Message& message : std::exchange(stream.aside, {}))
      put_into_order(stream, std::move(message));
  }
  return release_until(newest_);
}

std::vector<Message> ReorderBuffer::release_until(Timestamp time) {
  std::vector<Message> released;
  while (!waiting_.empty() && (waiting_.begin()->time <= time || waiting_.size() > kMaxWaiting)) {
    released.push_back(std::move(waiting_.extract(waiting_.begin()).value()));
    streams_[released.back().channel].released = released.back().time;
  }
  return released;
}

}  // namespace waymark
