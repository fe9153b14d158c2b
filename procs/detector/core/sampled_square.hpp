// SPDX-License-Identifier: BSD-3-Clause
// The four sides of a marker in an image: brightness across them, border, blur.
#pragma once

#include "common/robot/camera_model.hpp"
#include "detector/core/edge_profile.hpp"

#include <opencv2/core.hpp>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace waymark {

struct SampledSide {
  Side side{};
  double border_px{0.0};  ///< thickness of the black border
  double reach_px{0.0};   ///< half the length of each profile
  std::vector<EdgeProfile> profiles{};
  double blur_px{0.0};  ///< standard deviation of the point spread across the side
  /// Grey level of the quiet zone at both ends of a side whose own quiet zone looks much thinner
  /// than those of its neighbours: of these, near the side.
  std::optional<double> white_beside{};

  /// True when the image is blurred so much that the ends of neighbouring sides are bent. False
  /// also for a thin border (up to 2 px), where blur cannot be measured: the bits behind the border
  /// widen the edge.
  bool is_blurred() const;

  /// Grey levels between which the edge of a profile of this side rises.
  GreyLevels levels(const EdgeProfile& profile, double black) const {
    return {black, white_beside.value_or(profile.white)};
  }

  std::optional<double> edge_px(const EdgeProfile& profile, double black) const {
    return profile.edge_px(levels(profile, black), half_window_px());
  }

  /// Half window for EdgeProfile::edge_px(): wide enough for the blur of the edge, narrow enough to
  /// exclude the blur of the inner bits.
  double half_window_px() const;
};

struct SampledSquare {
  std::array<SampledSide, 4> sides{};
  double black{0.0};  ///< grey level of the black border

  /// Length [px] to leave out at both ends of a side, where the blur of the neighbouring sides
  /// bends the edge; 0 when neither neighbour is blurred.
  double corner_margin_px(std::size_t side) const;

  /// 0 when sides 0 and 2 have thicker borders than sides 1 and 3, in sum; else 1.
  std::size_t thick_side() const;
};

/// @param modules_per_side  bits of the dictionary plus the two of the border.
/// @param reach_px          half length of the profiles; shortened to the border's thickness where
///                          that is smaller, but not below 1.5 px.
SampledSquare sample_square(const cv::Mat& gray, const CameraModel& camera,
                            const std::array<Side, 4>& sides, int modules_per_side,
                            double reach_px);

/// Outward bias [px] that SampledSide::edge_px() has, by the model BlurredSide: white bits behind a
/// thin border brighten it and shift the edge, and so does what lies beyond a narrow quiet zone.
/// nullopt where the model has no edge.
std::optional<double> blur_bias_px(const cv::Mat& gray, const CameraModel& camera,
                                   const SampledSquare& square, std::size_t side);

}  // namespace waymark
