// SPDX-License-Identifier: BSD-3-Clause
// From an ideal pinhole picture to what the configured lens would have given.
#pragma once

#include "common/robot/robot_config.hpp"
#include "sim/core/camera/renderer.hpp"

#include <opencv2/core/mat.hpp>

namespace waymark {

/// OpenCV's five-parameter lens, and pixels that are not square.
class Lens {
 public:
  explicit Lens(const CameraConfig& camera);

  /// The pinhole that covers everything that the lens sees, at the lens's central resolution; the
  /// camera itself when it has no distortion and square pixels.
  const Pinhole& pinhole() const { return pinhole_; }

  /// The camera's picture; the same memory when there is nothing to bend.
  cv::Mat apply(const cv::Mat& pinhole_picture) const;

 private:
  Pinhole pinhole_;
  cv::Mat source_pixels_;  ///< for each pixel of the camera the place in the pinhole's picture
};

}  // namespace waymark
