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
  /// Share of the truth's time from the first pose on, up to the last pose, and without the gaps in
  /// which the true robot drives more than 2 m.
  double covered_share{};
};

/// @param pairs  of estimate and truth, at least one.
Overlap overlap_of(const Trajectory& estimate, const Trajectory& truth,
                   const std::vector<PosePair>& pairs);

/// Why the errors are not those of the whole run: more than 5 % of the poses outside the truth,
/// less than 95 % of the truth covered, or no pose in its first half. Empty if nothing is wrong.
/// @param truth  name of the truth in the sentences.
std::vector<std::string> problems_of(const Overlap& overlap, std::string_view truth);

/// A sentence if the first pose comes after more than 5 % of the truth's time; this alone is no
/// problem.
std::optional<std::string> late_start_of(const Overlap& overlap, std::string_view truth);

}  // namespace waymark::evaluate
