// SPDX-License-Identifier: BSD-3-Clause
// Covariance of the newest pose relative to earlier keyframes.
#pragma once

#include "common/geometry/se2.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace waymark {

/// Covariance of the newest pose relative to each earlier keyframe, as if the steps between
/// keyframes were independent: an overestimate, since scans matched with the same submap, and
/// loops, correlate the steps.
class DriftCovariance {
 public:
  /// @param covariance  of the keyframe's pose relative to the previous one, map's axes; zero for
  ///                    the first keyframe.
  void add_keyframe(const Se2& map_from_base, const Eigen::Matrix3d& covariance);

  void move_to_frame(const Se2& new_from_old);

  /// Covariance of the newest keyframe's pose relative to that of an earlier one, map's axes.
  Eigen::Matrix3d since(std::size_t keyframe) const;

  /// Covariance that the steps between two keyframes add to the newest keyframe's pose, map's axes.
  Eigen::Matrix3d between(std::size_t one, std::size_t other) const;

 private:
  Eigen::Vector2d newest_{Eigen::Vector2d::Zero()};
  std::vector<Eigen::Matrix3d> sums_{};  ///< sums up to each keyframe, at the map's origin
};

}  // namespace waymark
