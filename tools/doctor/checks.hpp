// SPDX-License-Identifier: BSD-3-Clause
// The checks. Those with a parameter `robot` write corrections into it, some of them even when the
// check passes: see is_worth_writing().
#pragma once

#include "doctor/camera/camera_calibration.hpp"
#include "doctor/check.hpp"
#include "doctor/doctor_input.hpp"
#include "doctor/motion/hand_eye.hpp"

#include <optional>
#include <vector>

namespace waymark {

// The records of the log.
Check check_records(const DoctorInput& input);
Check check_lidar_drops(const DoctorInput& input);
Check check_odometry_drops(const DoctorInput& input);
Check check_traffic(const DoctorInput& input);

// The LiDAR alone.
Check check_no_return(const DoctorInput& input, RobotConfig& robot);
Check check_range_noise(const DoctorInput& input, RobotConfig& robot);
Check check_scans_fit(const ImportedLog& log, const LidarMotions& motions);

// Odometry against the LiDAR.
Check check_odometry_moves(const ImportedLog& log);
Check check_mirror(const std::optional<TurnComparison>& turns, RobotConfig& robot);
Check check_turn_scale(const std::optional<TurnComparison>& turns);
Check check_time_offset(const DoctorInput& input, const std::optional<TurnComparison>& turns,
                        RobotConfig& robot);
/// For each check that compares motions of LiDAR and odometry, where their turns are contradictory.
Check unrelated_motions(std::string name);
Check check_distance_scale(const std::optional<HandEye>& calibration);
Check check_backing_up(const ImportedLog& log);
/// One check each for x, y and yaw of the LiDAR.
std::vector<Check> check_mounting(const DoctorInput& input,
                                  const std::optional<HandEye>& calibration, RobotConfig& robot);

/// "3.0 s later than those of ODOMETRY", with the log's name of odometry.
std::string later_than_odometry(double late_s, const DoctorInput& input);

/// What the clocks of the sensors rule out in the calibration of the camera.
struct ClockFindings {
  bool lidar_is_unrelated{false};         ///< the LiDAR's turns and odometry's are contradictory
  std::optional<double> camera_late_s{};  ///< a delay of seconds, relative to odometry
};

/// All checks of camera and markers; a single unchecked one when the log has neither.
std::vector<Check> check_camera(const DoctorInput& input,
                                const std::optional<CameraCalibration>& calibration,
                                const ClockFindings& clocks, RobotConfig& robot);
/// @pre the log has a camera.
Check check_camera_drops(const DoctorInput& input);

/// The LiDAR's time offset if it is known well enough, else 0 [s].
double usable_lateness_s(const TurnComparison& turns);

}  // namespace waymark
