// SPDX-License-Identifier: BSD-3-Clause
// Views of the board, and the choice of those to calibrate from.
#pragma once

#include "common/markers/charuco_board.hpp"

#include <opencv2/core.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace waymark::calibrate {

struct BoardView {
  std::string name{};                             ///< name of the frame
  std::vector<cv::Point2f> corners_px{};          ///< inner corners of the chessboard
  std::vector<cv::Point3f> corners_in_board_m{};  ///< the same corners, board frame
  std::array<cv::Point2d, 4> outline{};           ///< corners of the board, in image widths
  cv::Vec3d normal{};  ///< normal of the board, optical frame; computed with a guessed lens
};

/// nullopt when fewer than 8 corners (or, on a smaller board, not all) are found, or all found ones
/// are on one line.
std::optional<BoardView> find_board(const std::string& name, const cv::Mat& gray,
                                    const cv::Ptr<cv::aruco::CharucoBoard>& board);

/// Up to 40 views that differ most from each other, the one with most corners first.
std::vector<BoardView> different_views(const std::vector<BoardView>& views);

/// What is missing for a calibration, each as a phrase; empty when the views are sufficient.
/// @param image  size of the frames [px].
std::vector<std::string> missing_in(const std::vector<BoardView>& views, cv::Size image);

}  // namespace waymark::calibrate
