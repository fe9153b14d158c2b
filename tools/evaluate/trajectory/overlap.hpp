// SPDX-License-Identifier: BSD-3-Clause
// How much of the truth an estimated trajectory covers.
#pragma once

#include "evaluate/trajectory/trajectory_error.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark::evaluate {

struct Overlap {
  std::size_t poses{};    ///< number of poses of the estimate
  std::size_t outside{};  ///< how many of them lie outside the truth's time span
  double truth_s{};       ///< duration of the truth
  double first_pose_s{};  ///< time of the first pose inside, since the truth's begin
  /// Share of the time from the first pose to the end of the truth that is covered. Not covered:
  /// after the last pose, and between poses more than 2 m of true travel apart.
  double covered_share{};
};

/// @param pairs  of estimate and truth, at least one.
Overlap overlap_of(const Trajectory& estimate, const Trajectory& truth,
                   const std::vector<PosePair>& pairs);

/// Why the errors are not those of the whole run: more than 5 % of the poses outside the truth,
/// less than 95 % of the truth covered, or no pose in its first half. Empty if nothing is wrong.
/// @param truth  name of the truth in the sentences.
std::vector<std::string> problems_of(const Overlap& overlap, std::string_view truth);

/// A sentence if the first pose comes after more than 5 %, but at most half, of the truth's time:
/// no problem, but worth a note. problems_of() reports later starts.
std::optional<std::string> late_start_of(const Overlap& overlap, std::string_view truth);

}  // namespace waymark::evaluate
