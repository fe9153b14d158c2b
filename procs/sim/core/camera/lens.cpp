// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/camera/lens.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace waymark {
namespace {

bool is_ideal(const CameraConfig& camera) {
  return camera.fx_px == camera.fy_px &&
         std::all_of(camera.distortion.begin(), camera.distortion.end(),
                     [](double k) { return k == 0.0; });
}

/// (x/z, y/z) of each pixel's ray, row by row.
std::vector<cv::Point2d> rays(const CameraConfig& camera) {
  std::vector<cv::Point2d> pixels;
  for (int v = 0; v < camera.height_px; ++v)
    for (int u = 0; u < camera.width_px; ++u)
      pixels.emplace_back(u, v);
  const cv::Matx33d intrinsics{camera.fx_px, 0.0, camera.cx_px, 0.0, camera.fy_px,
                               camera.cy_px, 0.0, 0.0,          1.0};
  const cv::TermCriteria until_exact{cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-9};
  std::vector<cv::Point2d> found;
  cv::undistortPoints(pixels, found, intrinsics, camera.distortion, cv::noArray(), cv::noArray(),
                      until_exact);
  return found;
}

}  // namespace

Lens::Lens(const CameraConfig& camera)
    : pinhole_{camera.width_px, camera.height_px, camera.fx_px, camera.cx_px, camera.cy_px} {
  if (is_ideal(camera)) return;
  const std::vector<cv::Point2d> all_rays = rays(camera);
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;
  for (const cv::Point2d& ray : all_rays) {
    left = std::min(left, ray.x);
    right = std::max(right, ray.x);
    top = std::min(top, ray.y);
    bottom = std::max(bottom, ray.y);
  }
  constexpr int kMargin_px = 2;
  const double focal = std::max(camera.fx_px, camera.fy_px);
  pinhole_.focal_px = focal;
  pinhole_.cx_px = std::ceil(-left * focal) + kMargin_px;
  pinhole_.cy_px = std::ceil(-top * focal) + kMargin_px;
  pinhole_.width_px = static_cast<int>(pinhole_.cx_px + std::ceil(right * focal)) + kMargin_px;
  pinhole_.height_px = static_cast<int>(pinhole_.cy_px + std::ceil(bottom * focal)) + kMargin_px;

  source_pixels_.create(camera.height_px, camera.width_px, CV_32FC2);
  std::transform(all_rays.begin(), all_rays.end(), source_pixels_.begin<cv::Vec2f>(),
                 [this](const cv::Point2d& ray) {
                   return cv::Vec2f{static_cast<float>(pinhole_.cx_px + pinhole_.focal_px * ray.x),
                                    static_cast<float>(pinhole_.cy_px + pinhole_.focal_px * ray.y)};
                 });
}

cv::Mat Lens::apply(const cv::Mat& pinhole_picture) const {
  if (source_pixels_.empty()) return pinhole_picture;
  cv::Mat distorted;
  cv::remap(pinhole_picture, distorted, source_pixels_, cv::noArray(), cv::INTER_LINEAR);
  return distorted;
}

}  // namespace waymark
