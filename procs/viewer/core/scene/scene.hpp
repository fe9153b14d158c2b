// SPDX-License-Identifier: BSD-3-Clause
// The content of all messages so far: the input of pictures and files.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/health/health.hpp"
#include "common/sensors/sensors.hpp"
#include "common/time/time.hpp"
#include "viewer/core/scene/tiled_map.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark::viewer {

/// Largest rectangle of cells that a map may span: 200 m x 200 m in cells of 0.05 m. Keeps the
/// process far below 300 MB whatever the tiles claim.
constexpr std::int64_t kMaxMapCells = 16'000'000;

/// State of a marker in the map; values as in lcmtypes/marker_landmark_t.lcm.
enum class LandmarkState { kUnknown, kConfirmed, kTentative, kMoved };

/// "confirmed", ...
std::string_view name_of(LandmarkState state);

/// The degenerate direction of a scan: the one that the walls alone hardly observe, such as the
/// direction along a bare corridor.
struct WeakAxis {
  /// Unit vector; order x y theta (scaled by 1 m), map frame.
  Eigen::Vector3d direction{Eigen::Vector3d::Zero()};
  double information{0.0};  ///< information of one scan along `direction` [1/m^2]
  WeakAxisSource source{WeakAxisSource::kUnknown};  ///< what observes `direction` instead
};

/// Pose of the base in the frame of its path.
struct TimedPose {
  Timestamp time{};
  Se2 frame_from_base{};
};

struct EstimatedPose {
  Timestamp time{};
  Se2 map_from_base{};
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};  ///< order x y theta, map frame
  Health health{Health::kUnknown};
  std::optional<WeakAxis> weak_axis{};  ///< nullopt: the scan observes all directions
};

struct Landmark {
  int id{kNoMarker};
  int instance{0};
  Se2 map_from_marker{};  ///< heading = direction that the marker faces
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};  ///< order x y yaw, map frame
  int sightings{0};
  Timestamp last_seen{};
  LandmarkState state{LandmarkState::kUnknown};
};

/// A difference from the loaded map or the survey; values as in lcmtypes/map_change_t.lcm.
struct MapChange {
  enum class Kind { kNone, kMoved, kMissing, kNew, kWallNew, kWallGone, kSurveyOff };

  Kind kind{Kind::kNone};
  int id{kNoMarker};
  int instance{0};
  Se2 place{};                                      ///< now; of what is gone: where it was
  Eigen::Vector2d was_at{Eigen::Vector2d::Zero()};  ///< in the loaded map or the survey
  double size_m{0.0};                               ///< longer side of the box around a wall
  double sigmas{0.0};  ///< distance from the survey in standard deviations; only for kSurveyOff
  int support{0};      ///< sightings, or misses, that show the change; of a wall: number of cells
};

/// A deviation of a sensor from its description, or data that slam did not use.
struct Finding {
  std::string name{};
  std::string text{};
  double value{0.0};              ///< unit as in the name; a count if there is a share
  std::optional<double> share{};  ///< affected observations or scans / all of them
};

/// A scan whose beams carry the ids of the markers that they hit.
struct AnnotatedScan {
  Timestamp time{};
  Se2 map_from_lidar{};
  std::vector<double> ranges_m{};    ///< +inf = no return, NaN = invalid
  std::vector<double> angles_rad{};  ///< counter-clockwise, LiDAR frame
  std::vector<int> marker_ids{};     ///< kNoMarker = none

  bool has_marker() const;
};

/// Paths are in order of time, without repeats.
struct Scene {
  std::string title{};  ///< heading of map.png: viewer.title, else the output folder's name
  TiledMap map{kMaxMapCells};
  std::vector<Landmark> landmarks{};
  std::optional<std::vector<MapChange>> changes{};  ///< nullopt: slam has sent no comparison
  std::optional<std::vector<Finding>> findings{};   ///< nullopt: slam has not reported any
  std::vector<EstimatedPose> estimates{};
  std::vector<TimedPose> final_trajectory{};  ///< as corrected by the end of the run
  std::vector<TimedPose> odometry{};          ///< odom_from_base
  std::vector<TimedPose> truth{};             ///< world_from_base; empty on a real robot
  std::vector<Se2> particles{};               ///< map_from_base of each
  std::optional<AnnotatedScan> scan{};
};

}  // namespace waymark::viewer
