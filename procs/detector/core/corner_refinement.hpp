// SPDX-License-Identifier: BSD-3-Clause
// Second stage: corners to a few hundredths of a pixel, by fitting the marker's whole pattern to
// the grey levels of the image.
#pragma once

#include "common/config/fields.hpp"
#include "common/robot/camera_model.hpp"
#include "detector/core/marker_candidates.hpp"
#include "detector/core/marker_pattern.hpp"

#include <Eigen/Core>
#include <opencv2/core.hpp>

namespace waymark {

struct RefinementConfig {
  double min_contrast{15.0};
  double max_residual{0.25};
  double max_unexplained_share{0.05};
  double max_move_px{5.0};
  double corner_sigma_px{0.008};
  double unrefined_sigma_px{0.8};

  void describe(Fields& fields);
};

/// Corners with their covariance.
struct MeasuredCorners {
  Corners ideal_px{};  ///< without lens distortion
  /// [px^2]; rows and columns in the order u0 v0 u1 v1 u2 v2 u3 v3.
  Eigen::Matrix<double, 8, 8> covariance{Eigen::Matrix<double, 8, 8>::Identity()};
  bool refined{false};
  double blur_px{0.0};  ///< if refined: standard deviation of the lens's and the motion's blur
};

/// Fits homography, blur and light (PatternView) to the grey levels of the pixels near the borders
/// between black and white, by least squares with Cauchy's weights (Levenberg-Marquardt). All edges
/// of the marker count, not only its outline; white bits behind a thin border, a narrow quiet zone,
/// blur and uneven light are part of the model. Works in ideal pixels, where lens distortion does
/// not bend lines. If contrast is too low, the pattern does not fit (another
/// marker, a shadow across it), or a corner would move too
/// far, all four corners stay where they were, with the standard deviation unrefined_sigma_px.
///
/// @param gray            8-bit, one channel.
/// @param raw_corners_px  from the first stage: at most about two pixels off, and at places where
///                        the lens distortion can be inverted.
MeasuredCorners refine_corners(const cv::Mat& gray, const CameraModel& camera,
                               const Corners& raw_corners_px, const MarkerPattern& pattern,
                               const RefinementConfig& config);

}  // namespace waymark
