// SPDX-License-Identifier: BSD-3-Clause
// Model of the brightness across a blurred side of a marker.
#pragma once

#include "detector/core/edge_profile.hpp"

namespace waymark {

/// White zone, black border, and the bits behind it, convolved with a Gaussian point spread.
struct BlurredSide {
  double blur_px{0.0};      ///< standard deviation
  double border_px{0.0};    ///< thickness
  double inner_white{0.0};  ///< share of the bits behind the border that are white

  /// Brightness from 0 (black) to 1 (white) across the side, whose edge is at offset 0.
  EdgeProfile profile(double reach_px) const;

  /// Bias of EdgeProfile::edge_px() [px], positive outwards.
  double bias_px(double reach_px, double black_level, double half_window_px) const;
};

}  // namespace waymark
