// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/marker_pattern.hpp"

#include "common/markers/marker_dictionary.hpp"

#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>

namespace waymark {
namespace {

TEST(MarkerPattern, BitsLieWithinABlackBorderOnWhite) {
  const cv::Mat bits = (cv::Mat_<std::uint8_t>(2, 2) << 1, 0, 0, 1);
  const MarkerPattern pattern{bits};
  EXPECT_EQ(pattern.modules(), 4);
  for (int k = 0; k < 4; ++k) {
    EXPECT_FALSE(pattern.is_white(k, 0));
    EXPECT_FALSE(pattern.is_white(3, k));
    EXPECT_TRUE(pattern.is_white(k, -1));
    EXPECT_TRUE(pattern.is_white(4, k));
  }
  EXPECT_TRUE(pattern.is_white(1, 1));
  EXPECT_FALSE(pattern.is_white(2, 1));
  EXPECT_FALSE(pattern.is_white(1, 2));
  EXPECT_TRUE(pattern.is_white(2, 2));
}

TEST(MarkerPattern, IsWhatOpenCvDraws) {
  for (const char* name : {"DICT_4X4_50", "DICT_6X6_250", "DICT_APRILTAG_36h11"}) {
    const auto dictionary = *find_dictionary(name);
    const auto patterns = marker_patterns(dictionary);
    ASSERT_EQ(std::ssize(patterns), size_of(dictionary)) << name;
    for (const int id : {0, 17, 49}) {
      cv::Mat cells;
      const MarkerPattern& pattern = patterns[static_cast<std::size_t>(id)];
      cv::aruco::drawMarker(cv::makePtr<cv::aruco::Dictionary>(dictionary), id, pattern.modules(),
                            cells, 1);
      for (int row = 0; row < cells.rows; ++row) {
        for (int column = 0; column < cells.cols; ++column) {
          EXPECT_EQ(pattern.is_white(column, row), cells.at<std::uint8_t>(row, column) != 0)
              << name << " " << id << ", " << column << " " << row;
        }
      }
    }
  }
}

}  // namespace
}  // namespace waymark
