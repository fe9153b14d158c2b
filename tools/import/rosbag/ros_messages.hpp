// SPDX-License-Identifier: BSD-3-Clause
// Decodes the ROS messages that an import reads, from ROS 1 or CDR encoding.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/time/time.hpp"
#include "import/rosbag/bag.hpp"

#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace waymark {

struct RosHeader {
  Timestamp stamp{};  ///< 0 where the driver sets none
  std::string frame{};
};

/// sensor_msgs/LaserScan.
struct RosScan {
  RosHeader header{};
  float angle_min_rad{0.0F};
  float angle_increment_rad{0.0F};
  float time_increment_s{0.0F};
  float range_min_m{0.0F};
  float range_max_m{0.0F};
  std::vector<float> ranges_m{};
};

/// nav_msgs/Odometry.
struct RosOdometry {
  RosHeader header{};
  std::string child_frame{};
  Se2 pose{};
};

/// sensor_msgs/CompressedImage or Image.
struct RosImage {
  RosHeader header{};
  std::string format{};  ///< `format` of CompressedImage, `encoding` of Image
  int width_px{0};       ///< 0: compressed image
  int height_px{0};
  int row_bytes{0};
  ByteView data{};  ///< valid as long as the record
};

/// sensor_msgs/CameraInfo.
struct RosCameraInfo {
  RosHeader header{};
  int width_px{0};
  int height_px{0};
  std::string distortion_model{};
  std::vector<double> distortion{};
  std::array<double, 9> camera_matrix{};
  std::array<double, 12> projection{};  ///< of rectified images; may be 0 or not finite
};

/// Transform from one frame to another, from a tf2_msgs/TFMessage.
struct RosTransform {
  std::string parent{};
  std::string child{};
  Eigen::Isometry3d parent_from_child{Eigen::Isometry3d::Identity()};
};

/// The transforms of a tf2_msgs/TFMessage.
struct RosTransforms {
  std::vector<RosTransform> good{};
  std::vector<std::string> bad{};  ///< child frames of invalid transforms
};

/// The decoded message; nothing if its bytes are damaged or its numbers are not finite.
std::optional<RosScan> read_scan(const RosRecord& record);
std::optional<RosOdometry> read_odometry(const RosRecord& record);
std::optional<RosImage> read_compressed_image(const RosRecord& record);
std::optional<RosImage> read_image(const RosRecord& record);
std::optional<RosCameraInfo> read_camera_info(const RosRecord& record);
std::optional<RosTransforms> read_transforms(const RosRecord& record);

}  // namespace waymark
