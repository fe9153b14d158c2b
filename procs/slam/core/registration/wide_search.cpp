// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/wide_search.hpp"

#include "slam/core/registration/correlative_search.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr double kReach_m = 0.5;
constexpr double kReach_rad = 0.6;
constexpr std::size_t kBeams = 120;
constexpr double kClearlyMore = 1.05;                  // inliers than the best match so far has
const Eigen::Vector3d kFoundSigmas{0.05, 0.05, 0.03};  // of a search: a cell, a step of its turns

}  // namespace

ScanMatch searched_widely(const ScanMatch& plain, const Points& points, const NdtMap& surfaces,
                          const Points& occupied, std::span<const Se2> guesses,
                          const UsualFit& usual, const RangeNoise& noise,
                          const ScanMatchConfig& config, double min_score) {
  const CorrelativeField field{occupied};
  const Points beams = thinned(points, kBeams);
  const Eigen::Matrix3d near = kFoundSigmas.cwiseAbs2().asDiagonal();
  ScanMatch best = plain;
  for (const Se2& guess : guesses) {
    const auto place = field.best(beams, guess, {kReach_m, kReach_rad}, min_score);
    if (!place) continue;
    const ScanMatch other =
        match_scan(points, surfaces, place->submap_from_base, near, noise, config);
    if (other.inliers > kClearlyMore * best.inliers &&
        (usual.is_contradicted(best) || !usual.is_worse_than_usual(other))) {
      best = other;
    }
  }
  return best;
}

double wide_search_reach_m(const Points& points) {
  double farthest_m = 0.0;
  for (const Eigen::Vector2d& point : points)
    farthest_m = std::max(farthest_m, point.norm());
  return farthest_m + kReach_m;
}

}  // namespace waymark
