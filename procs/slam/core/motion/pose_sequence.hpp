// SPDX-License-Identifier: BSD-3-Clause
// Poses of keyframes, numbered from the first one of a run.
#pragma once

#include "common/geometry/se2.hpp"

#include <cstddef>
#include <deque>
#include <initializer_list>

namespace waymark {

/// Poses by number. The oldest ones may be dropped; the others keep their numbers.
class PoseSequence {
 public:
  PoseSequence() = default;

  PoseSequence(std::initializer_list<Se2> poses) : poses_{poses} {}

  /// Number of all poses ever added, dropped ones included.
  std::size_t size() const { return first_ + poses_.size(); }

  bool empty() const { return size() == 0; }

  /// @param index  of a pose that has not been dropped.
  Se2& operator[](std::size_t index) { return poses_[index - first_]; }

  const Se2& operator[](std::size_t index) const { return poses_[index - first_]; }

  Se2& back() { return poses_.back(); }

  const Se2& back() const { return poses_.back(); }

  void push_back(const Se2& pose) { poses_.push_back(pose); }

  /// Drops the poses before this one.
  void forget_before(std::size_t index) {
    for (; first_ < index; ++first_)
      poses_.pop_front();
  }

 private:
  std::size_t first_{0};  ///< number of the first pose that is kept
  std::deque<Se2> poses_{};
};

}  // namespace waymark
