// SPDX-License-Identifier: BSD-3-Clause
// The interface that all SLAM methods implement.
#pragma once

#include "slam/core/estimators/estimate.hpp"
#include "slam/core/estimators/map_use.hpp"
#include "slam/core/estimators/parallel_for.hpp"
#include "slam/core/estimators/scan_trajectory.hpp"
#include "slam/core/estimators/sensor_statistics.hpp"
#include "slam/core/estimators/update_gate.hpp"
#include "slam/core/grid/grid_map.hpp"
#include "slam/core/landmark/sighting_noise.hpp"
#include "slam/core/landmark/surveyed_marker.hpp"
#include "slam/core/localisation/map_snapshot.hpp"
#include "slam/core/mapping/landmark_map.hpp"
#include "slam/core/mapping/map_change.hpp"
#include "slam/core/mapping/mapper.hpp"
#include "slam/core/motion/motion_model.hpp"
#include "slam/core/scan/observation.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

namespace waymark {

/// Largest distance [m] of a commanded pose from the previous pose or, before the first one, from
/// the map: nearly half of the side of the largest grid (TileMap::kMaxTableTiles).
inline double farthest_pose_m(double resolution_m) {
  constexpr double kFarthest_cells = 30'000.0;
  return kFarthest_cells * resolution_m;
}

/// Inputs of all methods.
struct EstimatorSetup {
  MapperConfig grid{};
  MotionNoise motion{};
  UpdateGate gate{};
  double range_sigma_m{0.01};  ///< of the LiDAR
  double half_track_m{0.14};   ///< half of the distance between the wheels
  CameraView camera{};
  SightingNoise sighting_noise{};
  double range_max_m{3.5};  ///< of the LiDAR
  std::uint64_t seed{1};
  ParallelFor parallel_for{serial_for};
  std::shared_ptr<const MapSnapshot> loaded_map{};  ///< null: none
  MapMode map_mode{MapMode::kMap};
  StartPose start{};
  std::vector<SurveyedMarker> survey{};  ///< none: the first pose is the map's origin
};

/// A particle, for visualisation.
struct PublishedParticle {
  Se2 map_from_base{};
  Se2 previous_map_from_base{};  ///< pose of its parent at the previous update
  double weight{0.0};            ///< normalised
};

/// A SLAM method. The map frame is the base's pose at the first observation, unless a loaded map or
/// a survey defines it.
class Estimator {
 public:
  virtual ~Estimator() = default;

  /// Processes the next scan. The method decides whether to update its filter and map with it or
  /// only to follow odometry; it always returns the robot's pose.
  virtual Estimate update(const Observation& observation) = 0;

  /// The map so far. Copies are cheap, and tiles that did not change keep their address.
  virtual const GridMap& map() const = 0;
  virtual std::vector<Landmark> landmarks() const = 0;

  /// Only of particle filters, and dead reckoning as one particle.
  virtual std::vector<PublishedParticle> particles() const { return {}; }

  /// The smoothed trajectory, one pose per scan, in the frame of map(). Empty when the method is a
  /// filter that never corrects past poses. O(scans).
  virtual std::vector<TimedPose> trajectory() const { return {}; }

  /// The map redrawn along trajectory(). O(scans).
  virtual GridMap redrawn_map() const { return map(); }

  /// Keyframes of redrawn_map() and the constraints between them; only of graph methods.
  virtual std::optional<PoseGraph> pose_graph() const { return std::nullopt; }

  /// Differences from the loaded map and the survey; only of methods that detect them.
  virtual std::vector<MapChange> changes() const { return {}; }

  /// Sets the robot's pose for the next update.
  /// @return false: the method does not support it, has no map yet, or the pose is more than
  ///         farthest_pose_m() from the present one (before the first one: from the map).
  virtual bool set_pose(const StartPose& /*pose*/) { return false; }

  /// What was learnt about the sensors, and counts; only of methods that learn.
  virtual std::optional<SensorStatistics> statistics() const { return std::nullopt; }

  /// Everything that another run needs to continue in this map; only of methods that support it.
  /// O(scans).
  virtual std::optional<MapSnapshot> snapshot() const { return std::nullopt; }
};

}  // namespace waymark
