// SPDX-License-Identifier: BSD-3-Clause
// A map that outlives its run: all that another run needs to know the place again.
#pragma once

#include "slam/core/graph/pose_graph.hpp"
#include "slam/core/graph/state.hpp"
#include "slam/core/grid/grid_map.hpp"
#include "slam/core/mapping/landmark_map.hpp"
#include "slam/core/registration/ndt_map.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <vector>

namespace waymark {

class Fields;

/// What a drive has shown about the robot's description.
struct LearntCalibration {
  Calibration mean{Calibration::Zero()};
  Eigen::Matrix<double, kCalibrationSize, kCalibrationSize> covariance{
      Eigen::Matrix<double, kCalibrationSize, kCalibrationSize>::Zero()};
};

struct MapSnapshot {
  std::int64_t map_id{0};         ///< of the content; 0 while it is not saved
  std::int64_t parent_map_id{0};  ///< of the map that it extends; 0: none
  Timestamp time{};               ///< of the newest observation in it
  GridMap grid{};
  std::vector<Landmark> landmarks{};
  NdtMap walls{0.25};
  PoseGraph graph{};
  LearntCalibration calibration{};
};

/// The walls of a map that is to be saved: without those that the grid shows to be free by now, and
/// of the others no more points than newer ones can outweigh.
NdtMap walls_to_save(const NdtMap& walls, const GridMap& grid, double point_variance_m2);

/// How well a place in a map is known: as well as the nearest marker; zero without markers.
Eigen::Matrix3d covariance_at(const MapSnapshot& map, const Eigen::Vector2d& place);

/// What a run does with a loaded map.
enum class MapMode {
  kMap,       ///< none is loaded: a new one is drawn
  kLocalise,  ///< it stays as it is; memory is constant
  kExtend,    ///< it stays where it is, and what is new is added in its frame
};

/// Where the robot is in a loaded map at first.
enum class StartKind {
  kOrigin,    ///< where mapping began, set down by hand
  kPose,      ///< at a given pose
  kLast,      ///< where it was when slam stopped, if map and odometry still fit; else unknown
  kAnywhere,  ///< unknown
};

struct StartPose {
  StartKind kind{StartKind::kOrigin};
  double x_m{0.0};
  double y_m{0.0};
  double yaw_rad{0.0};
  double sigma_m{0.1};
  double sigma_rad{0.05};
  bool is_certain{false};  ///< it was there a moment ago: markers or walls need not confirm it

  /// What they are, in words: core_fields.cpp.
  void describe(Fields& fields);
};

}  // namespace waymark
