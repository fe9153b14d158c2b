// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/drawing/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace waymark::viewer {
namespace {

/// One channel of a colour given by hue, saturation and lightness (CSS Color Module Level
/// 3, 4.2.4).
double hsl_channel(double hue_turns, double saturation, double lightness, double offset) {
  const double k = std::fmod(offset + 12.0 * hue_turns, 12.0);
  const double chroma = saturation * std::min(lightness, 1.0 - lightness);
  return 255.0 * (lightness - chroma * std::clamp(std::min(k - 3.0, 9.0 - k), -1.0, 1.0));
}

}  // namespace

cv::Scalar palette::text_on(const cv::Scalar& background) {
  constexpr double kBright = 160.0;
  const double luma =  // Rec. ITU-R BT.601
      0.114 * background[0] + 0.587 * background[1] + 0.299 * background[2];
  return luma > kBright ? kInk : kPage;
}

cv::Scalar colour_of_id(int id) {
  constexpr double kGoldenRatio = 0.6180339887498949;  // multiples modulo 1 are spread evenly
  constexpr std::array<double, 3> kLightness{0.42, 0.56, 0.32};
  const int index = std::max(id, 0);
  const double hue_turns = std::fmod(index * kGoldenRatio, 1.0);
  const double lightness = kLightness[static_cast<std::size_t>(index) % kLightness.size()];
  constexpr double kSaturation = 0.78;
  return {std::round(hsl_channel(hue_turns, kSaturation, lightness, 4.0)),
          std::round(hsl_channel(hue_turns, kSaturation, lightness, 8.0)),
          std::round(hsl_channel(hue_turns, kSaturation, lightness, 0.0))};
}

cv::Scalar blend(const cv::Scalar& from, const cv::Scalar& to, double fraction) {
  return from * (1.0 - fraction) + to * fraction;
}

}  // namespace waymark::viewer
