// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/camera/camera.hpp"

#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace waymark {
namespace {

constexpr int kQualityStep = 5;

}  // namespace

void CameraNoiseConfig::describe(Fields& fields) {
  fields.field("sigma_grey_levels", sigma_grey_levels, {0.0, 40.0}, "sensor noise per pixel");
  fields.field("blur_sigma_px", blur_sigma_px, {0.0, 20.0}, "Gaussian blur of the lens; 0 = none");
  fields.choice("colour", colour, {{"grey", ImageColour::kGrey}, {"colour", ImageColour::kColour}},
                "what is compressed");
  fields.field("jpeg_quality", jpeg_quality, {10, 100},
               "quality to begin with; lowered for a frame that does not fit a datagram");
}

Camera::Camera(const CameraConfig& camera, const CameraNoiseConfig& noise, std::int64_t seed)
    : camera_{camera}, noise_config_{noise}, lens_{camera}, noise_{noise.sigma_grey_levels, seed} {}

cv::Mat Camera::expose(const cv::Mat& rendered, std::uint64_t frame) const {
  cv::Mat picture;
  const bool grey = noise_config_.colour == ImageColour::kGrey;
  cv::cvtColor(rendered, picture, grey ? cv::COLOR_RGB2GRAY : cv::COLOR_RGB2BGR);
  picture = lens_.apply(picture);
  const double sigma_px = noise_config_.blur_sigma_px;
  if (sigma_px > 0.0) cv::GaussianBlur(picture, picture, {}, sigma_px);
  noise_.add_to(picture, frame);
  return picture;
}

CameraFrame Camera::compress(const cv::Mat& picture, Timestamp time) const {
  CameraFrame frame{time, picture.cols, picture.rows, noise_config_.jpeg_quality, {}};
  while (true) {
    cv::imencode(".jpg", picture, frame.jpeg, {cv::IMWRITE_JPEG_QUALITY, frame.jpeg_quality});
    if (frame.jpeg.size() <= kMaxJpegBytes || frame.jpeg_quality <= kQualityStep) return frame;
    frame.jpeg_quality -= kQualityStep;
  }
}

}  // namespace waymark
