// SPDX-License-Identifier: BSD-3-Clause
// How far the pose may have drifted since an old keyframe.
#pragma once

#include "common/geometry/se2.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace waymark {

/// An upper bound, since steps from keyframe to keyframe count as if each erred by itself: scans in
/// one submap, and loops, make their sum surer.
class Drift {
 public:
  /// The next keyframe.
  /// @param covariance  of its pose relative to the one before, map's axes; of the first one, none.
  void add_keyframe(const Se2& map_from_base, const Eigen::Matrix3d& covariance);

  void move_to_frame(const Se2& new_from_old);

  /// Covariance of the newest keyframe's pose relative to that of an earlier one, map's axes.
  Eigen::Matrix3d since(std::size_t keyframe) const;

  /// Of the poses of two keyframes relative to each other, as it shows at the newest one.
  Eigen::Matrix3d between(std::size_t one, std::size_t other) const;

 private:
  Eigen::Vector2d newest_{Eigen::Vector2d::Zero()};
  std::vector<Eigen::Matrix3d> sums_{};  ///< up to each keyframe, as of a pose at the map's origin
};

}  // namespace waymark
