// SPDX-License-Identifier: BSD-3-Clause
// Frames -> lens, or what is missing for one.
#pragma once

#include "calibrate/camera_frames.hpp"
#include "calibrate/lens_fit.hpp"

#include <optional>

namespace waymark::calibrate {

struct CameraCalibration {
  FrameCounts frames{};
  std::vector<std::string> without_board{};  ///< names of frames in which no board was found
  std::size_t num_with_board{0};
  std::vector<BoardView> views{};      ///< different_views() of all views of the board
  std::optional<LensFit> fit{};        ///< nullopt when the views do not determine a lens
  std::vector<std::string> missing{};  ///< why there is no lens, or why it is not accurate enough
};

/// @throws SetupError when there are no frames.
CameraCalibration calibrate_camera(const std::filesystem::path& input,
                                   const cv::Ptr<cv::aruco::CharucoBoard>& board);

/// The second half of calibrate_camera(): from views to the lens.
void fit_views(CameraCalibration& calibration, const std::vector<BoardView>& found);

}  // namespace waymark::calibrate
