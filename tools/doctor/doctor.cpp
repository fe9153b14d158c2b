// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/doctor.hpp"

#include "doctor/checks.hpp"
#include "doctor/motion/far_offset.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace waymark {
namespace {

// A measured odometry scale is used to check the camera if its sigma is below kGoodScaleSigma. Else
// the scale is 1 with kUnmeasuredScaleSigma, as for wheels whose description is unchecked.
constexpr double kGoodScaleSigma = 0.01;
constexpr double kUnmeasuredScaleSigma = 0.1;
constexpr double kOtherClock_s = 1.0;  // a driver's delay is shorter

/// The log with the LiDAR's measured mounting, and with mirrored scans corrected.
ImportedLog with_lidar(ImportedLog log, const LidarConfig& lidar, bool is_mirrored) {
  log.robot.lidar.x_m = lidar.x_m;
  log.robot.lidar.y_m = lidar.y_m;
  log.robot.lidar.yaw_rad = lidar.yaw_rad;
  for (ImportedScan& scan : log.scans)
    correct(scan, is_mirrored, Duration{0});
  return log;
}

/// Absolute value of the measured scale if it is accurate, else 1.
Measured best_scale(const Measured& measured) {
  if (measured.sigma < kGoodScaleSigma) return {std::abs(measured.value), measured.sigma};
  return {1.0, kUnmeasuredScaleSigma};
}

/// @param log  with the LiDAR's true mounting.
std::optional<CameraCalibration> calibrate(const DoctorInput& input, ImportedLog log,
                                           const std::optional<TurnComparison>& turns,
                                           const std::optional<HandEye>& hand_eye,
                                           Duration lidar_late) {
  if (!input.camera || !input.described) return std::nullopt;
  const Measured unmeasured{1.0, kUnmeasuredScaleSigma};
  const Measured distance = hand_eye ? best_scale(hand_eye->scale) : unmeasured;
  const Measured turn = turns ? best_scale(turns->ratio) : unmeasured;
  log.odometry = rescaled(log.odometry, distance.value, turn.value);
  return calibrate_camera(input.camera->sightings, input.described->camera,
                          input.described->markers, log, lidar_late, {distance.sigma, turn.sigma});
}

/// A delay of the camera's stamps of seconds, if there is one.
std::optional<double> camera_delay_s(const DoctorInput& input) {
  if (!input.camera || !input.described) return std::nullopt;
  // Both were put onto the LiDAR's clock by what was added to each.
  const Duration by_clocks = input.log.odometry_shift - input.log.images_shift;
  const bool has_own_clock = input.log.images_shift != Duration{0};
  if (has_own_clock && std::abs(to_seconds(by_clocks)) > kOtherClock_s)
    return to_seconds(by_clocks);
  return far_camera_late_s(input.camera->sightings, input.described->camera.base_from_camera(),
                           input.log.odometry);
}

}  // namespace

Diagnosis diagnose(const DoctorInput& input, const ShowProgress& progress) {
  Diagnosis diagnosis;
  diagnosis.robot = input.described.value_or(input.log.robot);
  std::vector<Check>& checks = diagnosis.checks;
  const LidarMotions motions = lidar_motions(input.log, progress);
  const auto turns = compare_turns(motions.turns, input.log.odometry);
  const bool is_mirrored = turns && turns->ratio.value < 0.0;
  const Duration late = turns ? duration_from_seconds(usable_lateness_s(*turns)) : Duration{0};
  const auto calibration = hand_eye(motions.motions, input.log.odometry, is_mirrored, late);

  checks.push_back(check_records(input));
  checks.push_back(check_lidar_drops(input));
  checks.push_back(check_odometry_drops(input));
  checks.push_back(check_traffic(input));
  checks.push_back(check_no_return(input, diagnosis.robot));
  checks.push_back(check_range_noise(input, diagnosis.robot));
  checks.push_back(check_scans_fit(input.log, motions));
  checks.push_back(check_odometry_moves(input.log));
  checks.push_back(check_mirror(turns, diagnosis.robot));
  checks.push_back(check_turn_scale(turns));
  checks.push_back(check_time_offset(input, turns, diagnosis.robot));
  const bool is_unrelated = turns && turns->are_contradictory();
  checks.push_back(is_unrelated ? unrelated_motions("odometry_distance_scale")
                                : check_distance_scale(calibration));
  std::vector<Check> mounting =
      is_unrelated ? std::vector{unrelated_motions("lidar_x"), unrelated_motions("lidar_y"),
                                 unrelated_motions("lidar_yaw")}
                   : check_mounting(input, calibration, diagnosis.robot);
  const ImportedLog placed = with_lidar(input.log, diagnosis.robot.lidar, is_mirrored);
  checks.push_back(is_unrelated ? unrelated_motions("backing_up") : check_backing_up(placed));
  std::ranges::move(mounting, std::back_inserter(checks));
  const auto camera = calibrate(input, placed, turns, calibration, late);
  const ClockFindings clocks{is_unrelated, camera_delay_s(input)};
  std::ranges::move(check_camera(input, camera, clocks, diagnosis.robot),
                    std::back_inserter(checks));
  return diagnosis;
}

}  // namespace waymark
