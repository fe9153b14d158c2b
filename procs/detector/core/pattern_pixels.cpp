// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/pattern_pixels.hpp"

#include "common/random/random.hpp"
#include "detector/core/pattern_image.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark {
namespace {

// Pixels that count: so near a border between black and white, so far out into the quiet zone.
constexpr double kNearBorderPx = 4.0;
constexpr double kQuietZoneModules = 0.8;
constexpr double kMostLookedAt = 40000.0;  // of a larger marker every second pixel, or third ...
constexpr int kRowShift = 7919;            // prime to every stride

/// In an order without pattern: the first of them are spread evenly over all.
void shuffle(std::vector<GreyPixel>& pixels) {
  Random random{0};
  for (std::size_t k = pixels.size(); k > 1; --k)
    std::swap(pixels[k - 1], pixels[random() % k]);
}

bool sees_black_and_white(const MarkerPattern& pattern, const PatternImage::Place& place) {
  const Eigen::Vector2d reach = kNearBorderPx * place.modules_per_px.rowwise().norm();
  const Eigen::Array2i low = pattern.module_at(place.modules - reach);
  const Eigen::Array2i high = pattern.module_at(place.modules + reach);
  const bool first = pattern.is_white(low.x(), low.y());
  for (int row = low.y(); row <= high.y(); ++row) {
    for (int column = low.x(); column <= high.x(); ++column) {
      if (pattern.is_white(column, row) != first) return true;
    }
  }
  return false;
}

}  // namespace

std::vector<GreyPixel> pixels_near_borders(const cv::Mat& gray, const CameraModel& camera,
                                           const Corners& raw_corners_px,
                                           const MarkerPattern& pattern) {
  const PatternImage image{pattern, raw_corners_px};
  const auto view = image.view_of(raw_corners_px);
  if (!view) return {};
  Eigen::Array2d low{gray.cols, gray.rows};
  Eigen::Array2d high{0.0, 0.0};
  for (const Eigen::Vector2d& corner_px : raw_corners_px) {
    low = low.min(corner_px.array());
    high = high.max(corner_px.array());
  }
  // Of twice the mean module, since perspective makes those of the near side larger.
  const Eigen::Array2d margin = (high - low) * (kQuietZoneModules * 2.0 / pattern.modules());
  low = (low - margin).max(0.0);
  high = (high + margin).min(Eigen::Array2d{gray.cols - 1.0, gray.rows - 1.0});
  if (!((high - low).minCoeff() > 0.0)) return {};
  const int stride = static_cast<int>(std::ceil((high - low).prod() / kMostLookedAt));

  std::vector<GreyPixel> pixels;
  for (int v = static_cast<int>(std::ceil(low.y())); v <= high.y(); ++v) {
    // Every row begins elsewhere: on a regular grid a side could pass between all columns.
    const int first_u = static_cast<int>(std::ceil(low.x())) + v * kRowShift % stride;
    for (int u = first_u; u <= high.x(); u += stride) {
      const auto place = image.place(*view, {u, v});
      if (!place) continue;
      const Eigen::Array2d outside =
          (-place->modules).cwiseMax(place->modules - Eigen::Vector2d::Constant(pattern.modules()));
      if (outside.maxCoeff() > kQuietZoneModules) continue;
      if (sees_black_and_white(pattern, *place))
        pixels.push_back({{u, v}, static_cast<double>(gray.at<std::uint8_t>(v, u))});
    }
  }
  shuffle(pixels);
  pixels.resize(std::min(pixels.size(), kMostPatternPixels));
  for (GreyPixel& pixel : pixels)
    pixel.ideal_px = camera.ideal_from_raw(pixel.ideal_px);
  std::erase_if(pixels, [](const GreyPixel& pixel) { return !pixel.ideal_px.allFinite(); });
  return pixels;
}

}  // namespace waymark
