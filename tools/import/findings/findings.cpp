// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/findings.hpp"

#include "import/findings/range_noise.hpp"
#include "import/findings/reversed_odometry.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace waymark {
namespace {

constexpr std::size_t kScansForNoise = 500;  // evenly over the log
constexpr double kLargestSigma_m = 1.0;
constexpr std::size_t kFewestReversed = 5;

void estimate_range_noise(ImportedLog& log, ImportReport& report) {
  RangeNoise noise;
  const std::size_t every = std::max<std::size_t>(1, log.scans.size() / kScansForNoise);
  for (std::size_t i = 0; i < log.scans.size(); i += every)
    noise.add(scan_of(log.scans[i]));
  const auto sigma_m = noise.sigma_m();
  if (!sigma_m) {
    report.note(
        fmt::format("too few neighbouring ranges to estimate their noise: {} m is taken; "
                    "range_sigma_m in robot.toml says otherwise",
                    log.robot.lidar.range_sigma_m));
    return;
  }
  log.robot.lidar.range_sigma_m = std::min(*sigma_m, kLargestSigma_m);
  report.note(
      fmt::format("neighbouring beams scatter by {:.4f} m about straight walls: written as the "
                  "LiDAR's noise; range_sigma_m in robot.toml says otherwise",
                  log.robot.lidar.range_sigma_m));
}

void check_direction(ImportedLog& log, ReversedOdometry wanted, ImportReport& report) {
  const std::vector<ReversedStep> steps = find_reversed_steps(log);
  if (steps.size() < kFewestReversed) return;
  double distance_m = 0.0;
  for (const ReversedStep& step : steps)
    distance_m += step.distance_m;
  const std::string found = fmt::format(
      "odometry counts backing up as driving forward: {} steps between scans, {:.1f} m, first at "
      "{:.3f} s",
      steps.size(), distance_m, to_seconds(steps.front().after));
  if (wanted == ReversedOdometry::kMend) {
    log.odometry = with_steps_mended(log.odometry, steps);
    report.note(found + "; mended, as asked for");
  } else {
    report.note(found + "; left as it is, --fix-reversed-odometry mends it");
  }
}

}  // namespace

void examine(ImportedLog& log, ReversedOdometry reversed, ImportReport& report) {
  estimate_range_noise(log, report);
  check_direction(log, reversed, report);
}

}  // namespace waymark
