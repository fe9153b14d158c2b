// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/world/marker_picture.hpp"

#include "common/markers/marker_dictionary.hpp"

#include <opencv2/aruco.hpp>

#include <cassert>
#include <cmath>

namespace waymark {
namespace {

constexpr int kTexelsPerModule = 16;
constexpr int kBorderModules = 1;  // thickness of the black border [modules]
constexpr int kPaperWhite = 235;   // leaves room for light and noise below 255
constexpr int kInkBlack = 20;

int black_square_modules(const MarkerPrint& print) {
  const auto dictionary = find_dictionary(print.dictionary);
  assert(dictionary);
  return modules_per_side(*dictionary);
}

int quiet_zone_texels(const MarkerPrint& print) {
  return static_cast<int>(std::lround(print.quiet_zone_modules * kTexelsPerModule));
}

}  // namespace

std::optional<int> dictionary_size(const std::string& dictionary) {
  const auto found = find_dictionary(dictionary);
  if (!found) return std::nullopt;
  return size_of(*found);
}

double plate_size_m(const MarkerPrint& print) {
  // From the whole number of texels, not from quiet_zone_modules, so that the black square in the
  // picture has exactly size_m.
  const int square_texels = black_square_modules(print) * kTexelsPerModule;
  return print.size_m * (square_texels + 2 * quiet_zone_texels(print)) / square_texels;
}

cv::Mat blank_picture(const MarkerPrint& print) {
  const int side = black_square_modules(print) * kTexelsPerModule + 2 * quiet_zone_texels(print);
  return {side, side, CV_8UC1, cv::Scalar{kPaperWhite}};
}

cv::Mat marker_picture(const MarkerPrint& print, int id) {
  cv::Mat bits;
  const int square_texels = black_square_modules(print) * kTexelsPerModule;
  const auto dictionary = cv::makePtr<cv::aruco::Dictionary>(*find_dictionary(print.dictionary));
  cv::aruco::drawMarker(dictionary, id, square_texels, bits, kBorderModules);
  cv::Mat picture = blank_picture(print);
  const int quiet = quiet_zone_texels(print);
  picture(cv::Rect{quiet, quiet, square_texels, square_texels}).setTo(kInkBlack, bits == 0);
  return picture;
}

}  // namespace waymark
