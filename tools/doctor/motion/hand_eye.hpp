// SPDX-License-Identifier: BSD-3-Clause
// Mounting of the LiDAR and scales of odometry, from motions that both have measured.
#pragma once

#include "doctor/motion/lidar_motion.hpp"

#include <optional>

namespace waymark {

/// A measured value with its standard deviation.
struct Measured {
  double value{0.0};
  double sigma{0.0};
};

/// Ratio of odometry's turns to the LiDAR's, and delay of the LiDAR's stamps.
struct TurnComparison {
  Measured ratio{};         ///< negative: one of the two is mirrored
  Measured lidar_late_s{};  ///< delay of the scans' stamps, relative to odometry's clock
  double turned_rad{0.0};   ///< sum of the LiDAR's absolute turns
  /// Correlation of the LiDAR's consecutive turns, see persistence_of().
  double persistence{1.0};
  /// Delay of the scans' stamps that is too long for lidar_late_s, see far_lidar_late_s().
  std::optional<double> far_late_s{};

  /// Whether odometry turns when the LiDAR does.
  bool are_related() const;

  /// The LiDAR turns, but odometry does not then: nothing that compares their motions is right.
  bool are_contradictory() const;
};

/// Robust least squares over the turns between consecutive scans. The time offset is searched
/// within half a second: first the best one in whole odometry samples, then the one at which the
/// residuals do not depend on changes of the turn rate. nullopt for fewer than 30 turns, or for
/// less than one revolution in all.
std::optional<TurnComparison> compare_turns(const std::vector<LidarTurn>& turns,
                                            const std::vector<ImportedPose>& odometry);

/// Pose of the LiDAR in the base frame, and ratio of odometry's distances to the LiDAR's.
struct HandEye {
  Measured x_m{};
  Measured y_m{};
  Measured yaw_rad{};
  Measured scale{};
};

/// Solves A X = X B with A = motion of the base (odometry), B = motion of the LiDAR: translations
/// t_A = s R t_B - (R_A - 1) t are linear in the four numbers s cos(yaw), s sin(yaw), x, y. Robust
/// least squares (Cauchy's weights); standard deviations from twelve parts of the log as clusters,
/// but not below those of independent residuals. Source: Censi, Franchi, Marchionni, Oriolo,
/// "Simultaneous calibration of odometry and sensor parameters for mobile robots" (2013), there
/// with the wheels' parameters.
/// @param is_mirrored  the LiDAR's motions are mirrored.
/// @param lidar_late   subtracted from the scans' times.
/// @return nullopt for fewer than 30 complete motions.
std::optional<HandEye> hand_eye(const std::vector<LidarMotion>& motions,
                                const std::vector<ImportedPose>& odometry, bool is_mirrored,
                                Duration lidar_late);

}  // namespace waymark
