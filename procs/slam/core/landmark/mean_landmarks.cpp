// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/landmark/mean_landmarks.hpp"

#include "slam/core/proposal/pose_information.hpp"

#include <algorithm>
#include <tuple>

namespace waymark {
namespace {

Landmark mean_landmark(const Landmark& about, std::size_t index,
                       std::span<const WeighedLandmarks> particles, double same_within_m) {
  double weight = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d within = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (const WeighedLandmarks& particle : particles) {
    if (index >= particle.markers.size()) continue;
    const Landmark& other = particle.markers[index];
    if (other.id != about.id) continue;
    const Eigen::Vector3d away = deviation(about.map_from_marker, other.map_from_marker);
    if (away.head<2>().norm() > same_within_m) continue;
    weight += particle.weight;
    mean += particle.weight * away;
    within += particle.weight * other.covariance;
    squares += particle.weight * away * away.transpose();
  }
  mean /= weight;
  Landmark landmark = about;
  landmark.map_from_marker = deviated(about.map_from_marker, mean);
  landmark.covariance = within / weight + squares / weight - mean * mean.transpose();
  return landmark;
}

}  // namespace

std::vector<Landmark> mean_landmarks(std::span<const WeighedLandmarks> particles, std::size_t best,
                                     double same_within_m) {
  std::vector<Landmark> landmarks;
  for (std::size_t i = 0; i < particles[best].markers.size(); ++i)
    landmarks.push_back(mean_landmark(particles[best].markers[i], i, particles, same_within_m));
  std::sort(landmarks.begin(), landmarks.end(), [](const Landmark& a, const Landmark& b) {
    return std::tie(a.id, a.instance) < std::tie(b.id, b.instance);
  });
  return landmarks;
}

}  // namespace waymark
