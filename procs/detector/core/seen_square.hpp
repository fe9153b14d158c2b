// SPDX-License-Identifier: BSD-3-Clause
// The four sides of a marker in an image: brightness across them, border, blur.
#pragma once

#include "common/robot/camera_model.hpp"
#include "detector/core/edge_profile.hpp"

#include <opencv2/core.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace waymark {

struct SeenSide {
  Side side{};
  double border_px{0.0};  ///< thickness of the black border
  double reach_px{0.0};   ///< of the profiles
  std::vector<EdgeProfile> profiles{};
  double blur_px{0.0};  ///< standard deviation of the point spread across it

  /// More than the pixels' own area. Unknown behind a thin border, where the bits make the edge
  /// look wider than it is.
  bool is_blurred() const;

  /// For EdgeProfile::edge_px(): wide enough to hold the blur of the edge, narrow enough to stay
  /// off the blur of the inner bits.
  double half_window_px() const;
};

struct SeenSquare {
  std::array<SeenSide, 4> sides{};
  double black{0.0};  ///< level of the border

  bool is_blurred() const;

  /// Length at a side's ends that the blur of the neighbouring sides distorts.
  double corner_px(std::size_t side) const;

  /// The first of the two opposite sides with the thicker borders.
  std::size_t thick_side() const;
};

/// @param modules_per_side  bits of the dictionary plus the two of the border.
/// @param reach_px          how far from a side to look; at most the border's thickness.
SeenSquare look_at_square(const cv::Mat& gray, const CameraModel& camera,
                          const std::array<Side, 4>& sides, int modules_per_side, double reach_px);

/// How far off, outwards, edges of a blurred side are found: blur mixes the bits behind a thin
/// border into it (BlurredSide).
double blur_bias_px(const cv::Mat& gray, const CameraModel& camera, const SeenSquare& square,
                    std::size_t side);

}  // namespace waymark
