// SPDX-License-Identifier: BSD-3-Clause
// Ground truth files for the evaluation; no other process reads them.
#pragma once

#include "sim/core/simulation.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace waymark {

/// `id,instance,x_m,y_m,yaw_rad` of every marker, world frame; yaw = direction that it faces.
std::string truth_markers_csv(const World& world);

/// `t_s,id,instance,x_m,y_m,yaw_rad`: new places of moved markers, in order of time. Their first
/// places are in truth_markers.csv.
std::string truth_marker_moves_csv(const std::vector<MovedMarker>& moves);

/// truth.tum: `t x y z qx qy qz qw` of the base in the world frame, growing during the run.
class TruthTrajectory {
 public:
  /// @throws SetupError when the file cannot be created.
  explicit TruthTrajectory(const std::filesystem::path& path);
  void add(const TruePose& pose);
  /// Renames the temporary file to its final name.
  /// @throws std::runtime_error naming it when the disk is full.
  void finish();

 private:
  std::filesystem::path path_;
  std::filesystem::path unfinished_path_;
  std::ofstream stream_;
};

}  // namespace waymark
