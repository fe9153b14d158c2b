// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/edge_profile.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr int kStepsPerPixel = 4;
constexpr int kMaxProfilesPerSide = 80;
// Profiles nearer to a corner are left out: the blur of the neighbouring side bends the edge there.
constexpr double kCornerMarginPx = 2.0;
constexpr double kMaxCornerMarginRate = 0.2;
// Offsets at which the white and black levels are read, as shares of the reach: outside the blur of
// the edge.
constexpr double kWhiteAt = 0.8;
constexpr double kWhiteHalfWidth = 0.2;
constexpr double kBlackAt = 0.5 * kThickBorder;
constexpr double kBlackHalfWidth = 0.15;
constexpr double kLeastWhitePx = 1.2;  // nearer to the edge its blur darkens the white

/// Bilinear; nullopt outside the image.
std::optional<double> brightness_at(const cv::Mat& gray, const Eigen::Vector2d& raw_px) {
  const double floor_u = std::floor(raw_px.x());
  const double floor_v = std::floor(raw_px.y());
  if (!(floor_u >= 0 && floor_v >= 0 && floor_u < gray.cols - 1 && floor_v < gray.rows - 1)) {
    return std::nullopt;
  }
  const int u = static_cast<int>(floor_u);
  const int v = static_cast<int>(floor_v);
  const double right = raw_px.x() - floor_u;
  const double down = raw_px.y() - floor_v;
  const auto* upper = gray.ptr<std::uint8_t>(v) + u;
  const auto* lower = gray.ptr<std::uint8_t>(v + 1) + u;
  return (1 - down) * ((1 - right) * upper[0] + right * upper[1]) +
         down * ((1 - right) * lower[0] + right * lower[1]);
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

/// Where the bit behind a thin border is white, the black level is read in the middle of the
/// border, farthest from its outer edge and from the bit; in the same way the white level of a
/// quiet zone that is not wider than the border.
void read_levels(EdgeProfile& profile, double border_px) {
  const double middle = 0.5 * border_px / profile.reach_px;
  const double least = std::min(kWhiteAt, kLeastWhitePx / profile.reach_px);
  const double white_at = profile.is_white_beyond ? kWhiteAt : std::clamp(middle, least, kWhiteAt);
  const double black_at = profile.is_white_behind ? std::min(middle, kBlackAt) : kBlackAt;
  const double white_half = std::max(0.0, kWhiteHalfWidth - (kWhiteAt - white_at));
  const double black_half = std::max(0.0, kBlackHalfWidth - (kBlackAt - black_at));
  profile.white = mean_between(profile, white_at - white_half, white_at + white_half);
  profile.black = mean_between(profile, -black_at - black_half, -black_at + black_half);
}

double EdgeProfile::step_px() const {
  return 2.0 * reach_px / static_cast<double>(brightness.size() - 1);
}

double EdgeProfile::at(double offset_px) const {
  const double place = std::clamp((offset_px + reach_px) / step_px(), 0.0,
                                  static_cast<double>(brightness.size() - 1));
  const auto before = std::min(static_cast<std::size_t>(place), brightness.size() - 2);
  const double fraction = place - static_cast<double>(before);
  return (1.0 - fraction) * brightness[before] + fraction * brightness[before + 1];
}

std::optional<double> EdgeProfile::crossing_px(double level) const {
  std::optional<double> nearest_px;
  for (std::size_t i = 0; i + 1 < brightness.size(); ++i) {
    if (!(brightness[i] <= level && brightness[i + 1] > level)) continue;
    const double fraction = (level - brightness[i]) / (brightness[i + 1] - brightness[i]);
    const double offset_px = step_px() * (static_cast<double>(i) + fraction) - reach_px;
    if (!nearest_px || std::abs(offset_px) < std::abs(*nearest_px)) nearest_px = offset_px;
  }
  return nearest_px;
}

std::optional<double> EdgeProfile::edge_px(const GreyLevels& levels, double half_window_px) const {
  if (!(levels.white > levels.black)) return std::nullopt;
  const auto crossing = crossing_px(0.5 * (levels.white + levels.black));
  if (!crossing) return std::nullopt;
  const double half_px = std::min(half_window_px, reach_px - std::abs(*crossing));
  const int steps = std::max(1, static_cast<int>(std::ceil(half_px * kStepsPerPixel)));
  double white_share = 0.0;
  for (int i = -steps; i < steps; ++i) {
    const double level = at(*crossing + half_px * (i + 0.5) / steps);
    white_share += (level - levels.black) / (levels.white - levels.black) / (2.0 * steps);
  }
  return *crossing + half_px * (1.0 - 2.0 * white_share);
}

std::optional<double> EdgeProfile::blur_px(const GreyLevels& levels) const {
  const auto low = crossing_px(levels.black + 0.25 * (levels.white - levels.black));
  const auto high = crossing_px(levels.black + 0.75 * (levels.white - levels.black));
  if (!low || !high || *high < *low) return std::nullopt;
  return (*high - *low) / kQuartileDistance;
}

std::vector<EdgeProfile> sample_profiles(const cv::Mat& gray, const CameraModel& camera,
                                         const Side& side, double reach_px, double border_px) {
  const double length_px = side.length_px();
  const double margin_px = std::min(kCornerMarginPx, kMaxCornerMarginRate * length_px);
  const int count =
      std::clamp(static_cast<int>(length_px - 2.0 * margin_px) + 1, 2, kMaxProfilesPerSide);
  const double spacing_px = (length_px - 2.0 * margin_px) / (count - 1);
  const int steps = 2 * static_cast<int>(std::ceil(reach_px * kStepsPerPixel));

  std::vector<EdgeProfile> profiles;
  for (int i = 0; i < count; ++i) {
    EdgeProfile profile{.along_px = margin_px + i * spacing_px, .reach_px = reach_px};
    const Eigen::Vector2d place_px = side.start_px + profile.along_px * side.along();
    for (int k = 0; k <= steps; ++k) {
      const double offset_px = reach_px * (2.0 * k / steps - 1.0);
      const auto value =
          brightness_at(gray, camera.raw_from_ideal(place_px + offset_px * side.outward()));
      if (!value) break;
      profile.brightness.push_back(*value);
    }
    if (std::ssize(profile.brightness) != steps + 1) continue;
    const auto brightness_out = [&](double modules) {
      return brightness_at(gray,
                           camera.raw_from_ideal(place_px + modules * border_px * side.outward()));
    };
    const auto bit = brightness_out(-kInnerBits);
    const auto wall = brightness_out(kInnerBits);
    const auto [darkest, brightest] = std::ranges::minmax(profile.brightness);
    const double same = kSameGrey * (brightest - darkest);
    profile.is_white_behind = bit && *bit > darkest + same;
    profile.is_white_beyond = !wall || *wall > brightest - same;
    read_levels(profile, border_px);
    profiles.push_back(std::move(profile));
  }
  return profiles;
}

std::optional<double> mean_brightness_inside(const cv::Mat& gray, const CameraModel& camera,
                                             const Side& side, double inside_px, double margin_px) {
  const double length_px = side.length_px() - 2.0 * margin_px;
  const int count = std::max(2, static_cast<int>(length_px));
  double sum = 0.0;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d place_px =
        side.start_px + (margin_px + (i + 0.5) / count * length_px) * side.along();
    const auto value =
        brightness_at(gray, camera.raw_from_ideal(place_px - inside_px * side.outward()));
    if (!value) return std::nullopt;
    sum += *value / count;
  }
  return sum;
}

}  // namespace waymark
