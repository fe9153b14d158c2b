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

/// Thickness of a border, in units of its profiles' reach, from which on blur of the bits behind it
/// does not change its black level.
inline constexpr double kThickBorder = 1.5;

/// One side of a marker in ideal pixels, from corner to corner, clockwise around the marker.
struct Side {
  Eigen::Vector2d start_px{};
  Eigen::Vector2d end_px{};

  double length_px() const { return (end_px - start_px).norm(); }

  Eigen::Vector2d direction() const { return (end_px - start_px).normalized(); }

  Eigen::Vector2d outward() const { return {direction().y(), -direction().x()}; }
};

/// Brightness along a normal of a side, in equal steps from -reach (inside, the black border) to
/// +reach (outside, the white zone).
struct EdgeProfile {
  double along_px{0.0};  ///< distance from the side's start
  double reach_px{0.0};
  std::vector<double> brightness{};
  bool is_white_behind{false};  ///< the bit behind the border
  double white{0.0};            ///< mean level outside
  double black{0.0};            ///< mean level inside; blur makes a thin border's too bright

  double step_px() const;
  /// Brightness at an offset; linear between the samples, constant beyond them.
  double at(double offset_px) const;
  /// Offset [px, outwards] of the dark-to-bright crossing of a level; the one nearest to the side.
  std::optional<double> crossing_px(double level) const;
  /// Offset [px, outwards] of the ideal step edge with the same mean brightness as the profile in a
  /// window about the crossing. Unlike the crossing itself, which in sharp images is up to 0.09 px
  /// off, it does not depend on the edge's position within a pixel. nullopt without a crossing.
  std::optional<double> edge_px(double black_level, double half_window_px) const;
  /// Standard deviation of the point spread [px], from the distance between the crossings of a
  /// quarter and of three quarters of the edge's height, where bits behind the border hardly
  /// matter.
  std::optional<double> blur_px(double black_level) const;
};

/// Sets the profile's white and black levels.
/// @param border_px  thickness of the border.
void read_levels(EdgeProfile& profile, double border_px);

/// About one profile per pixel along the side, 2 to 80, away from its corners. Profiles that would
/// leave the image are left out.
std::vector<EdgeProfile> sample_profiles(const cv::Mat& gray, const CameraModel& camera,
                                         const Side& side, double reach_px, double border_px);

/// Mean brightness along the parallel at a distance inside a side; nullopt if it leaves the image.
std::optional<double> mean_brightness_inside(const cv::Mat& gray, const CameraModel& camera,
                                             const Side& side, double inside_px);

}  // namespace waymark
