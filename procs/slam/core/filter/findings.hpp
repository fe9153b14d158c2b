// SPDX-License-Identifier: BSD-3-Clause
// What a run has shown of its sensors, beside what they are described as.
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

/// Counts are of observations.
struct Findings {
  std::int64_t observations{0};

  double odometry_along{1.0};  ///< random walk along the way, in multiples of the described one
  double odometry_turn{1.0};   ///< and of the heading
  std::int64_t slips{0};       ///< of the wheels, that markers showed
  double slip_m_per_sqrt_m{0.0};
  std::int64_t odometry_stuck{0};      ///< it stood still while the robot moved
  std::int64_t odometry_jumping{0};    ///< it was anything
  std::int64_t odometry_caught_up{0};  ///< times that it said late what had been driven

  double range_sigma_m{0.0};            ///< of the LiDAR, as the walls show it
  double described_range_sigma_m{0.0};  ///< as it is described
  std::int64_t scans{0};                ///< with returns, compared with a map
  std::int64_t scans_unusable{0};       ///< show too few mapped surfaces
  std::int64_t scans_refuted{0};        ///< show something else than what is mapped there
  std::int64_t scans_rescaled{0};       ///< fit when their ranges are scaled
  double range_share{0.0};              ///< by which they were too long, of the last such scan
  std::int64_t beams{0};                ///< with returns
  std::int64_t beams_moving{0};         ///< of these, ended where the map is free

  std::int64_t scans_in_loaded_map{0};          ///< at keyframes, where a map was loaded
  std::int64_t scans_contradict_loaded_map{0};  ///< of these

  std::int64_t loops_ambiguous{0};  ///< that fitted in several places, and were not closed
  std::int64_t relocalisations{0};
  std::vector<Miscalibration> miscalibrated{};
};

}  // namespace waymark
