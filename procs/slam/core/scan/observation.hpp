// SPDX-License-Identifier: BSD-3-Clause
// Input of an estimator: a scan with the odometry and sightings since the previous observation;
// these alone while the LiDAR is silent.
#pragma once

#include "slam/core/motion/motion.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <vector>

namespace waymark {

struct Observation {
  Timestamp time{};                    ///< of the scan, else of odometry
  double elapsed_s{0.0};               ///< since the previous one, without steps of the clock
  Duration clock_set{};                ///< step of the clock since the previous one
  Motion motion{};                     ///< since the previous observation; none for the first
  Se2 odom_from_base{};                ///< odometry as it was sent, at this time
  std::vector<AnnotatedBeam> beams{};  ///< none while the LiDAR is silent
  MeanSweep mean_sweep{};
  std::vector<MarkerSighting> sightings{};  ///< in the camera frames since the previous observation
  /// The motion begins with late motion (OdometryBuffer): odometry had stood still or jumped about,
  /// and previous observations had no motion.
  bool odometry_caught_up{false};
  bool odometry_jumped{false};  ///< the motion since the previous observation is not known
  bool camera_reported{false};  ///< a frame, even without markers, since the previous observation
};

}  // namespace waymark
