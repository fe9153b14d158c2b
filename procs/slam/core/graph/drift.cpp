// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/drift.hpp"

#include <algorithm>

namespace waymark {

void DriftCovariance::add_keyframe(const Se2& map_from_base, const Eigen::Matrix3d& covariance) {
  newest_ = map_from_base.translation();
  const Eigen::Matrix3d at_origin = at_end_of_lever(covariance, -newest_);
  sums_.push_back(sums_.empty() ? at_origin : Eigen::Matrix3d{sums_.back() + at_origin});
}

void DriftCovariance::move_to_frame(const Se2& new_from_old) {
  newest_ = new_from_old * newest_;
  for (Eigen::Matrix3d& sum : sums_)
    sum = at_end_of_lever(in_axes(new_from_old.rotation(), sum), -new_from_old.translation());
}

Eigen::Matrix3d DriftCovariance::since(std::size_t keyframe) const {
  return at_end_of_lever(Eigen::Matrix3d{sums_.back() - sums_[keyframe]}, newest_);
}

Eigen::Matrix3d DriftCovariance::between(std::size_t one, std::size_t other) const {
  const auto [first, last] = std::minmax(one, other);
  return at_end_of_lever(Eigen::Matrix3d{sums_[last] - sums_[first]}, newest_);
}

}  // namespace waymark
