// SPDX-License-Identifier: BSD-3-Clause
// How good camera and markers are.
#pragma once

#include <Eigen/Core>

#include <optional>

namespace waymark {

/// How far camera and markers may differ from what the robot has been told of them: standard
/// deviations. Keys and meanings: [robot.camera] and [robot.markers]; the defaults are theirs.
struct SightingSigmas {
  /// Places in `learnt`.
  static constexpr Eigen::Index kYaw = 0;
  static constexpr Eigen::Index kFocal = 1;
  static constexpr Eigen::Index kStandoff = 2;

  /// Of what all sightings get wrong in the same way: mounting's yaw [rad], focal length
  /// (relative), standoff of the markers [m]. Learnt while driving, but for what is 0.
  Eigen::Vector3d learnt{0.0087, 0.002, 0.003};
  double bearing_rad{0.0001};
  double position_m{0.0003};
  double bulge_m{0.002};
  double skew_rad{0.01};

  /// What is to be believed where one of `learnt` is found to be further from what was told than
  /// chance explains: what an error has been found to be is normal, with the variance that it has
  /// lost by that. That one may be as large then as sightings alone say that it is, and nothing is
  /// believed to be better than usual.
  /// @param found      what has been learnt of the errors,
  /// @param variances  what is left open of them,
  /// @param scatter    and how far particles disagree: squares, too.
  /// @return nothing where nothing is contradicted.
  std::optional<SightingSigmas> doubted_by(const Eigen::Vector3d& found,
                                           const Eigen::Vector3d& variances,
                                           const Eigen::Vector3d& scatter) const;

 private:
  SightingSigmas no_better_than_usual() const;
};

}  // namespace waymark
