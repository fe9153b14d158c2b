// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/landmark/misreading.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kSamePlace = 0.25;  // of a marker's side; boards have them side by side
constexpr double kSameFacing_rad = radians(45.0);  // a wall has two sides

}  // namespace

bool is_misread(const MarkerMeasurement& measurement, const Se2& map_from_base,
                std::span<const Landmark> known) {
  const Se2 there = map_from_base * measurement.base_from_marker;
  return std::any_of(known.begin(), known.end(), [&](const Landmark& marker) {
    const Eigen::Vector3d away = deviation(marker.map_from_marker, there);
    return marker.id != measurement.id && marker.is_confirmed() && !marker.is_missed() &&
           away.head<2>().norm() < kSamePlace * measurement.size_m &&
           std::abs(away.z()) < kSameFacing_rad;
  });
}

}  // namespace waymark
