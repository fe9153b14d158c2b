// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/marker_detector.hpp"

#include "common/markers/marker_dictionary.hpp"

#include <algorithm>
#include <stdexcept>

namespace waymark {
namespace {

cv::aruco::Dictionary dictionary_of(const MarkerConfig& markers) {
  const auto dictionary = find_dictionary(markers.dictionary);
  if (!dictionary) throw std::invalid_argument{"unknown dictionary " + markers.dictionary};
  return *dictionary;
}

double width_px(const Corners& corners) {
  const auto length = [&corners](int a, int b) {
    return (corners[a] - corners[b]).norm();
  };
  return 0.5 * std::min(length(0, 1) + length(2, 3), length(1, 2) + length(3, 0));
}

Eigen::Vector2d centre_px(const MarkerDetection& detection) {
  return 0.25 * (detection.corners_px[0] + detection.corners_px[1] + detection.corners_px[2] +
                 detection.corners_px[3]);
}

bool overlap(const MarkerDetection& a, const MarkerDetection& b) {
  return (centre_px(a) - centre_px(b)).norm() < 0.5 * std::max(a.width_px, b.width_px);
}

/// One marker can yield two quads with the same id (inner and outer contour of its border). Of each
/// such pair, keeps the quad with the smaller reprojection error.
std::vector<MarkerDetection> without_overlaps(const std::vector<MarkerDetection>& detections) {
  std::vector<MarkerDetection> kept;
  for (const MarkerDetection& detection : detections) {
    const auto rival = std::ranges::find_if(kept, [&detection](const MarkerDetection& other) {
      return other.id == detection.id && overlap(other, detection);
    });
    if (rival == kept.end()) {
      kept.push_back(detection);
    } else if (detection.reprojection_error_px < rival->reprojection_error_px) {
      *rival = detection;
    }
  }
  return kept;
}

}  // namespace

void CalibrationErrorConfig::describe(Fields& fields) {
  fields.field("range_rate", range_rate, kFraction,
               "standard deviation of the range as a share of it; 0 = camera exactly known");
  fields.field("bearing_rad", bearing_rad, kNotNegative,
               "standard deviation of the direction to a marker, about each axis");
  fields.field("orientation_rad", orientation_rad, kNotNegative,
               "standard deviation of the marker's orientation, about each axis");
}

void MarkerDetectorConfig::describe(Fields& fields) {
  fields.field("max_reprojection_px", max_reprojection_px, kPositive,
               "corners that no square explains to this accuracy are no marker");
  fields.section("candidates", candidates);
  fields.section("refinement", refinement);
  fields.section("calibration_error", calibration_error);
}

MarkerDetector::MarkerDetector(const RobotConfig& robot, const MarkerDetectorConfig& config)
    : markers_{robot.markers},
      known_ids_{robot.markers.ids.begin(), robot.markers.ids.end()},
      config_{config},
      camera_{robot.camera},
      base_from_camera_{robot.camera.base_from_camera()},
      patterns_{marker_patterns(dictionary_of(robot.markers))},
      finder_{dictionary_of(robot.markers), config.candidates} {}

ImageMarkers MarkerDetector::examine(const cv::Mat& gray) const {
  ImageMarkers found;
  for (const MarkerCandidate& candidate : finder_.find(gray)) {
    if (!known_ids_.empty() && !known_ids_.contains(candidate.id)) continue;
    if (!is_within_lens(candidate)) {
      ++found.beyond_lens;
    } else if (const auto detection = measure(gray, candidate)) {
      found.markers.push_back(*detection);
    }
  }
  found.markers = without_overlaps(found.markers);
  return found;
}

bool MarkerDetector::is_within_lens(const MarkerCandidate& candidate) const {
  return std::ranges::all_of(candidate.corners_px, [this](const Eigen::Vector2d& corner_px) {
    return camera_.ideal_from_raw(corner_px).allFinite();
  });
}

std::optional<MarkerDetection> MarkerDetector::measure(const cv::Mat& gray,
                                                       const MarkerCandidate& candidate) const {
  const MeasuredCorners corners =
      refine_corners(gray, camera_, candidate.corners_px,
                     patterns_[static_cast<std::size_t>(candidate.id)], config_.refinement);
  const auto poses = solve_square(corners, camera_, markers_.size_m);
  if (!poses || poses->best.reprojection_error_px > config_.max_reprojection_px) {
    return std::nullopt;
  }
  MarkerDetection detection;
  detection.id = candidate.id;
  std::ranges::transform(corners.ideal_px, detection.corners_px.begin(),
                         [this](const auto& corner) { return camera_.raw_from_ideal(corner); });
  detection.base_from_marker = base_from_camera_ * poses->best.camera_from_marker;
  detection.covariance_in_base = covariance_in_base(*poses);
  detection.reprojection_error_px = poses->best.reprojection_error_px;
  detection.other_base_from_marker = base_from_camera_ * poses->other.camera_from_marker;
  detection.other_reprojection_error_px = poses->other.reprojection_error_px;
  detection.width_px = width_px(detection.corners_px);
  return detection;
}

Eigen::Matrix<double, 6, 6> MarkerDetector::covariance_in_base(const SquarePoses& poses) const {
  const CalibrationErrorConfig& error = config_.calibration_error;
  const Eigen::Vector3d to_marker = poses.best.camera_from_marker.translation();
  const Eigen::Matrix3d along_ray = to_marker * to_marker.transpose();
  const Eigen::Matrix3d across_ray =
      to_marker.squaredNorm() * Eigen::Matrix3d::Identity() - along_ray;

  Eigen::Matrix<double, 6, 6> in_camera = poses.covariance_in_camera;
  in_camera.topLeftCorner<3, 3>() += error.range_rate * error.range_rate * along_ray +
                                     error.bearing_rad * error.bearing_rad * across_ray;
  in_camera.bottomRightCorner<3, 3>().diagonal().array() +=
      error.orientation_rad * error.orientation_rad;

  Eigen::Matrix<double, 6, 6> base_from_camera_axes = Eigen::Matrix<double, 6, 6>::Zero();
  base_from_camera_axes.topLeftCorner<3, 3>() = base_from_camera_.linear();
  base_from_camera_axes.bottomRightCorner<3, 3>() = base_from_camera_.linear();
  return base_from_camera_axes * in_camera * base_from_camera_axes.transpose();
}

}  // namespace waymark
