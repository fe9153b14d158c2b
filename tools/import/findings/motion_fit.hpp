// SPDX-License-Identifier: BSD-3-Clause
// Checks odometry's scale and the LiDAR's yaw by scans: pairs of scans are compared with odometry's
// motion scaled or rotated, and the best fit is taken.
#pragma once

#include "import/findings/body_beams.hpp"
#include "import/log/imported_log.hpp"

#include <optional>

namespace waymark {

/// Factor by which odometry's distances have to be multiplied for the scans to fit, if it is far
/// from 1 (another unit). nullopt if it is near 1 or the scans do not determine it.
std::optional<double> odometry_factor(const ImportedLog& log, const BodyBeams& body);

struct YawError {
  double yaw_rad{0.0};
  double sigma_rad{0.0};
};

/// True minus described yaw of the LiDAR, up to 30 degrees, from straight drives in eight parts of
/// the log; nullopt with fewer than 40 pairs of scans on straight drives, and where the scans of a
/// part fit equally well with any yaw. Assumes that the robot drives along its heading.
std::optional<YawError> lidar_yaw_error(const ImportedLog& log, const BodyBeams& body);

/// True if scans turn in the opposite direction to odometry: mirrored, they fit its turns much
/// better. False with fewer than 40 pairs of scans on turns.
bool turns_against_odometry(const ImportedLog& log, const BodyBeams& body);

}  // namespace waymark
