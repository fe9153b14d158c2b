// SPDX-License-Identifier: BSD-3-Clause
// What a run has learnt about its sensors, compared with their description.
#pragma once

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
struct Findings {
  std::int64_t observations{0};

  double odometry_along{1.0};  ///< sigma of the random walk along the path, relative to described
  double odometry_turn{1.0};   ///< sigma of the heading's random walk, likewise
  std::int64_t slips{0};       ///< wheel slips that markers have observed
  double slip_m_per_sqrt_m{0.0};       ///< sigma that slips add along the path
  std::int64_t odometry_stuck{0};      ///< observations while only odometry stood still
  std::int64_t odometry_jumping{0};    ///< at which odometry jumped, or was too fast
  std::int64_t odometry_caught_up{0};  ///< at which odometry reported motion late

  double range_sigma_m{0.0};            ///< of the LiDAR, from the scatter about walls
  double described_range_sigma_m{0.0};  ///< as described
  std::int64_t scans{0};                ///< with returns, matched with a map
  std::int64_t scans_unusable{0};       ///< too few inliers, or heading unobserved
  std::int64_t scans_refuted{0};        ///< most beams on mapped walls are outliers
  std::int64_t scans_rescaled{0};       ///< fit only with scaled ranges
  double range_share{0.0};              ///< by which the last such scan's ranges were too long
  std::int64_t beams{0};                ///< with returns
  std::int64_t beams_moving{0};         ///< of these, ended where the map is free

  std::int64_t scans_in_loaded_map{0};          ///< at keyframes, enough beams compared with it
  std::int64_t scans_contradict_loaded_map{0};  ///< of these

  std::int64_t loops_ambiguous{0};  ///< fitted at several places, and were not closed
  std::int64_t relocalisations{0};
  std::vector<Miscalibration> miscalibrated{};
};

}  // namespace waymark
