// SPDX-License-Identifier: BSD-3-Clause
// Brightness across one side of a marker.
#pragma once

#include "common/robot/camera_model.hpp"

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <optional>
#include <vector>

namespace waymark {

/// Modules from a side to the middle of the bits behind the border.
inline constexpr double kInnerBits = 1.5;

/// Thickness of a border, in reaches of its profiles, from which on the bits behind it do not touch
/// the level of its black.
inline constexpr double kThickBorder = 1.5;

/// One side of a marker in ideal pixels, from corner to corner, clockwise around the marker.
struct Side {
  Eigen::Vector2d start_px{};
  Eigen::Vector2d end_px{};

  double length_px() const { return (end_px - start_px).norm(); }

  Eigen::Vector2d direction() const { return (end_px - start_px).normalized(); }

  Eigen::Vector2d outward() const { return {direction().y(), -direction().x()}; }
};

/// Brightness along the normal of a side at one place of it, at even steps from -reach (inside, the
/// black border) to +reach (outside, the white zone).
struct EdgeProfile {
  double along_px{0.0};  ///< distance from the side's start
  double reach_px{0.0};
  std::vector<double> brightness{};
  bool is_white_behind{false};  ///< the bit behind the border
  double white{0.0};            ///< mean level outside
  double black{0.0};            ///< mean level inside; blur makes a thin border's too bright

  double step_px() const;
  /// Linear between the samples, constant beyond them.
  double at(double offset_px) const;
  /// Offset [px, outwards] of the dark-to-bright crossing of a level that is nearest to the side.
  std::optional<double> crossing_px(double level) const;
  /// Offset of the sharp edge that has as much black and white in a window about the crossing as
  /// the profile. Unlike the crossing itself, which is up to 0.09 px off in sharp images, it does
  /// not depend on where the pixels lie. nullopt where nothing crosses.
  std::optional<double> edge_px(double black_level, double half_window_px) const;
  /// Standard deviation of the point spread across the edge, from how far apart a quarter and three
  /// quarters of its height are crossed; what lies behind the border hardly matters there.
  std::optional<double> blur_px(double black_level) const;
};

/// Brightness levels of a profile across a border of that thickness.
void read_levels(EdgeProfile& profile, double border_px);

/// About one profile per pixel along the side, 2 to 80, away from its corners. Places from which
/// the profile would leave the image are left out.
std::vector<EdgeProfile> sample_profiles(const cv::Mat& gray, const CameraModel& camera,
                                         const Side& side, double reach_px, double border_px);

/// Mean brightness along a line that far inside of a side; nullopt where it leaves the image.
std::optional<double> mean_brightness_inside(const cv::Mat& gray, const CameraModel& camera,
                                             const Side& side, double inside_px);

}  // namespace waymark
