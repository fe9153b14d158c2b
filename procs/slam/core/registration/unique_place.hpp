// SPDX-License-Identifier: BSD-3-Clause
// Global registration that rejects ambiguous places.
#pragma once

#include "slam/core/registration/correlative_search.hpp"

#include <Eigen/Core>

#include <algorithm>
#include <optional>
#include <span>

namespace waymark {

/// Two poses are different places if they differ by at least one of these (the width of a peak).
inline constexpr double kOtherPlace_m = 0.3;
inline constexpr double kOtherPlace_rad = 0.35;

/// Conditions under which the best place of a search counts as unique.
struct UniquePlaceLimits {
  double min_score{0.0};        ///< least score of the best place
  double runner_up_share{1.0};  ///< ratio of scores, runner-up to best place; above it: ambiguous
  double min_runner_up{0.0};    ///< a runner-up with a lower score never counts
  double apart_m{0.5};          ///< places nearer to each other than this,
  double apart_rad{0.3};        ///< and turned by less than this, are one
};

/// The best place in the window, unless there is none or another one fits nearly as well.
inline std::optional<SearchMatch> unique_place(const CorrelativeField& field,
                                               std::span<const Eigen::Vector2d> points_in_base,
                                               const Se2& guess, const SearchWindow& window,
                                               const UniquePlaceLimits& limits) {
  const auto best = field.best(points_in_base, guess, window, limits.min_score);
  if (!best) return std::nullopt;
  const auto runner_up = field.best_apart_from(
      best->submap_from_base, limits.apart_m, limits.apart_rad, points_in_base, guess, window,
      std::max(limits.min_runner_up, limits.runner_up_share * best->score));
  return runner_up ? std::nullopt : best;
}

}  // namespace waymark
