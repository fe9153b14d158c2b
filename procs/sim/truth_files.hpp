// SPDX-License-Identifier: BSD-3-Clause
// What the simulator knows and leaves for the evaluation: no other process gets it.
#pragma once

#include "sim/core/simulation.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace waymark {

/// `id,instance,x_m,y_m,yaw_rad` of every marker, world frame; yaw = direction that it faces.
std::string truth_markers_csv(const World& world);

/// `t_s,id,instance,x_m,y_m,yaw_rad`: where markers have hung since they were moved, in order of
/// time; before, and all others, see truth_markers.csv.
std::string truth_marker_moves_csv(const std::vector<MovedMarker>& moves);

/// truth.tum: `t x y z qx qy qz qw` of the base in the world frame, growing during the run.
class TruthTrajectory {
 public:
  /// @throws SetupError when the file cannot be created.
  explicit TruthTrajectory(const std::filesystem::path& path);
  void add(const TruePose& pose);
  /// Puts the file in place. @throws std::runtime_error naming it when the disk is full.
  void finish();

 private:
  std::filesystem::path path_;
  std::filesystem::path unfinished_path_;
  std::ofstream stream_;
};

}  // namespace waymark
