// SPDX-License-Identifier: BSD-3-Clause
// A map to be saved: everything that another run needs to localise in it.
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

/// Estimate of the calibration at the end of a drive.
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

/// The walls to save: without cells that are free in the grid by now, and with so few points per
/// cell that later observations can outweigh them.
NdtMap walls_to_save(const NdtMap& walls, const GridMap& grid, double point_variance_m2);

/// Covariance of a map at a place: that of the nearest marker, map's axes; zero without markers.
Eigen::Matrix3d covariance_at(const MapSnapshot& map, const Eigen::Vector2d& place);

}  // namespace waymark
