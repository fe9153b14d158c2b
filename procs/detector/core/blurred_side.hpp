// SPDX-License-Identifier: BSD-3-Clause
// Model of the brightness across a blurred side of a marker.
#pragma once

#include "detector/core/edge_profile.hpp"

namespace waymark {

/// Brightness across a side: quiet zone (white), border (black) and first bits, blurred by a
/// Gaussian.
struct BlurredSide {
  double blur_px{0.0};      ///< standard deviation of the Gaussian
  double border_px{0.0};    ///< thickness of the black border
  double inner_white{0.0};  ///< share of the bits behind the border that are white

  /// Brightness from 0 (black) to 1 (white) across the side, whose edge is at offset 0.
  EdgeProfile profile(double reach_px) const;

  /// What EdgeProfile::edge_px() returns for this model, whose true edge is at 0: its bias [px],
  /// positive outwards.
  double bias_px(double reach_px, double black_level, double half_window_px) const;
};

}  // namespace waymark
