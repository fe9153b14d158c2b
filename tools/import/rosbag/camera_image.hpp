// SPDX-License-Identifier: BSD-3-Clause
// Converts ROS images to the JPEG messages of CAMERA.
#pragma once

#include "common/messages/channels.hpp"
#include "import/rosbag/ros_messages.hpp"

#include <optional>

namespace waymark {

/// False for an Image whose pixels are of an encoding that is not read.
bool has_known_encoding(const RosImage& image);

/// A JPEG that fits into one datagram is kept unchanged; any other image is encoded as a grey JPEG
/// with the highest quality that fits.
/// @return nothing if the image is damaged or its pixel encoding is not supported.
std::optional<image_t> to_camera_message(const RosImage& image, Timestamp time);

}  // namespace waymark
