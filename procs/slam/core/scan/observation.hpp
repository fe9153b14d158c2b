// SPDX-License-Identifier: BSD-3-Clause
// Input of an estimator: a scan with the odometry and sightings since the previous observation;
// while the LiDAR is silent, odometry and sightings alone.
#pragma once

#include "slam/core/motion/motion.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <vector>

namespace waymark {

struct Observation {
  Timestamp time{};       ///< of the scan; while the LiDAR is silent, of an odometry sample
  double elapsed_s{0.0};  ///< since the previous observation, without steps of the clock
  Duration clock_set{};   ///< step of the clock since the previous observation
  Motion motion{};        ///< since the previous observation; none for the first
  Se2 odom_from_base{};   ///< odometry as it was sent, at this time
  std::vector<AnnotatedBeam> beams{};  ///< none while the LiDAR is silent
  MeanSweep mean_sweep{};
  std::vector<MarkerSighting> sightings{};  ///< in the camera frames since the previous observation
  /// `motion` begins with motion that odometry reported late (OdometryBuffer::late_motion());
  /// previous observations have no motion for that time.
  bool odometry_caught_up{false};
  bool odometry_jumped{false};  ///< part of `motion` is unknown, unless odometry_caught_up
  bool camera_reported{false};  ///< since the previous observation; frames without markers count
};

}  // namespace waymark
