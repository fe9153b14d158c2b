// SPDX-License-Identifier: BSD-3-Clause
// A calibration for people and for robot.toml.
#pragma once

#include "calibrate/camera_calibration.hpp"

#include <string>

namespace waymark::calibrate {

/// Frames, views and the lens, one fact per line.
std::string to_text(const CameraCalibration& calibration);

/// One sentence: what is missing.
std::string refusal(const CameraCalibration& calibration, const std::string& input);

/// The keys of [robot.camera] that were measured; those of the mounting are not among them.
/// @param calibration  with a fit.
std::string to_camera_toml(const CameraCalibration& calibration, const std::string& input);

/// The image with the corners that were used, in ninths; residuals are lines, 100 times as long.
cv::Mat coverage_picture(const CameraCalibration& calibration);

}  // namespace waymark::calibrate
