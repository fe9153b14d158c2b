// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/marker_pattern.hpp"

#include "common/markers/marker_dictionary.hpp"

namespace waymark {

MarkerPattern::MarkerPattern(const cv::Mat& bits) : modules_{bits.rows + 2} {
  is_white_.resize(static_cast<std::size_t>(modules_ * modules_), false);
  for (int row = 0; row < bits.rows; ++row) {
    for (int column = 0; column < bits.cols; ++column) {
      is_white_[static_cast<std::size_t>((row + 1) * modules_ + column + 1)] =
          bits.at<std::uint8_t>(row, column) != 0;
    }
  }
}

std::vector<MarkerPattern> marker_patterns(const cv::aruco::Dictionary& dictionary) {
  std::vector<MarkerPattern> patterns;
  for (int id = 0; id < size_of(dictionary); ++id) {
    patterns.emplace_back(cv::aruco::Dictionary::getBitsFromByteList(
        dictionary.bytesList.rowRange(id, id + 1), dictionary.markerSize));
  }
  return patterns;
}

}  // namespace waymark
