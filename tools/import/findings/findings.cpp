// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/findings.hpp"

#include "import/findings/range_noise.hpp"
#include "import/findings/reversed_odometry.hpp"
#include "import/findings/scan_overlay.hpp"
#include "import/findings/standing_odometry.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace waymark {
namespace {

constexpr std::size_t kScansForNoise = 1000;  // evenly over the log
constexpr double kLargestSigma_m = 1.0;
constexpr double kNearlyAll = 0.7;          // of the way
constexpr std::size_t kFewestReversed = 5;  // steps: fewer are found by chance

void estimate_range_noise(ImportedLog& log, ImportReport& report) {
  WallScatter noise;
  const std::size_t every = 1 + log.scans.size() / kScansForNoise;
  for (std::size_t i = 0; i < log.scans.size(); i += every)
    noise.add(scan_of(log.scans[i]));
  const auto sigma_m = noise.sigma_m();
  if (!sigma_m) {
    report.note(fmt::format(
        "the ranges' noise cannot be estimated (too few neighbouring ranges): {} m is written; if "
        "you know it, change range_sigma_m in robot.toml",
        log.robot.lidar.range_sigma_m));
    return;
  }
  log.robot.lidar.range_sigma_m = std::min(*sigma_m, kLargestSigma_m);
  report.note(
      fmt::format("ranges scatter by {:.4f} m{} about straight walls: written as the LiDAR's "
                  "noise; if you know "
                  "better, change range_sigma_m in robot.toml",
                  log.robot.lidar.range_sigma_m, *sigma_m > kLargestSigma_m ? " or more" : ""));
}

void check_that_odometry_moves(const ImportedLog& log, ImportReport& report) {
  const auto change_m = change_of_scans_while_standing_m(log);
  if (!change_m) return;
  report.note(fmt::format(
      "odometry says nothing: all {} poses are equal, but the scans change by {:.2f} m; only "
      "waymark can use this log, by scans alone and badly, unless another source has odometry "
      "(--odometry "
      "odom, --odometry-channel, --encoder-channel)",
      log.odometry.size(), *change_m));
}

/// No LiDAR measures as near: what is written there is a code.
void check_short_ranges(ImportedLog& log, ImportReport& report) {
  constexpr double kFew = 1e-3;
  std::int64_t all = 0;
  std::int64_t shorter = 0;
  for (const ImportedScan& imported : log.scans) {
    for (const double range_m : scan_of(imported).ranges_m) {
      ++all;
      if (range_m > 0.0 && range_m < kShortestRange_m) ++shorter;
    }
  }
  if (log.robot.lidar.range_min_m >= kShortestRange_m ||
      static_cast<double>(shorter) <= kFew * static_cast<double>(all)) {
    return;
  }
  log.robot.lidar.range_min_m = kShortestRange_m;
  report.note(
      fmt::format("{} ranges are below {} m: taken as not measured; --min-range-m says "
                  "otherwise",
                  shorter, kShortestRange_m));
}

BodyBeams check_body(const ImportedLog& log, ImportReport& report) {
  BodyBeams body = find_body_beams(log);
  if (body.count > 0 && log.robot.lidar.range_min_m < body.longest_m) {
    report.note(fmt::format(
        "{} beams always show the same {:.2f} m or less, as if they ended on the robot: left as "
        "they are; --min-range-m {:.2f} leaves them out",
        body.count, body.longest_m, body.longest_m + 0.1));
  }
  return body;
}

void check_direction(ImportedLog& log, const BodyBeams& body, ReversedOdometry wanted,
                     ImportReport& report) {
  const std::vector<ReversedStep> steps = find_reversed_steps(log, body);
  if (steps.size() < kFewestReversed) return;
  double distance_m = 0.0;
  for (const ReversedStep& step : steps)
    distance_m += step.distance_m;
  const std::string found = fmt::format(
      "odometry counts backing up as driving forward in {} steps between scans, {:.1f} m, first at "
      "{:.3f} s",
      steps.size(), distance_m, to_seconds(steps.front().after));
  const bool is_nearly_all = distance_m > kNearlyAll * path_length_m(log.odometry);
  if (is_nearly_all && wanted == ReversedOdometry::kName) {
    report.note(fmt::format(
        "scans move against odometry nearly everywhere ({:.1f} m): does the LiDAR look backwards "
        "(--lidar-yaw-deg 180)?",
        distance_m));
  } else if (wanted == ReversedOdometry::kMend) {
    log.odometry = with_steps_mended(log.odometry, steps);
    report.note(found + ": turned round, as asked for");
  } else {
    report.note(found + ": left as it is; --fix-reversed-odometry turns it round");
  }
}

}  // namespace

void examine(ImportedLog& log, ReversedOdometry reversed, ImportReport& report) {
  check_short_ranges(log, report);
  estimate_range_noise(log, report);
  check_that_odometry_moves(log, report);
  const BodyBeams body = check_body(log, report);
  check_direction(log, body, reversed, report);
}

}  // namespace waymark
