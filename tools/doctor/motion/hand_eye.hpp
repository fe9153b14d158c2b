// SPDX-License-Identifier: BSD-3-Clause
// Where the LiDAR sits and how odometry is scaled, from motions that both have seen.
#pragma once

#include "doctor/motion/lidar_motion.hpp"

#include <optional>

namespace waymark {

/// A number and its standard deviation.
struct Measured {
  double value{0.0};
  double sigma{0.0};
};

/// Turns of odometry over turns of the LiDAR, and how late the LiDAR's stamps are.
struct TurnComparison {
  Measured ratio{};         ///< negative: one of the two is mirrored
  Measured lidar_late_s{};  ///< scans show what odometry shows at the scan's time minus this
  double turned_rad{0.0};   ///< by the LiDAR, all turns without their signs
};

/// Robust least squares over the turns between consecutive scans. The time offset within half a
/// second: first that of whole odometry samples which makes them fit best, then the one at which
/// turns of the odometry do not depend on how its speed of turning changes. nullopt for less than
/// 30 turns, or for a robot that hardly turns (less than a whole turn in all).
std::optional<TurnComparison> compare_turns(const std::vector<LidarTurn>& turns,
                                            const std::vector<ImportedPose>& odometry);

/// Pose of the LiDAR in the base frame, and odometry's distances over the LiDAR's.
struct HandEye {
  Measured x_m{};
  Measured y_m{};
  Measured yaw_rad{};
  Measured scale{};
  int num_motions{0};
};

/// Of A X = X B with A = motion of the base (odometry), B = motion of the LiDAR: translations
/// t_A = s R t_B - (R_A - 1) t are linear in the four numbers s cos(yaw), s sin(yaw), x, y; robust
/// least squares (Cauchy's weights), standard deviations from the residuals of twelve stretches, in
/// which they err together, nowhere below those of independent ones. Source: Censi,
/// Franchi, Marchionni, Oriolo, "Simultaneous calibration of odometry and sensor parameters for
/// mobile robots" (2013), there with the wheels' parameters.
/// @param is_mirrored  the LiDAR's motions are those of a mirror image
/// @param lidar_late   subtracted from the scans' times
/// @return nullopt for less than 30 complete motions
std::optional<HandEye> hand_eye(const std::vector<LidarMotion>& motions,
                                const std::vector<ImportedPose>& odometry, bool is_mirrored,
                                Duration lidar_late);

}  // namespace waymark
