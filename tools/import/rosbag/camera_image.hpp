// SPDX-License-Identifier: BSD-3-Clause
// Images of ROS -> the JPEGs of CAMERA.
#pragma once

#include "common/messages/channels.hpp"
#include "import/rosbag/ros_messages.hpp"

#include <optional>

namespace waymark {

/// A JPEG that fits one datagram stays as it is; everything else is decoded and becomes a grey one,
/// with as much quality as fits.
/// @return nothing when the image is damaged, or its pixels are of a kind that is not known here.
std::optional<image_t> to_camera_message(const RosImage& image, Timestamp time);

}  // namespace waymark
