// SPDX-License-Identifier: BSD-3-Clause
// What scans say of odometry's motion and of the LiDAR's direction: pairs of scans are laid over
// each other with motions that are scaled or turned, and the one that fits best is taken.
#pragma once

#include "import/findings/body_beams.hpp"
#include "import/log/imported_log.hpp"

#include <optional>

namespace waymark {

/// By what odometry's distances have to be multiplied so that scans fit, where that is far from 1:
/// another unit. nullopt where they fit as they are, or scans do not decide.
std::optional<double> odometry_factor(const ImportedLog& log, const BodyBeams& body);

struct YawError {
  double yaw_rad{0.0};
  double sigma_rad{0.0};
};

/// How much further to the left the LiDAR looks than log.robot.lidar.yaw_rad says, up to 30
/// degrees, from where the walls pass by on straight stretches of eight parts of the log; nullopt
/// where fewer than 40 pairs of scans are of such stretches. Assumes that the robot drives where it
/// heads.
std::optional<YawError> lidar_yaw_error(const ImportedLog& log, const BodyBeams& body);

/// Whether scans turn the other way round than odometry: mirrored, they fit its turns much better.
/// False where fewer than 40 pairs of scans are of turns.
bool turns_against_odometry(const ImportedLog& log, const BodyBeams& body);

}  // namespace waymark
