// SPDX-License-Identifier: BSD-3-Clause
// Parameters of the estimator `waymark`.
#pragma once

#include "common/geometry/chi2.hpp"
#include "slam/core/graph/loop_finder.hpp"
#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/core/motion/odometry_errors.hpp"
#include "slam/core/registration/scan_match.hpp"

namespace waymark {

class Fields;

struct WaymarkConfig {
  double keyframe_distance_m{0.15};
  double keyframe_turn_rad{0.15};
  double marker_keyframe_distance_m{0.05};
  double insert_distance_m{0.04};
  int window_keyframes{48};
  int submap_keyframes{40};
  double submap_length_m{9.0};
  int keyframes_per_place{60};
  bool learn_noise{true};
  bool calibrate{true};
  double marker_gate{kChi2Gate3};
  double same_marker_within_m{0.15};
  double lost_inlier_share{0.3};
  double min_inlier_share{0.5};
  OdometryNoise odometry{};
  ScanMatchConfig scan{};
  MarkerMeasurementConfig markers{};
  LoopConfig loops{};

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

}  // namespace waymark
