// SPDX-License-Identifier: BSD-3-Clause
// Odometry that counts backing up as driving forward: its encoders do not know the direction.
#pragma once

#include "import/findings/body_beams.hpp"
#include "import/log/imported_log.hpp"

#include <vector>

namespace waymark {

/// Between two scans, where odometry and scans contradict each other about the direction.
struct ReversedStep {
  Timestamp after{};  ///< time of the first scan
  Timestamp until{};  ///< time of the second one
  double distance_m{0.0};
};

/// Each scan is laid over the one before with odometry's motion, and with its translation negated.
/// How much better the latter fits (logarithm of the misfits' ratio, 0 where walls along the motion
/// decide nothing) adds up over stretches of steps: the most likely sequence of the two directions
/// (Viterbi), in which a stretch has to fit twice as well reversed, and more where the direction
/// would change at a speed at which no robot can turn back. None where ways of 0.4 m along all
/// stretches do not fit twice as well, too.
/// @param body  beams that say nothing.
std::vector<ReversedStep> find_reversed_steps(const ImportedLog& log, const BodyBeams& body = {});

/// Odometry with the translation of these steps negated; headings stay.
std::vector<ImportedPose> with_steps_mended(const std::vector<ImportedPose>& odometry,
                                            const std::vector<ReversedStep>& steps);

}  // namespace waymark
