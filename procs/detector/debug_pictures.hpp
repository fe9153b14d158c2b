// SPDX-License-Identifier: BSD-3-Clause
// Camera frames with the detections drawn on them, as PNG files.
#pragma once

#include "common/sensors/sensors.hpp"

#include <opencv2/core.hpp>

#include <cstdint>
#include <filesystem>

namespace waymark {

/// The frame in colour, with outline, first corner, id and range of each marker drawn on it.
cv::Mat annotated(const cv::Mat& gray, const MarkerDetections& detections);

class DebugPictures {
 public:
  /// @throws SetupError when the folder cannot be made.
  DebugPictures(std::filesystem::path folder, int every);

  /// Writes every `every`-th frame as frame_<utime>.png. @return false when writing failed.
  bool offer(const cv::Mat& gray, const MarkerDetections& detections);

 private:
  std::filesystem::path folder_;
  int every_;
  std::int64_t frames_{0};
};

}  // namespace waymark
