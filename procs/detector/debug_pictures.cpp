// SPDX-License-Identifier: BSD-3-Clause
#include "detector/debug_pictures.hpp"

#include "common/files/whole_file.hpp"
#include "common/node/node.hpp"
#include "common/pictures/png.hpp"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace waymark {
namespace {

const cv::Scalar kOutlineColor{0, 200, 0};
const cv::Scalar kFirstCornerColor{0, 0, 255};
constexpr int kSubPixelBits = 4;  // OpenCV draws at fixed-point positions

cv::Point fixed_point(const Eigen::Vector2d& pixel) {
  constexpr double kScale = 1 << kSubPixelBits;
  return {static_cast<int>(std::lround(pixel.x() * kScale)),
          static_cast<int>(std::lround(pixel.y() * kScale))};
}

}  // namespace

cv::Mat annotated(const cv::Mat& gray, const MarkerDetections& detections) {
  cv::Mat picture;
  cv::cvtColor(gray, picture, cv::COLOR_GRAY2BGR);
  for (const MarkerDetection& marker : detections.detections) {
    std::vector<cv::Point> outline;
    for (const Eigen::Vector2d& corner : marker.corners_px)
      outline.push_back(fixed_point(corner));
    cv::polylines(picture, outline, true, kOutlineColor, 1, cv::LINE_AA, kSubPixelBits);
    cv::circle(picture, outline[0], 3 << kSubPixelBits, kFirstCornerColor, 1, cv::LINE_AA,
               kSubPixelBits);
    const std::string label =
        fmt::format("{} {:.2f} m", marker.id, marker.base_from_marker.translation().norm());
    const cv::Point below{static_cast<int>(marker.corners_px[3].x()),
                          static_cast<int>(marker.corners_px[3].y()) + 14};
    cv::putText(picture, label, below, cv::FONT_HERSHEY_SIMPLEX, 0.45, kOutlineColor, 1,
                cv::LINE_AA);
  }
  return picture;
}

DebugPictures::DebugPictures(std::filesystem::path folder, int every)
    : folder_{std::move(folder)}, every_{every} {
  std::error_code problem;
  std::filesystem::create_directories(folder_, problem);
  if (problem) {
    throw SetupError{fmt::format("detector.debug_dir: cannot make the folder {}: {}",
                                 folder_.string(), problem.message())};
  }
}

bool DebugPictures::offer(const cv::Mat& gray, const MarkerDetections& detections) {
  if (frames_++ % every_ != 0) return true;
  const auto file = folder_ / fmt::format("frame_{:012d}.png", to_us(detections.time));
  try {
    write_whole_file(file, png_bytes(annotated(gray, detections)));
  } catch (const std::system_error&) {
    return false;
  }
  return true;
}

}  // namespace waymark
