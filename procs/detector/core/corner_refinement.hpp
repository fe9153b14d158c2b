// SPDX-License-Identifier: BSD-3-Clause
// Second stage: corners to a few hundredths of a pixel, as intersections of lines fitted to the
// marker's edges.
#pragma once

#include "common/config/fields.hpp"
#include "common/robot/camera_model.hpp"
#include "detector/core/marker_candidates.hpp"

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace waymark {

struct RefinementConfig {
  double reach_px{3.0};
  double min_contrast{15.0};
  int min_points{4};
  double max_residual_px{0.35};
  double max_move_px{5.0};
  double side_sigma_px{0.01};
  double thin_border_sigma_px{0.8};
  double unrefined_sigma_px{0.8};

  void describe(Fields& fields);
};

/// Corners with their covariance.
struct MeasuredCorners {
  Corners ideal_px{};  ///< without lens distortion
  /// [px^2]; rows and columns in the order u0 v0 u1 v1 u2 v2 u3 v3.
  Eigen::Matrix<double, 8, 8> covariance{Eigen::Matrix<double, 8, 8>::Identity()};
  bool refined{false};
};

/// Finds points on the black-white edge along the four sides of a marker, fits a line to each side,
/// and intersects neighbouring lines. Works in ideal pixels, where lens distortion does not bend
/// lines. If a side has too few edge points, or these scatter too much, or a corner would move too
/// far, all four corners stay where they were, with the standard deviation unrefined_sigma_px.
///
/// @param gray                8-bit, one channel.
/// @param raw_corners_px      from the first stage: at most about two pixels off, and at places
///                            where the lens distortion can be inverted.
/// @param modules_per_side    bits of the dictionary plus the two of the border.
MeasuredCorners refine_corners(const cv::Mat& gray, const CameraModel& camera,
                               const Corners& raw_corners_px, int modules_per_side,
                               const RefinementConfig& config);

}  // namespace waymark
