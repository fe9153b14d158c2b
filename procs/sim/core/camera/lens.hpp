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

  /// The pinhole camera to render with: covers the field of view of the lens at its central
  /// resolution; the camera itself when it has no distortion and square pixels.
  const Pinhole& pinhole() const { return pinhole_; }

  /// The camera's picture; shares the memory of its argument when the lens is ideal.
  cv::Mat apply(const cv::Mat& pinhole_picture) const;

 private:
  Pinhole pinhole_;
  cv::Mat source_pixels_;  ///< for each pixel of the camera its position in the pinhole's picture
};

}  // namespace waymark
