// SPDX-License-Identifier: BSD-3-Clause
// The content of the live page at one time. A posted view is immutable, so that any thread can read
// it.
#pragma once

#include "viewer/core/scene/scene.hpp"

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace waymark::viewer {

struct LiveTile {
  int x{0};
  int y{0};
  std::uint32_t version{0};  ///< LiveMap::version at the tile's last change
  /// 0..100, -1 = unknown; row by row from the lower left.
  std::vector<std::int8_t> occupancy_percent{};
};

/// Unchanged tiles are shared between views.
struct LiveMap {
  TileLayout layout{};
  std::uint32_t generation{0};  ///< number of the map; a new one invalidates all tiles
  std::uint32_t version{0};     ///< version of the newest tile
  std::vector<std::shared_ptr<const LiveTile>> tiles{};
};

struct CameraFrame {
  Timestamp time{};
  std::string jpeg{};
};

/// A marker in the camera's image; corners [px], clockwise from the marker's top left.
struct SeenMarker {
  int id{0};
  std::array<std::array<double, 2>, 4> corners_px{};
};

struct SeenMarkers {
  Timestamp time{};
  int image_width{0};
  int image_height{0};
  std::vector<SeenMarker> markers{};
};

struct ProcessState {
  std::string name{};
  std::string state{};
  std::vector<std::pair<std::string, std::int64_t>>
      losses{};  ///< counts of lost or rejected messages
};

/// For how long channels have been silent [s], by the wall clock; nullopt: never heard. All are
/// nullopt where time is the messages' own, in lockstep and in replays.
struct Silences {
  std::optional<double> slam_s{};      ///< all of slam
  std::optional<double> estimate_s{};  ///< its estimates
  std::optional<double> lidar_s{};
  std::optional<double> odometry_s{};
};

using PathPoint = std::array<float, 2>;  ///< (x, y) [m], map frame

struct LiveView {
  std::uint64_t number{0};  ///< number of the view in its run
  Timestamp time{};         ///< stamp of the newest message
  std::string title{};
  std::optional<EstimatedPose> estimate{};
  bool is_unplaced{false};  ///< slam runs, but has not found the robot in its map
  std::shared_ptr<const LiveMap> map{std::make_shared<LiveMap>()};
  std::vector<Landmark> markers{};
  std::vector<Finding> findings{};  ///< about the sensors, from slam
  std::vector<Se2> particles{};
  std::vector<PathPoint> scan{};  ///< ends of the beams, map frame
  std::shared_ptr<const CameraFrame> camera{};
  std::optional<SeenMarkers> seen_markers{};
  std::optional<Timestamp> last_camera{};  ///< last frame or detections, with markers or without
  std::optional<Timestamp> last_marker{};  ///< last estimate with a marker sighting
  std::vector<ProcessState> processes{};
  Silences silences{};
  std::size_t path_begin{0};   ///< index of the first path point in the present map
  std::size_t path_length{0};  ///< number of points of ViewStore::path() up to this view
};

}  // namespace waymark::viewer
