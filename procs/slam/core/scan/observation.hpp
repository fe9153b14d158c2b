// SPDX-License-Identifier: BSD-3-Clause
// Everything that an estimator is given for one scan, or for one moment without a scan.
#pragma once

#include "slam/core/motion/motion.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <vector>

namespace waymark {

struct Observation {
  Timestamp time{};                    ///< of the scan, else of odometry
  double elapsed_s{0.0};               ///< since the observation before, also where clocks were set
  Motion motion{};                     ///< since the observation before; none for the first
  Se2 odom_from_base{};                ///< odometry as it was sent, at this time
  std::vector<AnnotatedBeam> beams{};  ///< none while the LiDAR is silent
  MeanSweep mean_sweep{};
  std::vector<MarkerSighting> sightings{};  ///< of the camera frames since the observation before
  /// The motion begins with late motion (OdometryBuffer): odometry had stood still, and the
  /// observations before had no motion.
  bool odometry_caught_up{false};
  bool odometry_jumped{false};  ///< the motion since the observation before is not known
  bool camera_reported{false};  ///< a frame came since the observation before, even without markers
};

}  // namespace waymark
