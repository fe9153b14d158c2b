// SPDX-License-Identifier: BSD-3-Clause
// A drive through a building, as a CARMEN log.
#pragma once

#include "drawn_drive/robot.hpp"

#include <fmt/os.h>

#include <string>
#include <vector>

namespace waymark::drawn {

struct DriveOptions {
  std::string kind{"office"};  ///< of building
  double length_m{400.0};
  double speed_mps{0.5};
  double period_s{0.25};  ///< of scans
  double range_m{30.0};
  double range_sigma_m{0.015};
  double odometry_noise{1.0};  ///< times that of a good robot
  int beams{181};
  double view_deg{180.0};  ///< angle between the first and the last beam
  int people{0};
};

struct TruePose {
  double time_s{0.0};
  Se2 pose{};
};

/// Of odometry and a LiDAR, among people who walk about the robot. Plane geometry, no physics.
class Drive {
 public:
  Drive(const DriveOptions& options, Random& random);

  /// @return the robot's pose at each scan.
  std::vector<TruePose> write(fmt::ostream& log);

 private:
  Eigen::Vector2d goal(const std::vector<TruePose>& truth);
  void walk(Eigen::Vector2d& person);
  void write_scan(fmt::ostream& log, double time_s);

  const DriveOptions& options_;
  Random& random_;
  Building building_;
  Routes routes_;
  Robot robot_;
  Odometry odometry_;
  std::vector<Eigen::Vector2d> people_{};
};

}  // namespace waymark::drawn
