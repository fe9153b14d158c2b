// SPDX-License-Identifier: BSD-3-Clause
// Brightness across one side of a marker.
#pragma once

#include "common/robot/camera_model.hpp"

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <optional>
#include <vector>

namespace waymark {

/// Distance [modules] from the outer edge of the black border to the centres of the first row of
/// bits.
inline constexpr double kInnerBits = 1.5;

/// A black border at least this many times as thick as the reach of its profiles has a black level
/// that the blur of the bits behind it does not change.
inline constexpr double kThickBorder = 1.5;

/// Grey levels that differ by up to this share of the contrast count as the same: a bit as black as
/// the border, a wall as white as the quiet zone.
inline constexpr double kSameGrey = 0.12;

/// Distance of a normal distribution's quartiles, in standard deviations.
inline constexpr double kQuartileDistance = 1.349;

/// One side of a marker's black square in ideal pixels (without lens distortion), from corner to
/// corner, clockwise around the marker.
struct Side {
  Eigen::Vector2d start_px{};
  Eigen::Vector2d end_px{};

  double length_px() const { return (end_px - start_px).norm(); }

  Eigen::Vector2d along() const { return (end_px - start_px).normalized(); }

  Eigen::Vector2d outward() const { return {along().y(), -along().x()}; }
};

struct GreyLevels {
  double black{0.0};
  double white{0.0};
};

/// Grey levels along a line perpendicular to a side, in equal steps from -reach_px (inside, in the
/// black border) to +reach_px (outside, in the white quiet zone).
struct EdgeProfile {
  double along_px{0.0};  ///< distance from the side's start
  double reach_px{0.0};
  std::vector<double> brightness{};
  bool is_white_behind{false};  ///< the bit behind the black border is white
  bool is_white_beyond{true};   ///< one and a half borders outside it is as white, or not in view
  double white{0.0};            ///< mean grey level outside, in the quiet zone
  double black{0.0};  ///< mean grey level in the border; too bright if blurred in a thin border

  double step_px() const;
  /// Grey level at an offset from the side; linear between the samples, constant beyond them.
  double at(double offset_px) const;
  /// Offset [px, outwards] at which the profile rises through a grey level; of several such
  /// crossings the one nearest to the side.
  std::optional<double> crossing_px(double level) const;
  /// Offset [px, outwards] of the ideal black-white step with the same mean grey level as the
  /// profile in a window about its half-height crossing. In sharp images the crossing itself is off
  /// by up to 0.09 px, depending on where in a pixel the edge lies; this offset does not depend on
  /// that. nullopt without a crossing.
  std::optional<double> edge_px(const GreyLevels& levels, double half_window_px) const;
  /// Standard deviation [px] of the point spread across the edge, from the distance between the
  /// crossings at 25 % and 75 % of the step from black to white; the bits behind the border hardly
  /// affect these crossings. nullopt when one of them is missing.
  std::optional<double> blur_px(const GreyLevels& levels) const;
};

/// Sets `white` and `black` of a profile from its samples.
/// @param border_px  thickness of the black border.
void read_levels(EdgeProfile& profile, double border_px);

/// About one profile per pixel of the side's length, 2 to 80 in all, none near its corners.
/// Profiles that would leave the image are left out.
std::vector<EdgeProfile> sample_profiles(const cv::Mat& gray, const CameraModel& camera,
                                         const Side& side, double reach_px, double border_px);

/// Mean grey level along the line parallel to a side, inside_px inside it, without margin_px at
/// both ends; nullopt if that line leaves the image.
std::optional<double> mean_brightness_inside(const cv::Mat& gray, const CameraModel& camera,
                                             const Side& side, double inside_px,
                                             double margin_px = 0.0);

}  // namespace waymark
