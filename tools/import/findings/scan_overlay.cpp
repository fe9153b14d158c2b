// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/scan_overlay.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kLargestError_m = 0.3;  // limit for a beam: larger errors are from another wall
// Ranges are interpolated between neighbouring beams on the same wall, which differ at most by:
constexpr double kSameWall_m = 0.3;
constexpr double kWidestGap_rad = 0.1;
constexpr std::size_t kMinSharedBeams = 30;

/// The scan's interpolated range in a direction; nullopt at edges, in gaps, and outside the scan.
std::optional<double> range_towards(const LidarScan& scan, double angle_rad) {
  const auto after = std::ranges::upper_bound(scan.angles_rad, angle_rad);
  if (after == scan.angles_rad.begin() || after == scan.angles_rad.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - scan.angles_rad.begin());
  const double gap_rad = scan.angles_rad[i] - scan.angles_rad[i - 1];
  const double low_m = scan.ranges_m[i - 1];
  const double high_m = scan.ranges_m[i];
  if (gap_rad > kWidestGap_rad || std::abs(high_m - low_m) > kSameWall_m) return std::nullopt;
  return low_m + (angle_rad - scan.angles_rad[i - 1]) / gap_rad * (high_m - low_m);
}

}  // namespace

LidarScan in_order_of_angles(const LidarScan& scan) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    if (std::isfinite(scan.ranges_m[i]) && scan.ranges_m[i] > kShortestRange_m) order.push_back(i);
  }
  std::ranges::stable_sort(order, {},
                           [&scan](std::size_t i) { return wrap_angle(scan.angles_rad[i]); });
  LidarScan ordered{scan.time, {}, {}, {}};
  for (const std::size_t i : order) {
    ordered.ranges_m.push_back(scan.ranges_m[i]);
    ordered.angles_rad.push_back(wrap_angle(scan.angles_rad[i]));
  }
  return ordered;
}

std::optional<double> misfit_m(const LidarScan& first, const LidarScan& second,
                               const Se2& first_from_second) {
  double sum_m = 0.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < second.ranges_m.size(); ++i) {
    const double range_m = second.ranges_m[i];
    const Eigen::Vector2d end =
        first_from_second * Eigen::Vector2d{range_m * std::cos(second.angles_rad[i]),
                                            range_m * std::sin(second.angles_rad[i])};
    const auto expected_m = range_towards(first, std::atan2(end.y(), end.x()));
    if (!expected_m) continue;
    sum_m += std::min(std::abs(*expected_m - end.norm()), kLargestError_m);
    ++count;
  }
  if (count < kMinSharedBeams) return std::nullopt;
  return sum_m / static_cast<double>(count);
}

}  // namespace waymark
