// SPDX-License-Identifier: BSD-3-Clause
// Marker dictionaries by name, with their error correction set right.
#pragma once

#include "common/robot/robot_config.hpp"

#include <opencv2/aruco.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// OpenCV's predefined dictionary of that name, e.g. "DICT_6X6_250" or "DICT_APRILTAG_36h11".
/// OpenCV 4.6 corrects no bit of AprilTag dictionaries; here they get what their code distance
/// allows.
std::optional<cv::aruco::Dictionary> find_dictionary(std::string_view name);

std::vector<std::string> dictionary_names();

/// Whether robot.markers names a dictionary, and only ids that it has.
void check_dictionary(const MarkerConfig& markers, Problems& problems);

/// Number of ids: they are 0 to one less.
int size_of(const cv::aruco::Dictionary& dictionary);

/// Of the black square: its bits, and the border of one module on each side.
int modules_per_side(const cv::aruco::Dictionary& dictionary);

}  // namespace waymark
