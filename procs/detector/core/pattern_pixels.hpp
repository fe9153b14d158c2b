// SPDX-License-Identifier: BSD-3-Clause
// The pixels of a marker that tell where it lies.
#pragma once

#include "common/robot/camera_model.hpp"
#include "detector/core/marker_candidates.hpp"
#include "detector/core/marker_pattern.hpp"

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include <cstddef>
#include <vector>

namespace waymark {

struct GreyPixel {
  Eigen::Vector2d ideal_px{};
  double grey{0.0};
};

inline constexpr std::size_t kMostPatternPixels = 1000;  ///< more say little more, and cost time

/// Up to kMostPatternPixels pixels near borders between black and white; the first of them, however
/// many, are spread evenly over the marker. Chosen as if the lens did not bend the marker's sides.
/// Empty where corners_px is no view of a square.
/// @param gray            8-bit, one channel.
/// @param raw_corners_px  of the black square.
std::vector<GreyPixel> pixels_near_borders(const cv::Mat& gray, const CameraModel& camera,
                                           const Corners& raw_corners_px,
                                           const MarkerPattern& pattern);

}  // namespace waymark
