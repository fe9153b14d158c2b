// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/edge_profile.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace waymark {
namespace {

constexpr int kStepsPerPixel = 4;
constexpr int kMaxProfilesPerSide = 80;
// Near a corner the blur of the neighbouring side bends the edge.
constexpr double kCornerMarginPx = 2.0;
constexpr double kMaxCornerMarginRate = 0.2;
// Parts of the reach in which a level is read: far enough from the edge to be past its blur, and
// inside near enough to stay off the inner bits.
constexpr double kWhiteFrom = 0.6;
constexpr double kBlackFrom = -0.9;
constexpr double kBlackTo = -0.6;

/// Weights of four neighbours for a place between the middle two (Catmull and Rom, 1974). Linear
/// interpolation would pull edges towards pixel centres by up to 0.05 px.
std::array<double, 4> cubic_weights(double t) {
  return {0.5 * t * (-1.0 + t * (2.0 - t)), 1.0 + 0.5 * t * t * (-5.0 + 3.0 * t),
          0.5 * t * (1.0 + t * (4.0 - 3.0 * t)), 0.5 * t * t * (-1.0 + t)};
}

/// Bicubic; nullopt at the image border and outside.
std::optional<double> brightness_at(const cv::Mat& gray, const Eigen::Vector2d& raw_px) {
  const double floor_u = std::floor(raw_px.x());
  const double floor_v = std::floor(raw_px.y());
  if (!(floor_u >= 1 && floor_v >= 1 && floor_u < gray.cols - 2 && floor_v < gray.rows - 2)) {
    return std::nullopt;
  }
  const int u = static_cast<int>(floor_u);
  const int v = static_cast<int>(floor_v);
  const auto across = cubic_weights(raw_px.x() - floor_u);
  const auto down = cubic_weights(raw_px.y() - floor_v);
  double sum = 0.0;
  for (int k = 0; k < 4; ++k) {
    const auto* row = gray.ptr<std::uint8_t>(v + k - 1) + u - 1;
    sum += down[k] *
           (across[0] * row[0] + across[1] * row[1] + across[2] * row[2] + across[3] * row[3]);
  }
  return sum;
}

double mean_between(const EdgeProfile& profile, double from_rate, double to_rate) {
  const double half = 0.5 * static_cast<double>(profile.brightness.size() - 1);
  const auto first = static_cast<std::size_t>(std::lround(half * (1.0 + from_rate)));
  const auto last = static_cast<std::size_t>(std::lround(half * (1.0 + to_rate)));
  double sum = 0.0;
  for (std::size_t i = first; i <= last; ++i)
    sum += profile.brightness[i];
  return sum / static_cast<double>(last - first + 1);
}

}  // namespace

std::optional<double> EdgeProfile::crossing_px(double level) const {
  std::optional<double> nearest_px;
  const double step_px = 2.0 * reach_px / static_cast<double>(brightness.size() - 1);
  for (std::size_t i = 0; i + 1 < brightness.size(); ++i) {
    if (!(brightness[i] <= level && brightness[i + 1] > level)) continue;
    const double fraction = (level - brightness[i]) / (brightness[i + 1] - brightness[i]);
    const double offset_px = step_px * (static_cast<double>(i) + fraction) - reach_px;
    if (!nearest_px || std::abs(offset_px) < std::abs(*nearest_px)) nearest_px = offset_px;
  }
  return nearest_px;
}

std::vector<EdgeProfile> sample_profiles(const cv::Mat& gray, const CameraModel& camera,
                                         const Side& side, double reach_px) {
  const double length_px = side.length_px();
  const double margin_px = std::min(kCornerMarginPx, kMaxCornerMarginRate * length_px);
  const int count =
      std::clamp(static_cast<int>(length_px - 2.0 * margin_px) + 1, 2, kMaxProfilesPerSide);
  const double spacing_px = (length_px - 2.0 * margin_px) / (count - 1);
  const int steps = 2 * static_cast<int>(std::ceil(reach_px * kStepsPerPixel));

  std::vector<EdgeProfile> profiles;
  for (int i = 0; i < count; ++i) {
    EdgeProfile profile{.along_px = margin_px + i * spacing_px, .reach_px = reach_px};
    const Eigen::Vector2d place_px = side.start_px + profile.along_px * side.direction();
    for (int k = 0; k <= steps; ++k) {
      const double offset_px = reach_px * (2.0 * k / steps - 1.0);
      const auto value =
          brightness_at(gray, camera.raw_from_ideal(place_px + offset_px * side.outward()));
      if (!value) break;
      profile.brightness.push_back(*value);
    }
    if (std::ssize(profile.brightness) != steps + 1) continue;
    profile.white = mean_between(profile, kWhiteFrom, 1.0);
    profile.black = mean_between(profile, kBlackFrom, kBlackTo);
    profiles.push_back(std::move(profile));
  }
  return profiles;
}

}  // namespace waymark
