// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/camera/camera.hpp"

#include "common/geometry/angle.hpp"
#include "common/pictures/jpeg.hpp"
#include "sim/core/random_streams.hpp"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>

namespace waymark {
namespace {

constexpr int kQualityStep = 5;
// Largest picture of random values with one value per pixel: the JPEG of such a picture has 46 kB.
// Larger pictures fit a datagram only with one value per JPEG block.
constexpr std::size_t kMaxSinglePixels = 640 * 480;
constexpr int kJpegBlock_px = 8;

}  // namespace

void CameraNoiseConfig::describe(Fields& fields) {
  fields.field("sigma_grey_levels", sigma_grey_levels, {0.0, 40.0}, "sensor noise per pixel");
  fields.field("blur_sigma_px", blur_sigma_px, {0.0, 20.0}, "Gaussian blur of the lens; 0 = none");
  fields.field("exposure_s", exposure_s, {0.0, 1.0},
               "the picture is the mean over this time around its stamp; 0 = an instant");
  fields.choice("colour", colour, {{"grey", ImageColour::kGrey}, {"colour", ImageColour::kColour}},
                "what is compressed");
  fields.field("jpeg_quality", jpeg_quality, {10, 100},
               "quality to begin with; lowered for a frame that does not fit a datagram");
}

void CameraErrorConfig::describe(Fields& fields) {
  fields.field("focal_share", focal_share, {-0.5, 0.5},
               "true focal length is longer by this share");
  fields.field("yaw_deg", yaw_deg, {-45.0, 45.0}, "mounted further to the left by this");
  fields.field("pitch_deg", pitch_deg, {-45.0, 45.0}, "mounted further down by this");
  fields.field("focal_sigma", focal_sigma, {0.0, 0.1},
               "standard deviation of focal_share over runs: the seed draws");
  fields.field("yaw_sigma_deg", yaw_sigma_deg, {0.0, 10.0}, "the same of yaw_deg");
}

CameraConfig real_camera(const CameraConfig& nominal, const CameraErrorConfig& errors,
                         std::int64_t seed) {
  Random random{static_cast<std::uint64_t>(seed), random_streams::kCameraErrors};
  const double longer = 1.0 + random.normal(errors.focal_share, errors.focal_sigma);
  CameraConfig real = nominal;
  real.fx_px *= longer;
  real.fy_px *= longer;
  real.yaw_rad += radians(random.normal(errors.yaw_deg, errors.yaw_sigma_deg));
  real.pitch_rad += radians(errors.pitch_deg);
  return real;
}

Camera::Camera(const CameraConfig& camera, const CameraNoiseConfig& noise, std::int64_t seed)
    : camera_{camera}, noise_config_{noise}, lens_{camera}, noise_{noise.sigma_grey_levels, seed} {}

cv::Mat Camera::expose(const cv::Mat& rendered, std::uint64_t frame, double light) const {
  cv::Mat picture;
  const bool grey = noise_config_.colour == ImageColour::kGrey;
  cv::cvtColor(rendered, picture, grey ? cv::COLOR_RGB2GRAY : cv::COLOR_RGB2BGR);
  picture = lens_.apply(picture);
  const double sigma_px = noise_config_.blur_sigma_px;
  if (sigma_px > 0.0) cv::GaussianBlur(picture, picture, {}, sigma_px);
  if (light != 1.0) picture *= light;
  noise_.add_to(picture, frame);
  return picture;
}

cv::Mat Camera::random_picture(Random& random) const {
  const bool grey = noise_config_.colour == ImageColour::kGrey;
  const cv::Size size{camera_.width_px, camera_.height_px};
  cv::Mat picture(size, grey ? CV_8UC1 : CV_8UC3);
  const int cell_px = picture.total() <= kMaxSinglePixels ? 1 : kJpegBlock_px;
  cv::Mat cells((size.height + cell_px - 1) / cell_px, (size.width + cell_px - 1) / cell_px,
                picture.type());
  constexpr std::uint64_t kGreyLevels = 256;
  std::generate(cells.data, cells.data + cells.total() * cells.elemSize(),
                [&random] { return static_cast<std::uint8_t>(random() % kGreyLevels); });
  cv::resize(cells, cells, cells.size() * cell_px, 0.0, 0.0, cv::INTER_NEAREST);
  cells(cv::Rect{{}, size}).copyTo(picture);
  return picture;
}

CameraFrame Camera::compress(const cv::Mat& picture, Timestamp time) const {
  CameraFrame frame{time, picture.cols, picture.rows, noise_config_.jpeg_quality, {}};
  while (true) {
    frame.jpeg = jpeg_bytes(picture, frame.jpeg_quality);
    if (frame.jpeg.size() <= kMaxJpegBytes) return frame;
    if (frame.jpeg_quality <= kQualityStep) break;
    frame.jpeg_quality -= kQualityStep;
  }
  throw SimulatorError{fmt::format(
      "robot.camera.width_px, height_px: a frame of {} x {} px has {} bytes at JPEG quality {}, "
      "expected at most {}: set a smaller picture, or less camera_noise.sigma_grey_levels",
      picture.cols, picture.rows, frame.jpeg.size(), frame.jpeg_quality, kMaxJpegBytes)};
}

}  // namespace waymark
