// SPDX-License-Identifier: BSD-3-Clause
// Checks of odometry, mounting and time offset against the LiDAR's motion.
#include "doctor/checks.hpp"
#include "doctor/verdict.hpp"
#include "import/findings/reversed_odometry.hpp"
#include "import/findings/standing_odometry.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace waymark {
namespace {

constexpr DeviationLimits kScale{0.03, 0.1};     // deviation from 1
constexpr DeviationLimits kOffset_s{0.02, 0.1};  // at 1 rad/s, 17 ms are a degree
constexpr DeviationLimits kPlace_m{0.03, 0.1};
constexpr DeviationLimits kAngle_rad{0.026, 0.087};  // 1.5 and 5 degrees
constexpr std::size_t kMinReversed = 5;              // as in waymark-import

Check no_turns(std::string name) {
  return unchecked(std::move(name), "the robot turns too little (less than once around in all)",
                   "record a log with a few turns on the spot");
}

Check no_motions(std::string name) {
  return unchecked(std::move(name), "too few motions that the scans show in all directions",
                   "record a log of a minute with turns, in a room rather than a bare corridor");
}

constexpr const char* kUnrelated = "turns of LiDAR and odometry have nothing to do with each other";
constexpr const char* kOneClock = "stamp both with one clock, when they are measured";

std::string name_or(const std::string& channel, const char* what) {
  return channel.empty() ? what : channel;
}

}  // namespace

std::string later_than_odometry(double late_s, const DoctorInput& input) {
  return fmt::format("{:.1f} s {} than those of {}", std::abs(late_s),
                     late_s > 0.0 ? "later" : "earlier",
                     name_or(input.odometry_channel, "odometry"));
}

Check unrelated_motions(std::string name) {
  return unchecked(std::move(name), kUnrelated,
                   "first see time_offset: check the times of both, and that both are of this "
                   "robot");
}

double usable_lateness_s(const TurnComparison& turns) {
  return is_known(turns.lidar_late_s, kOffset_s) ? turns.lidar_late_s.value : 0.0;
}

Check check_odometry_moves(const ImportedLog& log) {
  if (const auto change_m = change_of_scans_while_standing_m(log)) {
    return {"odometry_moves", Verdict::kFail,
            fmt::format("odometry is the same pose all the time, but the scans change by {:.2f} m",
                        *change_m),
            "connect the encoders; without odometry only waymark works, by scans alone and badly",
            *change_m};
  }
  const double length_m = path_length_m(log.odometry);
  if (length_m == 0.0) {
    return unchecked("odometry_moves", "the robot stands all the time",
                     "record a log in which it drives and turns");
  }
  return {"odometry_moves", Verdict::kPass, fmt::format("odometry drives {:.1f} m", length_m), "",
          length_m};
}

Check check_mirror(const std::optional<TurnComparison>& turns, RobotConfig& robot) {
  if (!turns) return no_turns("lidar_mirrored");
  const double ratio = turns->ratio.value;
  if (!turns->are_related()) return unrelated_motions("lidar_mirrored");
  if (ratio < 0.0) robot.lidar.mirrored = !robot.lidar.mirrored;
  return {"lidar_mirrored", ratio > 0.0 ? Verdict::kPass : Verdict::kFail,
          fmt::format("LiDAR and odometry turn {} (ratio {:.3f} over {:.1f} rad)",
                      ratio > 0.0 ? "the same way" : "opposite ways", ratio, turns->turned_rad),
          ratio > 0.0 ? ""
                      : fmt::format("the LiDAR is mounted upside down or its driver counts angles "
                                    "clockwise: robot.lidar.mirrored = {}; or swap the wheels' "
                                    "encoders",
                                    robot.lidar.mirrored),
          ratio};
}

Check check_turn_scale(const std::optional<TurnComparison>& turns) {
  if (!turns) return no_turns("odometry_turn_scale");
  if (!turns->are_related()) return unrelated_motions("odometry_turn_scale");
  const double scale = std::abs(turns->ratio.value);
  const Verdict verdict = verdict_of(scale - 1.0, turns->ratio.sigma, kScale);
  return {"odometry_turn_scale", verdict,
          fmt::format("odometry turns {:.3f} +- {:.3f} times as far as the LiDAR", scale,
                      turns->ratio.sigma),
          verdict == Verdict::kPass
              ? ""
              : fmt::format("multiply the distance between the wheels by {:.3f} where ticks become "
                            "odometry",
                            scale),
          scale};
}

