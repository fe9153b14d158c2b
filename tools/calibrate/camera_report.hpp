// SPDX-License-Identifier: BSD-3-Clause
// A calibration as text, TOML and picture.
#pragma once

#include "calibrate/camera_calibration.hpp"

#include <string>

namespace waymark::calibrate {

/// Frames, views and the lens, one fact per line.
std::string to_text(const CameraCalibration& calibration);

/// One sentence: what is missing.
std::string refusal(const CameraCalibration& calibration, const std::string& input);

/// The measured keys of [robot.camera], without those of the mounting.
/// @param calibration  one with a fit.
std::string to_camera_toml(const CameraCalibration& calibration, const std::string& input);

/// The image area in ninths with the used corners, and their residuals as lines, magnified 100
/// times.
cv::Mat coverage_picture(const CameraCalibration& calibration);

}  // namespace waymark::calibrate
