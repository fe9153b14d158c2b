// SPDX-License-Identifier: BSD-3-Clause
// From frames to a lens, or to what is missing.
#pragma once

#include "calibrate/camera_frames.hpp"
#include "calibrate/lens_fit.hpp"

#include <optional>

namespace waymark::calibrate {

struct CameraCalibration {
  FrameCounts frames{};
  std::vector<std::string> without_board{};  ///< frames in which it was not found
  std::size_t num_with_board{0};
  std::vector<BoardView> views{};      ///< the different ones
  std::optional<LensFit> fit{};        ///< none where views are missing
  std::vector<std::string> missing{};  ///< why there is no lens, or why it is not good enough
};

/// @throws SetupError where there are no frames.
CameraCalibration calibrate_camera(const std::filesystem::path& input,
                                   const cv::Ptr<cv::aruco::CharucoBoard>& board);

/// The same from views that were found.
void fit_views(CameraCalibration& calibration, const std::vector<BoardView>& found);

}  // namespace waymark::calibrate
