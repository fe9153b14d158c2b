// SPDX-License-Identifier: BSD-3-Clause
// Where the estimate is too uncertain, and where new markers would cure it.
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
  double worst_after_m{0.0};  ///< with the ones before it
};

/// What limits where no marker helps.
struct Limit {
  std::string cause{};
  double without_it_m{0.0};  ///< worst sigma with a marker everywhere, if that were exact
};

struct Placement {
  double target_m{0.0};
  std::vector<Step> steps{};
  std::vector<Eigen::Matrix3d> now{};  ///< predicted, with the markers that hang, by step
  Advice advice{};
  std::vector<NewMarker> markers{};
  std::vector<Stretch> stretches{};           ///< above the target now, by the model
  std::optional<double> worst_run_m{};        ///< what the run itself has shown at the steps
  std::optional<double> model_over_run{};     ///< median of the ratio of sigmas over the steps
  std::optional<std::size_t> worst_run_at{};  ///< step
  double across_m{0.0};  ///< worst sigma of any direction now: what markers hardly change
  std::size_t free_places{0};
  std::size_t free_ids{0};
  std::vector<Limit> limits{};  ///< none where the target is met

  double worst_now_m() const;
  double worst_then_m() const;
  double reachable_m()
      const;  ///< worst sigma with a marker everywhere; the target if that meets it

  bool is_met() const { return worst_then_m() <= target_m; }

  /// Met by the model as it is, but not in the run: the model does not hold for it.
  bool is_model_refuted() const {
    return worst_now_m() <= target_m && worst_run_m && *worst_run_m > target_m;
  }
};

/// @throws evaluate::InputError where the dictionary is not known.
Placement place_markers(const PlacementInput& input, double target_m);

}  // namespace waymark::placement
