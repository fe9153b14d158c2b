// SPDX-License-Identifier: BSD-3-Clause
// Model of the brightness across a blurred side of a marker.
#pragma once

#include "detector/core/edge_profile.hpp"

namespace waymark {

/// EdgeProfile::blur_px() of an edge in a sharp image.
inline constexpr double kSharpPx = 0.64;

/// Brightness across a side: what lies beyond the quiet zone, quiet zone (white), border (black)
/// and first bits, blurred by pixels and lens. The quiet zone is as thick as the border.
struct BlurredSide {
  double blur_px{0.0};      ///< EdgeProfile::blur_px() of an edge alone; at least kSharpPx
  double border_px{0.0};    ///< thickness of the black border
  double inner_white{0.0};  ///< share of the bits behind the border that are white
  double outer_white{1.0};  ///< brightness beyond the quiet zone; 1: the quiet zone is wider

  /// Brightness from 0 (black) to 1 (white) across the side, whose edge is at offset 0.
  EdgeProfile profile(double reach_px) const;
};

}  // namespace waymark
