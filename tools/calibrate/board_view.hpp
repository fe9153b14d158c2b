// SPDX-License-Identifier: BSD-3-Clause
// The board in one frame, and what views of it can say about a lens.
#pragma once

#include "common/markers/charuco_board.hpp"

#include <opencv2/core.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace waymark::calibrate {

struct BoardView {
  std::string name{};                             ///< of the frame
  std::vector<cv::Point2f> corners_px{};          ///< inner corners of the chessboard
  std::vector<cv::Point3f> corners_in_board_m{};  ///< the same on the board
  std::array<cv::Point2d, 4> outline{};           ///< of the board, in widths of the image
  cv::Vec3d normal{};  ///< of the board, optical frame; with a lens that is only a guess
};

/// nullopt where fewer than 8 corners are seen, or all in one line.
std::optional<BoardView> find_board(const std::string& name, const cv::Mat& gray,
                                    const cv::Ptr<cv::aruco::CharucoBoard>& board);

/// Up to 40 views that differ most, the one with most corners first: a view that repeats another
/// one says nothing new.
std::vector<BoardView> different_views(const std::vector<BoardView>& views);

/// What is missing, each as a sentence's part with what to do; empty: nothing.
std::vector<std::string> missing_in(const std::vector<BoardView>& views, cv::Size image);

}  // namespace waymark::calibrate
