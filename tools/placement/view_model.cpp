// SPDX-License-Identifier: BSD-3-Clause
#include "placement/view_model.hpp"

#include "detector/core/square_pose.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>

namespace waymark::placement {
namespace {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;
using Matrix86 = Eigen::Matrix<double, 8, 6>;

struct ReadShare {
  double module_px;
  double share;
};

// Share of frames in which the detector reads a marker, by the size of its modules; measured on the
// log of the default corridor (7338 views, deploy/scenarios/corridor.toml, seed 1).
constexpr std::array kReadShares{ReadShare{0.75, 0.0}, ReadShare{0.95, 0.45}, ReadShare{1.3, 0.65},
                                 ReadShare{1.8, 0.86}, ReadShare{2.5, 0.92},  ReadShare{3.5, 1.0}};

constexpr double kScatter_px = 0.02;  // sigma of edge points about their side in those frames
constexpr double kSharedNoise = 2.0;  // correlation of neighbouring edge points, as in the detector
constexpr double kFewestPoints = 4.0;
constexpr double kImageMargin_px = 3.0;  // CandidateConfig::border_distance_px
constexpr double kNearest_m = 0.05;      // in front of the camera
constexpr double kOnItsWall_m = 0.15;  // beams ending this close to the marker's plane hit its wall

Eigen::Isometry3d upright(const Se2& base_from_marker, double height_m) {
  const double yaw_rad = base_from_marker.theta();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() << base_from_marker.x(), base_from_marker.y(), height_m;
  pose.linear().col(0) << -std::sin(yaw_rad), std::cos(yaw_rad), 0.0;  // right, as printed
  pose.linear().col(1) = Eigen::Vector3d::UnitZ();
  pose.linear().col(2) << std::cos(yaw_rad), std::sin(yaw_rad), 0.0;  // out of the wall
  return pose;
}

struct SeenCorners {
  std::array<Eigen::Vector2d, 4> px{};
  Matrix86 jacobian{Matrix86::Zero()};  ///< by (translation, rotation) in the optical frame
};

double side_px(const SeenCorners& seen, std::size_t side) {
  return (seen.px[(side + 1) % 4] - seen.px[side]).norm();
}

/// Mean of a side and the opposite one.
double mean_side_px(const SeenCorners& seen, std::size_t side) {
  return 0.5 * (side_px(seen, side) + side_px(seen, side + 2 - (side > 1 ? 4 : 0)));
}

/// Covariance of the perpendicular offsets of a side's two ends [px^2]: of the line through its
/// edge points, plus what all of them share.
Eigen::Matrix2d end_covariance(double length_px) {
  const double variance =
      kSharedNoise * kScatter_px * kScatter_px / std::max(kFewestPoints, length_px);
  Eigen::Matrix2d covariance;
  covariance << 4.0, -2.0, -2.0, 4.0;  // mean, and slope about it, at both ends
  const double common_px = RefinementConfig{}.corner_sigma_px;
  return variance * covariance + Eigen::Matrix2d::Constant(common_px * common_px);
}

Matrix8 corner_covariance(const SeenCorners& seen) {
  const auto outward = [&](std::size_t side) {
    const Eigen::Vector2d along = (seen.px[(side + 1) % 4] - seen.px[side]).normalized();
    return Eigen::Vector2d{along.y(), -along.x()};
  };
  Matrix8 by_sides = Matrix8::Zero();
  Matrix8 of_sides = Matrix8::Zero();
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t before = (k + 3) % 4;
    Eigen::Matrix2d normals;
    normals << outward(before).transpose(), outward(k).transpose();
    const Eigen::Matrix2d corner_by_shift = normals.inverse();
    const auto at = static_cast<Eigen::Index>(2 * k);
    by_sides.block<2, 1>(at, static_cast<Eigen::Index>(2 * before + 1)) = corner_by_shift.col(0);
    by_sides.block<2, 1>(at, at) = corner_by_shift.col(1);
    of_sides.block<2, 2>(at, at) = end_covariance(side_px(seen, k));
  }
  return by_sides * of_sides * by_sides.transpose();
}

/// The marker's wall as the LiDAR measures it: exactly in the marker's plane.
std::vector<AnnotatedBeam> beams_on_its_wall(const Se2& base_from_marker,
                                             std::span<const Eigen::Vector2d> hits_in_base,
                                             const Eigen::Vector2d& lidar_in_base, double reach_m) {
  const Eigen::Vector2d place = base_from_marker.translation();
  const Eigen::Vector2d normal = base_from_marker.rotation().col(0);
  std::vector<AnnotatedBeam> beams;
  for (const Eigen::Vector2d& hit : hits_in_base) {
    const double across_m = normal.dot(hit - place);
    if (std::abs(across_m) > kOnItsWall_m || (hit - place).norm() > reach_m) continue;
    AnnotatedBeam beam;
    beam.beam.start_in_base = lidar_in_base;
    beam.beam.end_in_base = hit - across_m * normal;
    beam.beam.range_m = (beam.beam.end_in_base - lidar_in_base).norm();
    beams.push_back(beam);
  }
  return beams;
}

}  // namespace

