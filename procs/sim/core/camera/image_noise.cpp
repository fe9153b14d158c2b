// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/camera/image_noise.hpp"

#include "common/random/random.hpp"
#include "sim/core/random_streams.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// A million samples, so that two image rows rarely use overlapping parts of the sequence.
constexpr std::size_t kSequenceLength = std::size_t{1} << 20;

std::uint8_t saturated_sum(std::uint8_t pixel, std::int8_t noise) {
  return static_cast<std::uint8_t>(std::clamp(pixel + noise, 0, 255));
}

}  // namespace

ImageNoise::ImageNoise(double sigma_grey_levels, std::int64_t seed)
    : sigma_{sigma_grey_levels}, seed_{static_cast<std::uint64_t>(seed)} {
  if (sigma_ == 0.0) return;
  Random random{seed_, random_streams::kCameraTile};
  sequence_.resize(kSequenceLength);
  for (std::int8_t& sample : sequence_) {
    sample = static_cast<std::int8_t>(
        std::clamp(std::lround(random.normal(0.0, sigma_grey_levels)), -127L, 127L));
  }
}

void ImageNoise::add_to(cv::Mat& picture, std::uint64_t frame) const {
  if (sigma_ == 0.0) return;
  Random random{seed_, random_streams::kCameraFrame, frame};
  const std::size_t row_length = static_cast<std::size_t>(picture.cols) * picture.elemSize();
  const std::size_t num_offsets = kSequenceLength - row_length;
  for (int v = 0; v < picture.rows; ++v) {
    std::uint8_t* pixels = picture.ptr<std::uint8_t>(v);
    const std::int8_t* noise = sequence_.data() + random() % num_offsets;
    std::transform(pixels, pixels + row_length, noise, pixels, saturated_sum);
  }
}

}  // namespace waymark
