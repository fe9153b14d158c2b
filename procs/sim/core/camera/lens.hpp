// SPDX-License-Identifier: BSD-3-Clause
// Converts pinhole pictures to pictures of the configured lens.
#pragma once

#include "common/robot/robot_config.hpp"
#include "sim/core/camera/renderer.hpp"

#include <opencv2/core/mat.hpp>

namespace waymark {

/// OpenCV's five-parameter lens, also with pixels that are not square.
class Lens {
 public:
  explicit Lens(const CameraConfig& camera);

  /// The pinhole camera to render with: it covers the field of view of the configured lens at the
  /// resolution of the image centre. Without distortion and with square pixels it is that camera.
  const Pinhole& pinhole() const { return pinhole_; }

  /// Converts the pinhole's picture to that of the configured camera. Shares the argument's memory
  /// when the lens has no distortion and square pixels.
  cv::Mat apply(const cv::Mat& pinhole_picture) const;

 private:
  Pinhole pinhole_;
  cv::Mat source_pixels_;  ///< where in the pinhole's picture each pixel comes from
};

}  // namespace waymark
