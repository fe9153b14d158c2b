// SPDX-License-Identifier: BSD-3-Clause
// Odometry that counts backing up as driving forward: its encoders do not know the direction.
#pragma once

#include "import/log/imported_log.hpp"

#include <cstdint>
#include <vector>

namespace waymark {

/// Between two scans, where odometry and scans contradict each other about the direction.
struct ReversedStep {
  Timestamp after{};  ///< time of the first scan
  Timestamp until{};  ///< time of the second one
  double distance_m{0.0};
};

/// Consecutive scans are laid over each other with odometry's motion, and with its translation
/// negated; the step is reversed where the latter fits clearly better. A single step is decided by
/// chance sometimes, so it takes a majority of the decided ones among five in a row. Walls along
/// the motion decide nothing.
std::vector<ReversedStep> find_reversed_steps(const ImportedLog& log);

/// Odometry with the translation of these steps negated; headings stay.
std::vector<ImportedPose> with_steps_mended(const std::vector<ImportedPose>& odometry,
                                            const std::vector<ReversedStep>& steps);

}  // namespace waymark
