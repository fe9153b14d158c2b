// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/body_beams.hpp"

#include "common/geometry/median.hpp"
#include "import/findings/scan_overlay.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace waymark {
namespace {

constexpr double kMaxRange_m = 1.0;
constexpr double kSame_m = 0.05;
constexpr double kShareSame = 0.95;
constexpr std::size_t kScansOfBody = 500;  // largest number of scans examined
constexpr double kMinDriven_m = 20.0;
constexpr double kMinTurned_rad = 2.0 * std::numbers::pi;

double turned_rad(const std::vector<ImportedPose>& poses) {
  double sum = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i)
    sum += std::abs((poses[i - 1].pose.inverse() * poses[i].pose).theta());
  return sum;
}

}  // namespace

BodyBeams find_body_beams(const ImportedLog& log) {
  if (path_length_m(log.odometry) < kMinDriven_m || turned_rad(log.odometry) < kMinTurned_rad)
    return {};
  const auto num_beams = static_cast<std::size_t>(log.scans.front().num_beams);
  std::vector<std::vector<double>> ranges_m(num_beams);
  const std::size_t every = 1 + log.scans.size() / kScansOfBody;
  for (std::size_t i = 0; i < log.scans.size(); i += every) {
    const LidarScan scan = scan_of(log.scans[i]);
    if (scan.ranges_m.size() != num_beams) continue;
    for (std::size_t beam = 0; beam < num_beams; ++beam)
      ranges_m[beam].push_back(scan.ranges_m[beam]);
  }
  BodyBeams body;
  body.is_body.resize(num_beams, false);
  for (std::size_t beam = 0; beam < num_beams; ++beam) {
    std::vector<double>& of_beam = ranges_m[beam];
    const std::size_t all = of_beam.size();
    std::erase_if(of_beam, [](double range_m) { return !std::isfinite(range_m); });
    if (of_beam.empty()) continue;
    const double usual_m = upper_median(of_beam);
    const auto same = std::ranges::count_if(
        of_beam, [&](double range_m) { return std::abs(range_m - usual_m) < kSame_m; });
    if (usual_m <= 0.0 || usual_m > kMaxRange_m ||
        static_cast<double>(same) < kShareSame * static_cast<double>(all)) {
      continue;
    }
    body.is_body[beam] = true;
    body.longest_m = std::max(body.longest_m, usual_m);
    ++body.count;
  }
  return body.count > 0 ? body : BodyBeams{};
}

LidarScan without_body(LidarScan scan, const BodyBeams& body) {
  if (scan.ranges_m.size() != body.is_body.size()) return scan;
  for (std::size_t i = 0; i < body.is_body.size(); ++i)
    if (body.is_body[i]) scan.ranges_m[i] = std::numeric_limits<double>::quiet_NaN();
  return scan;
}

LidarScan usable(const ImportedScan& scan, const BodyBeams& body) {
  return in_order_of_angles(without_body(scan_of(scan), body));
}

}  // namespace waymark
