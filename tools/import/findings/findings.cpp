// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/findings.hpp"

#include "common/time/date_text.hpp"
#include "import/findings/motion_fit.hpp"
#include "import/findings/odometry_breaks.hpp"
#include "import/findings/range_noise.hpp"
#include "import/findings/reversed_odometry.hpp"
#include "import/findings/scan_overlay.hpp"
#include "import/findings/standing_odometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace waymark {
namespace {

constexpr std::size_t kScansForNoise = 1000;  // largest number of scans examined
constexpr double kLargestSigma_m = 1.0;
constexpr double kNearlyAll = 0.7;       // share of the path length that counts as all of it
constexpr std::size_t kMinReversed = 5;  // steps; fewer may be chance

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

/// Shifts odometry to the origin if it begins far away: poses are written as float, which is too
/// coarse at the coordinates of a map grid (UTM).
void start_near_the_origin(ImportedLog& log, ImportReport& report) {
  constexpr double kFar_m = 1000.0;
  const auto farthest_m = [&](const Eigen::Vector2d& origin) {
    double most_m = 0.0;
    for (const ImportedPose& sample : log.odometry)
      most_m = std::max(most_m, (sample.pose.translation() - origin).cwiseAbs().maxCoeff());
    return most_m;
  };
  const Eigen::Vector2d start = log.odometry.front().pose.translation();
  const double before_m = farthest_m(Eigen::Vector2d::Zero());
  if (before_m <= kFar_m || farthest_m(start) >= before_m) return;
  for (ImportedPose& sample : log.odometry)
    sample.pose = Se2{sample.pose.translation() - start, sample.pose.theta()};
  report.note(fmt::format(
      "odometry starts at ({:.3f}, {:.3f}) m, too far away for the floats that are written: it is "
      "shifted to start at (0, 0)",
      start.x(), start.y()));
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

/// Reports ranges below kShortestRange_m, which are codes, not measurements.
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

std::string unit_text(double factor) {
  struct Unit {
    double per_m;
    std::string_view name;
  };

  constexpr std::array<Unit, 4> kUnits{
      {{0.01, "centimetres"}, {0.001, "millimetres"}, {0.0254, "inches"}, {0.3048, "feet"}}};
  constexpr double kSame = 1.15;  // the factor is found to 5 %
  for (const Unit& unit : kUnits) {
    if (factor < kSame * unit.per_m && unit.per_m < kSame * factor)
      return fmt::format("they may be {}: --odometry-scale {}", unit.name, unit.per_m);
  }
  return fmt::format("--odometry-scale {:.2g} puts that right", factor);
}

/// @return true if odometry's distances agree with the scans.
bool check_distances(const ImportedLog& log, const BodyBeams& body, ImportReport& report) {
  const auto factor = odometry_factor(log, body);
  if (!factor) return true;
  report.note(
      fmt::format("odometry's distances are about {:.3g} times those that the scans show: {}",
                  1.0 / *factor, unit_text(*factor)));
  return false;
}

void check_turns(const ImportedLog& log, const BodyBeams& body, ImportReport& report) {
  if (!turns_against_odometry(log, body)) return;
  report.note(
      "scans turn the other way round than odometry: if the LiDAR's beams count clockwise, the map "
      "will be a mirror image; robot.lidar.mirrored = true in robot.toml puts that right. If the "
      "headings of odometry do, only its calibration will be odd");
}

void check_yaw(const ImportedLog& log, const BodyBeams& body, ImportReport& report) {
  constexpr double kMinYaw_rad = radians(3.0);  // real logs are within 2.1 degrees
  constexpr double kSigmas = 5.0;
  const auto error = lidar_yaw_error(log, body);
  if (!error || std::abs(error->yaw_rad) < std::max(kMinYaw_rad, kSigmas * error->sigma_rad))
    return;
  report.note(fmt::format(
      "the walls pass by as if the LiDAR looked {:.1f} +- {:.1f} degrees further to the {} than "
      "described: left as it is; if it is mounted like that, give --lidar-yaw-deg {:.1f}",
      degrees(std::abs(error->yaw_rad)), degrees(error->sigma_rad),
      error->yaw_rad > 0.0 ? "left" : "right",
      degrees(wrap_angle(log.robot.lidar.yaw_rad + error->yaw_rad))));
}

void check_direction(ImportedLog& log, const BodyBeams& body, ReversedOdometry wanted,
                     ImportReport& report) {
  const std::vector<ReversedStep> steps = find_reversed_steps(log, body);
  if (steps.size() < kMinReversed) return;
  double distance_m = 0.0;
  for (const ReversedStep& step : steps)
    distance_m += step.distance_m;
  const std::string found = fmt::format(
      "odometry counts backing up as driving forward in {} steps between scans, {:.1f} m, first at "
      "{}",
      steps.size(), distance_m, date_text(steps.front().after));
  const bool is_nearly_all = distance_m > kNearlyAll * path_length_m(log.odometry);
  if (is_nearly_all && wanted == ReversedOdometry::kReport) {
    report.note(fmt::format(
        "scans move against odometry nearly everywhere ({:.1f} m): does the LiDAR look backwards "
        "(--lidar-yaw-deg 180)?",
        distance_m));
  } else if (wanted == ReversedOdometry::kCorrect) {
    log.odometry = with_steps_corrected(log.odometry, steps);
    report.note(found + ": turned round, as asked for");
  } else {
    report.note(found + ": left as it is; --fix-reversed-odometry turns it round");
  }
}

}  // namespace

void examine(ImportedLog& log, ReversedOdometry reversed, ImportReport& report) {
  check_short_ranges(log, report);
  repair_odometry_breaks(log, report);
  start_near_the_origin(log, report);
  estimate_range_noise(log, report);
  check_that_odometry_moves(log, report);
  const BodyBeams body = check_body(log, report);
  if (!check_distances(log, body, report)) return;  // the checks below need correct distances
  check_turns(log, body, report);
  check_yaw(log, body, report);
  check_direction(log, body, reversed, report);
}

}  // namespace waymark
