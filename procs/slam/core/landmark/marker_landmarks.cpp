// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/landmark/marker_landmarks.hpp"

#include <Eigen/LU>

namespace waymark {

Innovation compare(const MarkerMeasurement& measurement, const Se2& map_from_marker,
                   const Eigen::Matrix3d& marker_covariance, const Se2& map_from_base) {
  const Se2 expected = map_from_base.inverse() * map_from_marker;
  const Eigen::Matrix2d turn_back = map_from_base.rotation().transpose();
  Innovation innovation;
  innovation.residual = deviation(expected, measurement.base_from_marker);
  innovation.by_landmark.setIdentity();
  innovation.by_landmark.topLeftCorner<2, 2>() = turn_back;
  innovation.by_pose = -innovation.by_landmark;
  // Turning the robot left moves the marker to the right of it.
  innovation.by_pose(0, 2) = expected.y();
  innovation.by_pose(1, 2) = -expected.x();
  innovation.covariance = measurement.covariance + innovation.by_landmark * marker_covariance *
                                                       innovation.by_landmark.transpose();
  return innovation;
}

PoseInformation information_of(const Innovation& innovation) {
  const Eigen::Matrix3d inverse = innovation.covariance.inverse();
  PoseInformation pose;
  pose.information = innovation.by_pose.transpose() * inverse * innovation.by_pose;
  pose.gradient = -innovation.by_pose.transpose() * inverse * innovation.residual;
  pose.cost = 0.5 * innovation.residual.dot(inverse * innovation.residual) +
              0.5 * std::log(innovation.covariance.determinant());
  return pose;
}

std::optional<MarkerLandmarks::Candidate> MarkerLandmarks::nearest(
    const MarkerMeasurement& measurement, const Se2& map_from_base,
    const Eigen::Matrix3d& pose_covariance) const {
  std::optional<Candidate> nearest;
  for (std::size_t i = 0; i < size(); ++i) {
    if ((*this)[i].id != measurement.id) continue;
    Candidate candidate{compare_with(i, measurement, map_from_base)};
    const Innovation& innovation = candidate.innovation;
    const Eigen::Matrix3d spread = innovation.covariance + innovation.by_pose * pose_covariance *
                                                               innovation.by_pose.transpose();
    candidate.distance = innovation.residual.dot(spread.inverse() * innovation.residual);
    candidate.distance_m = innovation.residual.head<2>().norm();
    if (!nearest || candidate.distance < nearest->distance) nearest = candidate;
  }
  return nearest;
}

Innovation MarkerLandmarks::compare_with(std::size_t landmark, const MarkerMeasurement& measurement,
                                         const Se2& map_from_base) const {
  Innovation innovation = compare(measurement, (*this)[landmark].map_from_marker,
                                  (*this)[landmark].covariance, map_from_base);
  innovation.landmark = landmark;
  return innovation;
}

void MarkerLandmarks::update(std::size_t landmark, const MarkerMeasurement& measurement,
                             const Se2& map_from_base) {
  const Innovation innovation = compare_with(landmark, measurement, map_from_base);
  Landmark& known = landmarks_[landmark].edit();
  const Eigen::Matrix3d gain =
      known.covariance * innovation.by_landmark.transpose() * innovation.covariance.inverse();
  known.map_from_marker = deviated(known.map_from_marker, gain * innovation.residual);
  known.covariance -= (gain * innovation.by_landmark * known.covariance).eval();
  known.covariance = (0.5 * (known.covariance + known.covariance.transpose())).eval();
  ++known.sightings;
  known.last_seen = measurement.time;
}

void MarkerLandmarks::add(const MarkerMeasurement& measurement, const Se2& map_from_base) {
  Landmark fresh;
  fresh.id = measurement.id;
  for (std::size_t i = 0; i < size(); ++i)
    if ((*this)[i].id == fresh.id) ++fresh.instance;
  fresh.map_from_marker = map_from_base * measurement.base_from_marker;
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = map_from_base.rotation();
  fresh.covariance = turn * measurement.covariance * turn.transpose();
  fresh.sightings = 1;
  fresh.first_seen = measurement.time;
  fresh.last_seen = measurement.time;
  landmarks_.emplace_back().edit() = fresh;
}

}  // namespace waymark
