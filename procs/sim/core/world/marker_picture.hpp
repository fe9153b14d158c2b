// SPDX-License-Identifier: BSD-3-Clause
// The picture printed on a marker's plate.
#pragma once

#include <opencv2/core/mat.hpp>

#include <optional>
#include <string>

namespace waymark {

/// Dictionary, size and white border of the printed markers.
struct MarkerPrint {
  std::string dictionary{"DICT_6X6_250"};
  double size_m{0.4};  ///< side of the black square
  double quiet_zone_modules{2.0};
};

/// Number of ids; nullopt when OpenCV has no dictionary of that name.
std::optional<int> dictionary_size(const std::string& dictionary);

/// Side of the plate: black square and quiet zone on both sides [m]. The dictionary must exist.
double plate_size_m(const MarkerPrint& print);

/// 8-bit grey picture of the whole plate, top row first, a power of two of texels per module, so
/// that module borders fall on texel borders in the finer mipmap levels. The id must exist.
cv::Mat marker_picture(const MarkerPrint& print, int id);

/// A plate with nothing on it, of the same size.
cv::Mat blank_picture(const MarkerPrint& print);

}  // namespace waymark
