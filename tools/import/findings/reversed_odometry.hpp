// SPDX-License-Identifier: BSD-3-Clause
// Odometry that counts backing up as driving forward, from encoders without direction.
#pragma once

#include "import/findings/body_beams.hpp"
#include "import/log/imported_log.hpp"

#include <vector>

namespace waymark {

/// A step between two scans in which odometry has the wrong direction.
struct ReversedStep {
  Timestamp after{};  ///< time of the first scan
  Timestamp until{};  ///< time of the second one
  double distance_m{0.0};
};

/// Compares each scan with the one before, with odometry's motion and with its translation negated.
/// The score of a step is the logarithm of the misfits' ratio (0 if walls along the motion do not
/// decide). The result is the most likely sequence of the two directions (Viterbi): a reversed
/// sequence has to fit twice as well reversed, and better if the direction changes at high speed.
/// As a check, drives of 0.4 m along all reversed sequences, taken together, have to fit twice as
/// well reversed, too; else the result is empty.
/// @param body  beams to ignore.
std::vector<ReversedStep> find_reversed_steps(const ImportedLog& log, const BodyBeams& body = {});

/// Odometry with the translation of these steps negated; headings stay.
std::vector<ImportedPose> with_steps_corrected(const std::vector<ImportedPose>& odometry,
                                               const std::vector<ReversedStep>& steps);

}  // namespace waymark
