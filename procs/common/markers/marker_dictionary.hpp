// SPDX-License-Identifier: BSD-3-Clause
// Marker dictionaries by name, with the number of bits that each can correct.
#pragma once

#include "common/robot/robot_config.hpp"

#include <opencv2/aruco.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// OpenCV's predefined dictionary of that name, e.g. "DICT_6X6_250" or "DICT_APRILTAG_36h11".
/// OpenCV 4.6 corrects no bit of AprilTag dictionaries; here all but 16h5 correct as many as their
/// code distance allows. nullopt for an unknown name.
std::optional<cv::aruco::Dictionary> find_dictionary(std::string_view name);

std::vector<std::string> dictionary_names();

/// Adds problems for an unknown robot.markers.dictionary, and for ids that it does not have.
void check_dictionary(const MarkerConfig& markers, Problems& problems);

/// Number of ids; they begin with 0.
int size_of(const cv::aruco::Dictionary& dictionary);

/// Modules along a side of the black square: its bits and a border of one module on each side.
int modules_per_side(const cv::aruco::Dictionary& dictionary);

}  // namespace waymark
