// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/points_in_map.hpp"

#include "common/geometry/squared.hpp"
#include "slam/core/registration/scan_match.hpp"

#include <algorithm>

namespace waymark {
namespace {

// Largest number of beams in one cell that count as independent: the error of the cell's mean is
// common to all of them, and so is the displacement if they end on a person.
constexpr double kIndependentBeams = 4.0;
// The information of a beam has the factor n / (n + kFewKeyframes), where n is the number of
// keyframes from the first to the last that observed its cell: the error of the cell's mean falls
// with n, and a person stays at one place for a few keyframes only.
constexpr double kFewKeyframes = 3.0;

double known_share(const NdtCell& cell) {
  const int seen_from = num_keyframes(cell);
  return seen_from == 0 ? 1.0 : seen_from / (seen_from + kFewKeyframes);
}

/// Adds a residual along `direction`, with d(residual)/d(x, y, theta) = (direction, by_turn).
void add(const Eigen::Vector2d& direction, const Eigen::Vector2d& lever, double distance_m,
         double weight, Quadratic& sum) {
  const double by_turn = lever.x() * direction.y() - lever.y() * direction.x();
  const double wx = weight * direction.x();
  const double wy = weight * direction.y();
  sum.information(0, 0) += wx * direction.x();
  sum.information(0, 1) += wx * direction.y();
  sum.information(1, 1) += wy * direction.y();
  sum.information(0, 2) += wx * by_turn;
  sum.information(1, 2) += wy * by_turn;
  sum.information(2, 2) += weight * by_turn * by_turn;
  sum.gradient += weight * distance_m * Eigen::Vector3d{direction.x(), direction.y(), by_turn};
}

}  // namespace

double independent_share(int beams) {
  return std::min(1.0, kIndependentBeams / beams);
}

int num_keyframes(const NdtCell& cell) {
  return cell.last_keyframe == kNoKeyframe ? 0 : cell.last_keyframe - cell.first_keyframe + 1;
}

BeamTerm compare(const NdtCell& cell, const Eigen::Vector2d& point, const Eigen::Vector2d& ray,
                 double point_variance_m2, double blur_m2, const ScanMatchConfig& config) {
  BeamTerm term;
  const Eigen::Vector2d distance = point - cell.mean;
  term.normal = cell.normal;
  term.across_m = term.normal.dot(distance);
  // A cell may be thin by chance: the variance is at least the range noise along its normal.
  const double by_range_m2 = point_variance_m2 * squared(term.normal.dot(ray)) / ray.squaredNorm();
  term.across_weight =
      1.0 / (std::max(cell.across_m2, by_range_m2) + squared(config.roughness_m) + blur_m2);
  double chi2 = term.across_weight * squared(term.across_m);
  if (!cell.is_line) {
    term.along_m = term.normal.x() * distance.y() - term.normal.y() * distance.x();
    term.along_weight = 1.0 / (cell.along_m2 + blur_m2);
    chi2 += term.along_weight * squared(term.along_m);
  }
  const double kernel2 = squared(config.kernel_sigmas);
  term.robust = squared(kernel2 / (kernel2 + chi2));
  term.across_weight *= term.robust;
  term.along_weight *= term.robust;
  return term;
}

PointsInMap::PointsInMap(std::span<const Eigen::Vector2d> points, const NdtMap& map,
                         double point_variance_m2, bool uses_parts)
    : points_{points},
      map_{map},
      point_variance_m2_{point_variance_m2},
      uses_parts_{uses_parts && map.is_divided()},
      places_(points.size()) {}

Quadratic PointsInMap::quadratic_about(const Se2& pose, double blur_m2,
                                       const ScanMatchConfig& config, int min_keyframes) {
  Quadratic sum;
  const Eigen::Matrix2d rotation = pose.rotation();
  for (std::size_t i = 0; i < points_.size(); ++i)
    find_place(i, rotation * points_[i] + pose.translation());
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const NdtCell* cell = places_[i].cell;
    if (cell == nullptr || num_keyframes(*cell) < min_keyframes) continue;
    const Eigen::Vector2d lever = rotation * points_[i];
    const Eigen::Vector2d there = lever + pose.translation();
    const BeamTerm term = compare(*cell, there, lever, point_variance_m2_, blur_m2, config);
    const double share = independent_share(*places_[i].beams) * known_share(*cell);
    add(term.normal, lever, term.across_m, share * term.across_weight, sum);
    if (term.along_weight <= 0.0) continue;
    const Eigen::Vector2d along{-term.normal.y(), term.normal.x()};
    add(along, lever, term.along_m, share * term.along_weight, sum);
  }
  sum.information.bottomLeftCorner<1, 2>() = sum.information.topRightCorner<2, 1>().transpose();
  sum.information(1, 0) = sum.information(0, 1);
  return sum;
}

void PointsInMap::find_place(std::size_t point, const Eigen::Vector2d& there) {
  Place& place = places_[point];
  const NdtMap::Key key = uses_parts_ ? map_.part_at(there) : map_.key_at(there);
  if (place.is_known && place.key == key) return;
  if (place.cell != nullptr) --*place.beams;
  const NdtCell* cell =
      uses_parts_ ? map_.at_part(key, point_variance_m2_) : map_.at(key, point_variance_m2_);
  place = {key, cell, nullptr, true};
  if (place.cell == nullptr) return;
  place.beams = &beams_on_[uses_parts_ ? NdtMap::cell_of_part(key) : key];
  ++*place.beams;
}

}  // namespace waymark