Check check_time_offset(const DoctorInput& input, const std::optional<TurnComparison>& turns,
                        RobotConfig& robot) {
  const auto far_off = [&](double late_s, std::string_view source) -> Check {
    return {"time_offset", Verdict::kFail,
            fmt::format("the stamps of {} are {}: {}", name_or(input.lidar_channel, "the LiDAR"),
                        later_than_odometry(late_s, input), source),
            kOneClock, 1e3 * late_s};
  };
  if (input.log.odometry_shift != Duration{0}) {
    return far_off(to_seconds(input.log.odometry_shift) + (turns ? turns->lidar_late_s.value : 0.0),
                   "by the times at which the log received them (corrected for the other checks)");
  }
  if (!turns) return no_turns("time_offset");
  if (turns->far_late_s)
    return far_off(robot.lidar.late_s + *turns->far_late_s, "there the turns of both fit");
  if (turns->are_contradictory()) {
    return unchecked("time_offset", fmt::format("{}, at no offset within 10 s", kUnrelated),
                     "check that both are of this robot, that odometry counts turns, and that both "
                     "are stamped with one clock");
  }
  const Measured& late = turns->lidar_late_s;
  if (!is_known(late, kOffset_s)) {
    return unchecked(
        "time_offset",
        fmt::format("the turns are too even (standard deviation {:.0f} ms)", 1e3 * late.sigma),
        "record a log with turns that start and stop");
  }
  const Verdict verdict = verdict_of(late.value, late.sigma, kOffset_s);
  const double described_s = robot.lidar.late_s;
  const double found_s = described_s + late.value;
  if (is_worth_writing(verdict, late.value, late.sigma, kOffset_s)) robot.lidar.late_s = found_s;
  return {"time_offset", verdict,
          fmt::format(
              "the LiDAR's stamps are {:.0f} +- {:.0f} ms {} odometry's, described is {:.0f} ms",
              1e3 * std::abs(found_s), 1e3 * late.sigma, found_s >= 0.0 ? "behind" : "ahead of",
              1e3 * described_s),
          verdict == Verdict::kPass
              ? ""
              : fmt::format("robot.lidar.late_s = {:.4f}, or stamp both where they are measured",
                            found_s),
          1e3 * found_s};
}

Check check_distance_scale(const std::optional<HandEye>& calibration) {
  if (!calibration) return no_motions("odometry_distance_scale");
  const Measured& scale = calibration->scale;
  if (!is_known(scale, kScale)) return no_motions("odometry_distance_scale");
  const Verdict verdict = verdict_of(scale.value - 1.0, scale.sigma, kScale);
  return {"odometry_distance_scale", verdict,
          fmt::format("odometry drives {:.3f} +- {:.3f} times as far as the LiDAR", scale.value,
                      scale.sigma),
          verdict == Verdict::kPass
              ? ""
              : fmt::format("divide the wheels' radius by {:.3f} where ticks become odometry",
                            scale.value),
          scale.value};
}

Check check_backing_up(const ImportedLog& log) {
  if (path_length_m(log.odometry) == 0.0) {
    return unchecked("backing_up", "odometry does not move", "record a log in which it drives");
  }
  const std::vector<ReversedStep> steps = find_reversed_steps(log);
  double distance_m = 0.0;
  for (const ReversedStep& step : steps)
    distance_m += step.distance_m;
  if (steps.size() < kMinReversed) {
    return {"backing_up", Verdict::kPass, "odometry and scans agree on the direction of driving",
            "", 0.0};
  }
  return {"backing_up", Verdict::kFail,
          fmt::format("odometry counts the wrong direction in {} steps between scans, {:.1f} m, "
                      "first at {:.3f} s",
                      steps.size(), distance_m, to_seconds(steps.front().after)),
          "let the encoders count the direction (both channels of each); waymark-import "
          "--fix-reversed-odometry turns it round in a log",
          distance_m};
}

std::vector<Check> check_mounting(const DoctorInput& input,
                                  const std::optional<HandEye>& calibration, RobotConfig& robot) {
  if (!calibration) return {no_motions("lidar_x"), no_motions("lidar_y"), no_motions("lidar_yaw")};
  const LidarConfig described = input.log.robot.lidar;
  std::vector<Check> checks;
  const auto add = [&](const char* name, std::string_view key, const Measured& measured,
                       double described_value, double deviation, DeviationLimits limits,
                       double unit, const char* unit_name, double& target) {
    if (!is_known(measured, limits)) {
      checks.push_back(no_motions(name));
      return;
    }
    const bool is_known_before = input.mounting != Mounting::kUnknown;
    const Verdict difference = verdict_of(deviation, measured.sigma, limits);
    const std::string_view axis = key.substr(0, key.find('_'));  // without unit: yaw is in deg here
    // Without a described mounting nothing is contradicted, but the default of 0 would be wrong.
    const Verdict verdict =
        is_known_before || difference == Verdict::kPass ? difference : Verdict::kWarn;
    if (is_worth_writing(verdict, deviation, measured.sigma, limits)) target = measured.value;
    checks.push_back(
        {name, verdict,
         fmt::format("the LiDAR's {} is {:.3f} +- {:.3f} {}, {}", axis, unit * measured.value,
                     unit * measured.sigma, unit_name,
                     is_known_before ? fmt::format("described is {:.3f}", unit * described_value)
                                     : "which nothing describes"),
         verdict == Verdict::kPass ? ""
                                   : fmt::format("robot.lidar.{} = {:.4f}", key, measured.value),
         unit * measured.value});
  };
  const HandEye& found = *calibration;
  add("lidar_x", "x_m", found.x_m, described.x_m, found.x_m.value - described.x_m, kPlace_m, 1.0,
      "m", robot.lidar.x_m);
  add("lidar_y", "y_m", found.y_m, described.y_m, found.y_m.value - described.y_m, kPlace_m, 1.0,
      "m", robot.lidar.y_m);
  add("lidar_yaw", "yaw_rad", found.yaw_rad, described.yaw_rad,
      angle_difference(found.yaw_rad.value, described.yaw_rad), kAngle_rad, degrees(1.0), "deg",
      robot.lidar.yaw_rad);
  return checks;
}

}  // namespace waymark
