// SPDX-License-Identifier: BSD-3-Clause
// Finds where the position is too uncertain, and where new markers would reduce that.
#pragma once

#include "placement/advice.hpp"
#include "placement/placement_input.hpp"

#include <optional>
#include <string>
#include <vector>

namespace waymark::placement {

struct NewMarker {
  WallPlace place{};
  int id{kNoMarker};
  double worst_after_m{0.0};  ///< largest sigma with this marker and those before it
};

/// A cause, other than missing markers, that keeps sigma above the target.
struct Limit {
  std::string cause{};
  double without_it_m{0.0};  ///< worst sigma with markers everywhere, without that cause
};

struct Placement {
  double target_m{0.0};
  std::vector<Step> steps{};
  std::vector<Eigen::Matrix3d> now{};  ///< predicted covariances with the existing markers
  Advice advice{};
  std::vector<NewMarker> markers{};
  std::vector<Stretch> stretches{};           ///< above the target with the existing markers
  std::optional<double> worst_run_m{};        ///< largest sigma that the run reported
  std::optional<double> model_over_run{};     ///< median over the steps of predicted / reported
  std::optional<std::size_t> worst_run_at{};  ///< the step with worst_run_m
  double across_m{0.0};  ///< largest sigma now of any direction; markers hardly change it
  std::size_t free_places{0};
  std::size_t free_ids{0};
  std::vector<Limit> limits{};  ///< empty if the target is met

  double worst_now_m() const;
  double worst_then_m() const;

  /// Worst sigma with a marker about every 2 m along every wall; the target if they meet it.
  double reachable_m() const;

  bool is_met() const { return worst_then_m() <= target_m; }

  /// By the model the target is met already, but the run reported more: the model is wrong here.
  bool is_model_refuted() const {
    return worst_now_m() <= target_m && worst_run_m && *worst_run_m > target_m;
  }
};

/// @param report  called now and then.
/// @throws SetupError if the marker dictionary is unknown.
Placement place_markers(
    const PlacementInput& input, double target_m, const Report& report = [](const std::string&) {});

}  // namespace waymark::placement
