// SPDX-License-Identifier: BSD-3-Clause
// Queue of one sensor's values that drops those with wrong stamps.
#pragma once

#include "common/time/time.hpp"
#include "slam/core/input/skip.hpp"

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>

namespace waymark {

/// Bounds of a queue, and the reasons under which dropped values are counted.
struct QueuePolicy {
  std::size_t capacity{0};  ///< largest number of values; with more, the oldest is dropped
  Duration max_age{};       ///< values older than the newest by more are dropped, too
  Skip out_of_order{};
  Skip ahead{};
  Skip overflow{};
};

/// Values (with a member `time`) in order of time. A value older than the newest one becomes the
/// candidate, outside the queue: either its stamp is too early, or queued stamps are too late. The
/// next value decides:
/// - newer than all: the candidate is dropped;
/// - newer than the candidate only: the queued values from the candidate's time on are dropped, and
///   both are added;
/// - otherwise it replaces the candidate.
/// Without a candidate, a second value with the newest stamp is dropped.
///
/// A value stamped far ahead of odometry, as after a pause of all sensors, is held outside the
/// queue (hold()) until the next sample of the odometry decides.
template <class Value>
class StampedQueue {
 public:
  explicit StampedQueue(const QueuePolicy& policy) : policy_{policy} {}

  void add(Value value, Skips& skips) {
    auto before = std::exchange(candidate_, std::nullopt);
    if (!newest_ || value.time > *newest_) {
      skips.add(policy_.out_of_order, before ? 1 : 0);
      push(std::move(value), skips);
    } else if (before && value.time > before->time) {
      skips.add(policy_.ahead, std::erase_if(values_, [&](const Value& other) {
                  return other.time >= before->time;
                }));
      push(std::move(*before), skips);
      push(std::move(value), skips);
    } else if (value.time < *newest_) {
      skips.add(policy_.out_of_order, before ? 1 : 0);
      candidate_ = std::move(value);
    } else {
      skips.add(policy_.out_of_order);
      candidate_ = std::move(before);
    }
  }

  /// Holds a value until add_held() or drop_held(), in place of one that is already held.
  void hold(Value value, Skips& skips) {
    drop_held(skips);
    held_ = std::move(value);
  }

  /// Adds the value that is held, if there is one; drops it if it is later than `limit`.
  void add_held(Timestamp limit, Skips& skips) {
    if (held_ && held_->time > limit) drop_held(skips);
    if (auto held = std::exchange(held_, std::nullopt)) add(std::move(*held), skips);
  }

  void drop_held(Skips& skips) {
    if (std::exchange(held_, std::nullopt)) skips.add(policy_.ahead);
  }

  bool is_empty() const { return values_.empty(); }

  /// Needs !is_empty().
  const Value& front() const { return values_.front(); }

  Value pop() {
    Value value = std::move(values_.front());
    values_.pop_front();
    return value;
  }

  /// Whether a value of that time or later has been added; it may have been popped since.
  bool has_reached(Timestamp time) const { return newest_ && *newest_ >= time; }

  /// Whether values with that stamp may still be dropped because of the candidate.
  bool may_be_dropped(Timestamp time) const { return candidate_ && time > candidate_->time; }

  /// Drops the candidate (the value set aside by add()) if its stamp is `time` or earlier.
  void drop_candidate_until(Timestamp time, Skips& skips) {
    if (!candidate_ || candidate_->time > time) return;
    candidate_.reset();
    skips.add(policy_.out_of_order);
  }

  void drop_after(Timestamp time, Skips& skips) {
    skips.add(policy_.ahead,
              std::erase_if(values_, [&](const Value& value) { return value.time > time; }));
    if (newest_ && *newest_ > time) newest_.reset();
  }

  /// Drops all values but the one that is held, after the clock was set.
  void clear(Skips& skips) {
    skips.add(policy_.out_of_order, values_.size() + (candidate_ ? 1 : 0));
    values_.clear();
    newest_.reset();
    candidate_.reset();
  }

 private:
  void push(Value value, Skips& skips) {
    newest_ = value.time;
    values_.push_back(std::move(value));
    while (values_.size() > policy_.capacity || *newest_ - values_.front().time > policy_.max_age) {
      values_.pop_front();
      skips.add(policy_.overflow);
    }
  }

  QueuePolicy policy_;
  std::deque<Value> values_{};
  std::optional<Timestamp> newest_{};  ///< stamp of the newest value that was pushed
  std::optional<Value> candidate_{};
  std::optional<Value> held_{};
};

}  // namespace waymark
