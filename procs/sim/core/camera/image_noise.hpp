// SPDX-License-Identifier: BSD-3-Clause
// Sensor noise of the simulated camera.
#pragma once

#include <opencv2/core/mat.hpp>

#include <cstdint>
#include <vector>

namespace waymark {

/// Adds normal noise that is practically independent from pixel to pixel and from frame to frame:
/// each row of a frame takes its noise from a random place in a long precomputed sequence.
class ImageNoise {
 public:
  ImageNoise(double sigma_grey_levels, std::int64_t seed);

  /// Changes an 8-bit picture in place, saturating. About 0.1 ms for 640 x 480 grey.
  void add_to(cv::Mat& picture, std::uint64_t frame) const;

 private:
  double sigma_;
  std::uint64_t seed_;
  std::vector<std::int8_t> sequence_;
};

}  // namespace waymark