double read_share_of(double module_px) {
  if (module_px <= kReadShares.front().module_px) return 0.0;
  for (std::size_t i = 1; i < kReadShares.size(); ++i) {
    const ReadShare& from = kReadShares[i - 1];
    const ReadShare& to = kReadShares[i];
    if (module_px < to.module_px)
      return std::lerp(from.share, to.share,
                       (module_px - from.module_px) / (to.module_px - from.module_px));
  }
  return 1.0;
}

ViewModel::ViewModel(const SlamConfig& config, int modules_per_side, double marker_height_m)
    : robot_{config.robot},
      measurement_{config.slam.waymark.markers},
      odometry_{config.slam.waymark.odometry},
      base_from_camera_{config.robot.camera.base_from_camera()},
      camera_{config.robot.camera},
      modules_per_side_{modules_per_side},
      marker_height_m_{marker_height_m},
      max_sigma_m_{config.slam.preprocessing.max_sigma_m},
      reach_m_{config.robot.camera.fx_px * config.robot.markers.size_m /
               (kReadShares.front().module_px * modules_per_side)} {
  const EstimatorSetup setup = estimator_setup(config);
  sensors_ = {setup.range_sigma_m, setup.camera.base_from_camera, setup.sighting_noise};
}

std::optional<MarkerView> ViewModel::view(const Se2& base_from_marker,
                                          std::span<const Eigen::Vector2d> hits_in_base,
                                          double speed_mps) const {
  const Eigen::Isometry3d camera_from_marker =
      base_from_camera_.inverse() * upright(base_from_marker, marker_height_m_);
  if (camera_from_marker.linear().col(2).dot(camera_from_marker.translation()) >= 0.0)
    return std::nullopt;  // it faces away
  SeenCorners seen;
  const auto corners_m = corners_in_marker(robot_.markers.size_m);
  for (std::size_t k = 0; k < 4; ++k) {
    const Eigen::Vector3d arm = camera_from_marker.linear() * corners_m[k];
    const Eigen::Vector3d corner = arm + camera_from_marker.translation();
    if (corner.z() < kNearest_m) return std::nullopt;
    seen.px[k] = camera_.project(corner);
    const Eigen::Vector2d raw_px = camera_.raw_from_ideal(seen.px[k]);
    if (raw_px.x() < kImageMargin_px || raw_px.y() < kImageMargin_px ||
        raw_px.x() > robot_.camera.width_px - 1 - kImageMargin_px ||
        raw_px.y() > robot_.camera.height_px - 1 - kImageMargin_px) {
      return std::nullopt;
    }
    const auto projection = camera_.projection_jacobian(corner);
    Eigen::Matrix3d cross;
    cross << 0, -arm.z(), arm.y(), arm.z(), 0, -arm.x(), -arm.y(), arm.x(), 0;
    seen.jacobian.block<2, 3>(static_cast<Eigen::Index>(2 * k), 0) = projection;
    seen.jacobian.block<2, 3>(static_cast<Eigen::Index>(2 * k), 3) = -projection * cross;
  }
  const double width_px = std::min(mean_side_px(seen, 0), mean_side_px(seen, 1));
  MarkerView result;
  result.read_share = read_share_of(width_px / modules_per_side_);
  if (result.read_share <= 0.0) return std::nullopt;

  const Eigen::LLT<Matrix8> root{corner_covariance(seen)};
  const Matrix86 whitened = root.matrixL().solve(seen.jacobian);
  const Matrix6 in_camera = (whitened.transpose() * whitened).inverse();
  Matrix6 turn = Matrix6::Zero();
  turn.topLeftCorner<3, 3>() = turn.bottomRightCorner<3, 3>() = base_from_camera_.linear();
  const Matrix6 in_base = turn * in_camera * turn.transpose();
  MarkerSighting sighting;
  sighting.id = 0;
  sighting.base_from_marker = base_from_marker;
  sighting.covariance_in_base = planar_covariance(in_base);
  if (!sighting.covariance_in_base.allFinite() || sighting.sigma_along_wall_m() > max_sigma_m_)
    return std::nullopt;
  sighting.size_m = robot_.markers.size_m;
  sighting.driven_since_frame_m = 0.5 * speed_mps / robot_.camera.rate_hz;

  Observation observation;
  observation.sightings = {sighting};
  observation.beams =
      beams_on_its_wall(base_from_marker, hits_in_base,
                        robot_.lidar.base_from_lidar().translation(), measurement_.reach_m + 1.0);
  const auto measured = measure_markers(observation, sensors_, odometry_, measurement_);
  if (measured.empty()) return std::nullopt;
  result.measurement = measured.front();
  return result;
}

}  // namespace waymark::placement
