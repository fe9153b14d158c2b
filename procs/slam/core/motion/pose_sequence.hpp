// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/geometry/se2.hpp"

#include <cstddef>
#include <deque>
#include <initializer_list>

namespace waymark {

/// Poses by their number; the oldest ones may be forgotten, and the others keep their numbers.
class PoseSequence {
 public:
  PoseSequence() = default;

  PoseSequence(std::initializer_list<Se2> poses) : poses_{poses} {}

  std::size_t size() const { return first_ + poses_.size(); }

  bool empty() const { return size() == 0; }

  /// @param index  of one that is not forgotten.
  Se2& operator[](std::size_t index) { return poses_[index - first_]; }

  const Se2& operator[](std::size_t index) const { return poses_[index - first_]; }

  Se2& back() { return poses_.back(); }

  const Se2& back() const { return poses_.back(); }

  void push_back(const Se2& pose) { poses_.push_back(pose); }

  void forget_before(std::size_t index) {
    for (; first_ < index; ++first_)
      poses_.pop_front();
  }

 private:
  std::size_t first_{0};  ///< that is not forgotten
  std::deque<Se2> poses_{};
};

}  // namespace waymark
