// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/doctor.hpp"

#include "doctor/checks.hpp"

namespace waymark {
namespace {

/// Direction of driving is judged with the LiDAR where it is, not where it is said to be.
ImportedLog with_mounting(ImportedLog log, const std::optional<HandEye>& calibration) {
  if (!calibration) return log;
  log.robot.lidar.x_m = calibration->x_m.value;
  log.robot.lidar.y_m = calibration->y_m.value;
  log.robot.lidar.yaw_rad = calibration->yaw_rad.value;
  return log;
}

}  // namespace

Diagnosis diagnose(const Patient& patient) {
  Diagnosis diagnosis;
  diagnosis.robot = patient.described.value_or(patient.log.robot);
  std::vector<Check>& checks = diagnosis.checks;
  const LidarMotions motions = lidar_motions(patient.log);
  const auto turns = compare_turns(motions.turns, patient.log.odometry);
  const bool is_mirrored = turns && turns->ratio.value < 0.0;
  const Duration late = turns ? duration_from_seconds(usable_lateness_s(*turns)) : Duration{0};
  const auto calibration = hand_eye(motions.motions, patient.log.odometry, is_mirrored, late);

  checks.push_back(check_records(patient));
  checks.push_back(check_lidar_drops(patient.log));
  checks.push_back(check_odometry_drops(patient.log));
  checks.push_back(check_traffic(patient));
  checks.push_back(check_no_return(patient, diagnosis.robot));
  checks.push_back(check_range_noise(patient, diagnosis.robot));
  checks.push_back(check_scans_fit(patient.log, motions));
  checks.push_back(check_odometry_moves(patient.log));
  checks.push_back(check_mirror(turns));
  checks.push_back(check_turn_scale(turns));
  checks.push_back(check_time_offset(turns));
  checks.push_back(check_distance_scale(calibration));
  checks.push_back(check_backing_up(with_mounting(patient.log, calibration)));
  for (Check& check : check_mounting(patient, calibration, diagnosis.robot))
    checks.push_back(std::move(check));
  return diagnosis;
}

}  // namespace waymark
