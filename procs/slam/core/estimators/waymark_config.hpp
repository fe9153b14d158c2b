// SPDX-License-Identifier: BSD-3-Clause
// The settings of waymark.
#pragma once

#include "slam/core/belief/odometry_errors.hpp"
#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/core/matching/surface_matching.hpp"

namespace waymark {

class Fields;

struct WaymarkConfig {
  int particles{30};
  double resample_threshold{0.5};  ///< share of effective particles below which to resample
  double update_distance_m{0.1};   ///< scans in between are followed by odometry
  double update_turn_rad{0.0873};
  double marker_gate{16.3};          ///< chi^2 of a sighting's innovation, 3 degrees of freedom
  double marker_near_m{0.25};        ///< off by less, it is believed, too, but counts less
  double same_marker_within_m{0.5};  ///< no second marker of one id nearer than this
  int joint_markers{48};             ///< in each particle's covariance; the others are settled
  double scan_evidence{0.1};         ///< share of a scan's log-likelihood that weighs particles
  double marker_evidence{0.02};      ///< the same of a sighting
  double evidence_knee{5.0};         ///< [nat] less than the best: half of it weighs
  /// Factor on the paper's score of the ids in the map's cells, as log weight.
  double id_layer_evidence{0.0};
  /// Markers correct each particle's pose. Else the whole pose is drawn before they are looked at,
  /// and they only weigh it.
  bool markers_in_proposal{true};
  /// Share of a pose's standard deviations that is drawn. The map drift knows the variance, and 30
  /// particles that are drawn again and again make a random walk of it.
  double drawn_spread{0.3};
  double lost_agreement{0.3};  ///< share of the mapped beams; below: lost
  OdometryNoise odometry{};
  SurfaceMatchingConfig matching{};
  MarkerMeasurementConfig markers{};

  void describe(Fields& fields);
};

}  // namespace waymark
