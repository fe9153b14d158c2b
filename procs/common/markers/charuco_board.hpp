// SPDX-License-Identifier: BSD-3-Clause
// ChArUco boards: a chessboard with ArUco markers in its white squares, for calibrating cameras.
#pragma once

#include <opencv2/aruco/charuco.hpp>

#include <string>
#include <vector>

namespace waymark {

/// The default board, 224 mm x 160 mm, fits an A4 page.
struct BoardOptions {
  std::string squares{"7x5"};  ///< columns x rows
  double square_m{0.032};      ///< side of a square
  double marker_m{0.024};      ///< side of a marker's black square
  std::string dictionary{"DICT_5X5_100"};
};

/// OpenCV's board: ids begin with 0, the origin is the upper left corner, x right, y down.
/// @throws SetupError naming the invalid option.
cv::Ptr<cv::aruco::CharucoBoard> make_board(const BoardOptions& options);

/// Inner corners of the chessboard found in an image.
struct BoardCorners {
  std::vector<int> marker_ids{};          ///< markers that were read
  std::vector<int> ids{};                 ///< of the corners: indices into board.chessboardCorners
  std::vector<cv::Point2f> corners_px{};  ///< pixel centres are integers
};

BoardCorners find_corners(const cv::Mat& gray, const cv::Ptr<cv::aruco::CharucoBoard>& board);

}  // namespace waymark
