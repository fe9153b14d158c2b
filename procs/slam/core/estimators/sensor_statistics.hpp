// SPDX-License-Identifier: BSD-3-Clause
// What a run has learnt about its sensors, and counts of their data.
#pragma once

#include "slam/core/localisation/loaded_map_fit.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace waymark {

/// A term of the calibration (kCalibrationTerms) that differs significantly from the description.
struct Miscalibration {
  std::size_t term{0};
  double error{0.0};  ///< estimated minus described
  double sigma{0.0};  ///< standard deviation of `error`
};

/// Learnt noise, and counts over a run.
struct SensorStatistics {
  std::int64_t observations{0};

  double odometry_along{1.0};        ///< sigma of the random walk along the path / described sigma
  double odometry_turn{1.0};         ///< sigma of the heading's random walk / described sigma
  std::int64_t slips{0};             ///< wheel slips that markers have observed
  double slip_m_per_sqrt_m{0.0};     ///< sigma that slips add to the random walk along the path
  std::int64_t odometry_stuck{0};    ///< observations: odometry stood still while the robot moved
  std::int64_t odometry_jumping{0};  ///< observations: odometry jumped, or was too fast
  std::int64_t odometry_caught_up{0};  ///< observations: odometry reported motion late

  double range_sigma_m{0.0};  ///< learnt from the scatter of ranges about walls
  double described_range_sigma_m{0.0};
  std::int64_t scans{0};           ///< scans with returns that were matched with a map
  std::int64_t scans_unusable{0};  ///< of these, with too few inliers, or with unobserved heading
  std::int64_t scans_refuted{0};   ///< of these, with mostly outliers among the mapped beams
  std::int64_t scans_rescaled{0};  ///< of these, fit only with scaled ranges
  double range_scale_error{0.0};   ///< of the last rescaled scan, see RangeScale::error
  std::int64_t beams{0};           ///< with returns
  std::int64_t beams_moving{0};    ///< of these, ended in free space and were left out of matching

  LoadedMapFit loaded_map{};

  std::int64_t loops_ambiguous{0};  ///< matches that fitted at several places and closed no loop
  std::int64_t relocalisations{0};
  std::vector<Miscalibration> miscalibrated{};
};

}  // namespace waymark
