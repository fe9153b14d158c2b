// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/files/map_files.hpp"

#include "viewer/core/painters/plain_painter.hpp"

#include <fmt/format.h>

namespace waymark::viewer {

std::string pgm_text(const GridMap& map, const MapThresholds& thresholds) {
  const cv::Mat_<uchar> image = paint_plain(map, thresholds);
  std::string text = fmt::format("P5\n{} {}\n255\n", image.cols, image.rows);
  for (int row = 0; row < image.rows; ++row)
    text.append(reinterpret_cast<const char*>(image[row]), static_cast<std::size_t>(image.cols));
  return text;
}

std::string map_yaml_text(const GridMap& map, const MapThresholds& thresholds,
                          std::string_view image_name) {
  return fmt::format(
      "image: {}\n"
      "mode: trinary\n"
      "resolution: {}\n"
      "origin: [{:.9f}, {:.9f}, 0.0]\n"
      "negate: 0\n"
      "occupied_thresh: {}\n"
      "free_thresh: {}\n",
      image_name, map.resolution_m, map.origin_m.x(), map.origin_m.y(), thresholds.occupied,
      thresholds.free);
}

}  // namespace waymark::viewer
