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

/// `t_s,id,instance,x_m,y_m,yaw_rad`: new places of moved markers, in order of time. The places
/// at the start of the run are in truth_markers.csv.
std::string truth_marker_moves_csv(const std::vector<MovedMarker>& moves);

/// Writes truth.tum: `t x y z qx qy qz qw` of the base in the world frame. During the run the file
/// is named truth.tum.unfinished.
class TruthTrajectory {
 public:
  /// @throws SetupError when the file cannot be created.
  explicit TruthTrajectory(const std::filesystem::path& path);
  void add(const TruePose& pose);
  /// Renames the file to truth.tum.
  /// @throws std::runtime_error naming the file when it cannot be written or renamed.
  void finish();

 private:
  std::filesystem::path path_;
  std::filesystem::path unfinished_path_;
  std::ofstream stream_;
};

}  // namespace waymark
