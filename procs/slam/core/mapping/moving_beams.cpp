// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/mapping/moving_beams.hpp"

#include "slam/core/mapping/seen_through.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <utility>

namespace waymark {
namespace {

constexpr double kSigmas = 3.0;
constexpr double kMaxUncertainty_m = 0.3;  // a beam whose end is more uncertain is kept
constexpr double kOutlineCell_m = 0.2;

/// Length of the outline that the points show, in cells: most beams of a scan may end on somebody
/// who is close by.
std::size_t outline_length(const std::vector<Eigen::Vector2d>& points) {
  std::set<std::pair<std::int64_t, std::int64_t>> cells;
  for (const Eigen::Vector2d& point : points)
    cells.emplace(std::llround(point.x() / kOutlineCell_m),
                  std::llround(point.y() / kOutlineCell_m));
  return cells.size();
}

}  // namespace

std::vector<Eigen::Vector2d> without_moving(const std::vector<Eigen::Vector2d>& points_in_base,
                                            const GridMap& map, const Se2& map_from_base,
                                            const Eigen::Matrix3d& covariance) {
  const double position_m2 = 0.5 * covariance.topLeftCorner<2, 2>().trace();
  std::vector<Eigen::Vector2d> standing;
  standing.reserve(points_in_base.size());
  for (const Eigen::Vector2d& point : points_in_base) {
    const double off_m = kSigmas * std::sqrt(position_m2 + covariance(2, 2) * point.squaredNorm());
    if (off_m > kMaxUncertainty_m || !is_seen_through(map, map_from_base * point, off_m))
      standing.push_back(point);
  }
  if (standing.size() == points_in_base.size()) return standing;
  return 2 * outline_length(standing) < outline_length(points_in_base) ? points_in_base : standing;
}

}  // namespace waymark
