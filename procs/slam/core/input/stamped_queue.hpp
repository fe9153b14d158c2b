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
  std::size_t capacity{0};  ///< beyond, the oldest value is dropped
  Duration longest{};       ///< so are values that are older than the newest by more
  Skip out_of_order{};
  Skip ahead{};
  Skip overflow{};
};

/// Values (with a member `time`) in order of time. A value older than the newest one is set aside:
/// either its own stamp is too early, or others are too late. The next value decides: if it is
/// newer than all, the value aside is dropped; if it is newer than the value aside only, the queued
/// values not older than the value aside are dropped; else it replaces the value aside. A second
/// value with the newest stamp is dropped.
///
/// A value that arrives long before the odometry of its time, as after a pause of all sensors, is
/// held outside the queue until the next sample of the odometry decides.
template <class Value>
class StampedQueue {
 public:
  explicit StampedQueue(const QueuePolicy& policy) : policy_{policy} {}

  void add(Value value, Skips& skips) {
    auto before = std::exchange(aside_, std::nullopt);
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
      aside_ = std::move(value);
    } else {
      skips.add(policy_.out_of_order);
      aside_ = std::move(before);
    }
  }

  /// Holds a value until add_held() or drop_held(); of several the last one is held.
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

  /// Whether values with that stamp may still be dropped because of the value aside.
  bool may_be_dropped(Timestamp time) const { return aside_ && time > aside_->time; }

  /// Drops the value aside if it is not newer than `time`.
  void drop_aside_until(Timestamp time, Skips& skips) {
    if (!aside_ || aside_->time > time) return;
    aside_.reset();
    skips.add(policy_.out_of_order);
  }

  void drop_after(Timestamp time, Skips& skips) {
    skips.add(policy_.ahead,
              std::erase_if(values_, [&](const Value& value) { return value.time > time; }));
    if (newest_ && *newest_ > time) newest_.reset();
  }

  /// Drops all values but the one that is held, after the clock was set.
  void clear(Skips& skips) {
    skips.add(policy_.out_of_order, values_.size() + (aside_ ? 1 : 0));
    values_.clear();
    newest_.reset();
    aside_.reset();
  }

 private:
  void push(Value value, Skips& skips) {
    newest_ = value.time;
    values_.push_back(std::move(value));
    while (values_.size() > policy_.capacity || *newest_ - values_.front().time > policy_.longest) {
      values_.pop_front();
      skips.add(policy_.overflow);
    }
  }

  QueuePolicy policy_;
  std::deque<Value> values_{};
  std::optional<Timestamp> newest_{};  ///< of all that were pushed
  std::optional<Value> aside_{};
  std::optional<Value> held_{};
};

}  // namespace waymark
