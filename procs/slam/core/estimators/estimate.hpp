// SPDX-License-Identifier: BSD-3-Clause
// Output of an estimator after a scan.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/health/health.hpp"
#include "common/time/time.hpp"
#include "slam/core/scan/observability.hpp"
#include "slam/core/scan/observation.hpp"

#include <Eigen/Core>

#include <cstdint>

namespace waymark {

/// What determined the estimate, in ascending precedence: the last of these that applies. Values as
/// in lcmtypes/correction_t.lcm.
enum class EstimateReason { kOdometry, kScan, kMarker, kLoop, kRelocalised, kSurvey, kCommand };

struct Estimate {
  Timestamp time{};
  bool has_pose{true};  ///< false: the pose in the loaded map or survey frame is not known yet
  Se2 map_from_base{};
  /// [m^2, m rad, rad^2] order x y theta, map frame.
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
  Health health{Health::kInitialising};
  std::size_t num_particles{1};
  double effective_particles{1.0};
  int beams_on_markers{0};
  int markers_in_view{0};
  Observability observability{};
  WeakAxisSource weak_axis_source{WeakAxisSource::kUnknown};
  EstimateReason reason{EstimateReason::kScan};
  bool updated{false};  ///< the scan updated the filter, or became a keyframe
  /// The odometry's newest step was rejected: scans contradict it (gmapping), or it exceeds the
  /// robot's speed limits (waymark).
  bool odometry_refused{false};
  /// Most scans contradict the pose in the loaded map, and no marker has confirmed it.
  bool start_refuted{false};
  bool ranges_wrong{false};  ///< the scan fits known walls only at another scale: it was scaled
  /// A calibration term is further from its description than its standard deviation allows
  /// (CalibrationKnowledge::doubted_terms).
  bool calibration_widened{false};
};

/// Health after `updates` updates; two are needed for more than kInitialising.
/// @param observes_all_axes  walls or markers observe the motion in every direction.
Health health_of(std::uint64_t updates, bool is_lost, bool observes_all_axes);

/// An estimate with the fields that follow from the observation and the pose alone.
Estimate describe_observation(const Observation& observation, const Se2& map_from_base,
                              double range_sigma_m);

}  // namespace waymark
