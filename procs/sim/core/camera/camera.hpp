// SPDX-License-Identifier: BSD-3-Clause
// The simulated camera: from a rendered picture to a distorted, blurred, noisy, compressed frame.
#pragma once

#include "common/random/random.hpp"
#include "common/time/time.hpp"
#include "sim/core/camera/image_noise.hpp"
#include "sim/core/camera/lens.hpp"
#include "sim/core/camera/renderer.hpp"

#include <cstdint>
#include <vector>

namespace waymark {

enum class ImageColour { kGrey, kColour };

/// Image errors and compression.
struct CameraNoiseConfig {
  double sigma_grey_levels{3.0};
  double blur_sigma_px{0.0};
  double exposure_s{0.0};
  ImageColour colour{ImageColour::kGrey};
  int jpeg_quality{85};

  void describe(Fields& fields);
};

/// How the true camera differs from its description in robot.toml: fixed errors, and random ones
/// (`..._sigma`) drawn from the run's seed.
struct CameraErrorConfig {
  double focal_share{0.0};
  double yaw_deg{0.0};
  double pitch_deg{0.0};
  double focal_sigma{0.0};
  double yaw_sigma_deg{0.0};

  void describe(Fields& fields);
};

/// The true camera, which takes the pictures: `nominal` with the errors applied.
CameraConfig real_camera(const CameraConfig& nominal, const CameraErrorConfig& errors,
                         std::int64_t seed);

/// One compressed frame.
struct CameraFrame {
  Timestamp time{};
  int width_px{0};
  int height_px{0};
  int jpeg_quality{0};
  std::vector<std::uint8_t> jpeg{};
};

/// Largest JPEG of a frame that fits one datagram: kMaxPayloadBytes less the other fields of
/// image_t.
constexpr std::size_t kMaxJpegBytes = 64000;

class Camera {
 public:
  Camera(const CameraConfig& camera, const CameraNoiseConfig& noise, std::int64_t seed);

  const Pinhole& pinhole() const { return lens_.pinhole(); }

  const CameraConfig& config() const { return camera_; }

  /// Applies lens, blur and noise to a rendered 8-bit RGB picture.
  /// @param frame  number of the frame; selects its noise.
  /// @param light  factor on the brightness, before the noise.
  /// @return 8 bit, one channel (grey) or three (BGR).
  cv::Mat expose(const cv::Mat& rendered, std::uint64_t frame, double light = 1.0) const;

  /// A picture of random values: of each pixel, or, in pictures of more than 640 x 480 pixels, of
  /// each block of 8 x 8 pixels.
  cv::Mat random_picture(Random& random) const;

  /// Compresses at the configured JPEG quality; lowers it in steps until the frame fits
  /// kMaxJpegBytes. @throws SimulatorError when it does not fit at the lowest step.
  CameraFrame compress(const cv::Mat& picture, Timestamp time) const;

 private:
  CameraConfig camera_;
  CameraNoiseConfig noise_config_;
  Lens lens_;
  ImageNoise noise_;
};

}  // namespace waymark
