// SPDX-License-Identifier: BSD-3-Clause
// Model of a marker's blurred side.
#pragma once

#include "detector/core/edge_profile.hpp"

namespace waymark {

/// White, the black border, and the bits behind it, seen through a Gaussian point spread.
struct BlurredSide {
  double blur_px{0.0};      ///< standard deviation
  double border_px{0.0};    ///< thickness
  double inner_white{0.0};  ///< share of the bits behind the border that are white

  /// Black is 0, white is 1, and the edge lies at 0.
  EdgeProfile profile(double reach_px) const;

  /// Bias of EdgeProfile::edge_px(), outwards.
  double bias_px(double reach_px, double black_level, double half_window_px) const;
};

}  // namespace waymark
