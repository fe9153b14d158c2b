// SPDX-License-Identifier: BSD-3-Clause
#include "common/messages/convert.hpp"

#include <algorithm>
#include <limits>
#include <stdexcept>

namespace waymark {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::Isometry3d to_isometry(const double (&position)[3], const double (&wxyz)[4]) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d{position[0], position[1], position[2]};
  pose.linear() =
      Eigen::Quaterniond{wxyz[0], wxyz[1], wxyz[2], wxyz[3]}.normalized().toRotationMatrix();
  return pose;
}

void put_isometry(const Eigen::Isometry3d& pose, double (&position)[3], double (&wxyz)[4]) {
  const Eigen::Quaterniond q{pose.linear()};
  for (int i = 0; i < 3; ++i)
    position[i] = pose.translation()[i];
  wxyz[0] = q.w();
  wxyz[1] = q.x();
  wxyz[2] = q.y();
  wxyz[3] = q.z();
}

MarkerDetection to_detection(const marker_detection_t& m) {
  MarkerDetection d{};
  d.id = m.id;
  for (std::size_t i = 0; i < 4; ++i)
    d.corners_px[i] = {m.corners_px[i][0], m.corners_px[i][1]};
  d.base_from_marker = to_isometry(m.position_m, m.orientation);
  d.covariance_in_base =
      Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(m.covariance);
  d.reprojection_error_px = m.reprojection_error_px;
  d.other_base_from_marker = to_isometry(m.other_position_m, m.other_orientation);
  d.other_reprojection_error_px = m.other_reprojection_error_px;
  d.width_px = m.width_px;
  return d;
}

marker_detection_t to_detection_message(const MarkerDetection& d) {
  marker_detection_t m{};
  m.id = d.id;
  for (std::size_t i = 0; i < 4; ++i) {
    m.corners_px[i][0] = d.corners_px[i].x();
    m.corners_px[i][1] = d.corners_px[i].y();
  }
  put_isometry(d.base_from_marker, m.position_m, m.orientation);
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>{m.covariance} = d.covariance_in_base;
  m.reprojection_error_px = d.reprojection_error_px;
  put_isometry(d.other_base_from_marker, m.other_position_m, m.other_orientation);
  m.other_reprojection_error_px = d.other_reprojection_error_px;
  m.width_px = d.width_px;
  return m;
}

std::vector<float> to_floats(const std::vector<double>& values) {
  std::vector<float> floats(values.size());
  std::ranges::transform(values, floats.begin(), [](double v) { return static_cast<float>(v); });
  return floats;
}

}  // namespace

LidarScan to_scan(const planar_lidar_t& m) {
  LidarScan scan{timestamp_from_us(m.utime), {m.ranges.begin(), m.ranges.end()}, {}, {}};
  scan.angles_rad.reserve(m.ranges.size());
  for (int i = 0; i < m.nranges; ++i) {
    scan.angles_rad.push_back(double{m.rad0} + i * double{m.radstep});
  }
  return scan;
}

LidarScan to_scan(const lidar_t& m) {
  LidarScan scan{timestamp_from_us(m.utime), {}, {}, {}};
  for (std::size_t i = 0; i < m.ranges.size(); ++i) {
    scan.ranges_m.push_back(m.ranges[i] == 0.0F ? kInfinity : double{m.ranges[i]});
    scan.angles_rad.push_back(-double{m.thetas[i]});
    scan.beam_time_offsets.emplace_back(m.times[i] - m.utime);
  }
  return scan;
}

planar_lidar_t to_planar_lidar(const LidarScan& scan) {
  if (scan.angles_rad.empty()) throw std::logic_error{"a scan without beams cannot be sent"};
  planar_lidar_t m{};
  m.utime = to_us(scan.time);
  m.nranges = static_cast<int>(scan.ranges_m.size());
  m.ranges = to_floats(scan.ranges_m);
  m.rad0 = static_cast<float>(scan.angles_rad.front());
  const double span_rad = scan.angles_rad.back() - scan.angles_rad.front();
  const double steps = std::max<double>(1.0, static_cast<double>(scan.angles_rad.size()) - 1.0);
  m.radstep = static_cast<float>(span_rad / steps);
  return m;
}

lidar_t to_mbot_lidar(const LidarScan& scan) {
  lidar_t m{};
  m.utime = to_us(scan.time);
  m.num_ranges = static_cast<int>(scan.ranges_m.size());
  m.ranges = to_floats(scan.ranges_m);
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    m.thetas.push_back(static_cast<float>(-scan.angles_rad[i]));
    const Duration offset =
        scan.beam_time_offsets.empty() ? Duration{0} : scan.beam_time_offsets[i];
    m.times.push_back(to_us(scan.time + offset));
  }
  m.intensities.assign(scan.ranges_m.size(), 0.0F);
  return m;
}

OdometrySample to_odometry(const pose2D_t& m) {
  return {timestamp_from_us(m.utime), to_se2(m)};
}

Se2 to_se2(const pose2D_t& m) {
  return {double{m.x}, double{m.y}, double{m.theta}};
}

pose2D_t to_pose_message(Timestamp time, const Se2& pose) {
  pose2D_t m{};
  m.utime = to_us(time);
  m.x = static_cast<float>(pose.x());
  m.y = static_cast<float>(pose.y());
  m.theta = static_cast<float>(pose.theta());
  return m;
}

MarkerDetections to_detections(const marker_detections_t& m) {
  MarkerDetections detections{timestamp_from_us(m.utime), m.image_width, m.image_height, {}};
  std::ranges::transform(m.detections, std::back_inserter(detections.detections), to_detection);
  return detections;
}

marker_detections_t to_detections_message(const MarkerDetections& detections) {
  marker_detections_t m{};
  m.utime = to_us(detections.time);
  m.image_width = detections.image_width_px;
  m.image_height = detections.image_height_px;
  m.num_detections = static_cast<int>(detections.detections.size());
  std::ranges::transform(detections.detections, std::back_inserter(m.detections),
                         to_detection_message);
  return m;
}

}  // namespace waymark
