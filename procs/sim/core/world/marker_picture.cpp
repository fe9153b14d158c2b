// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/world/marker_picture.hpp"

#include <opencv2/aruco.hpp>

#include <array>
#include <cassert>
#include <cmath>
#include <utility>

namespace waymark {
namespace {

constexpr int kTexelsPerModule = 16;
constexpr int kBorderModules = 1;  // of the black frame, part of the marker
constexpr int kPaperWhite = 235;   // leaves room for light and noise below 255
constexpr int kInkBlack = 20;

constexpr std::array<std::pair<const char*, cv::aruco::PREDEFINED_DICTIONARY_NAME>, 21> kNames{{
    {"DICT_4X4_50", cv::aruco::DICT_4X4_50},
    {"DICT_4X4_100", cv::aruco::DICT_4X4_100},
    {"DICT_4X4_250", cv::aruco::DICT_4X4_250},
    {"DICT_4X4_1000", cv::aruco::DICT_4X4_1000},
    {"DICT_5X5_50", cv::aruco::DICT_5X5_50},
    {"DICT_5X5_100", cv::aruco::DICT_5X5_100},
    {"DICT_5X5_250", cv::aruco::DICT_5X5_250},
    {"DICT_5X5_1000", cv::aruco::DICT_5X5_1000},
    {"DICT_6X6_50", cv::aruco::DICT_6X6_50},
    {"DICT_6X6_100", cv::aruco::DICT_6X6_100},
    {"DICT_6X6_250", cv::aruco::DICT_6X6_250},
    {"DICT_6X6_1000", cv::aruco::DICT_6X6_1000},
    {"DICT_7X7_50", cv::aruco::DICT_7X7_50},
    {"DICT_7X7_100", cv::aruco::DICT_7X7_100},
    {"DICT_7X7_250", cv::aruco::DICT_7X7_250},
    {"DICT_7X7_1000", cv::aruco::DICT_7X7_1000},
    {"DICT_ARUCO_ORIGINAL", cv::aruco::DICT_ARUCO_ORIGINAL},
    {"DICT_APRILTAG_16h5", cv::aruco::DICT_APRILTAG_16h5},
    {"DICT_APRILTAG_25h9", cv::aruco::DICT_APRILTAG_25h9},
    {"DICT_APRILTAG_36h10", cv::aruco::DICT_APRILTAG_36h10},
    {"DICT_APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11},
}};

/// Null when there is none of that name.
cv::Ptr<cv::aruco::Dictionary> find_dictionary(const std::string& name) {
  for (const auto& [known, number] : kNames)
    if (name == known) return cv::aruco::getPredefinedDictionary(number);
  return {};
}

int black_square_modules(const MarkerPrint& print) {
  const auto dictionary = find_dictionary(print.dictionary);
  assert(dictionary);
  return dictionary->markerSize + 2 * kBorderModules;
}

int quiet_zone_texels(const MarkerPrint& print) {
  return static_cast<int>(std::lround(print.quiet_zone_modules * kTexelsPerModule));
}

}  // namespace

std::optional<int> dictionary_size(const std::string& dictionary) {
  const auto found = find_dictionary(dictionary);
  if (!found) return std::nullopt;
  return found->bytesList.rows;
}

double plate_size_m(const MarkerPrint& print) {
  // From the texels, not from quiet_zone_modules: the picture's scale must be exact.
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
  cv::aruco::drawMarker(find_dictionary(print.dictionary), id, square_texels, bits, kBorderModules);
  cv::Mat picture = blank_picture(print);
  const int quiet = quiet_zone_texels(print);
  picture(cv::Rect{quiet, quiet, square_texels, square_texels}).setTo(kInkBlack, bits == 0);
  return picture;
}

}  // namespace waymark
