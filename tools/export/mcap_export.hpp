// SPDX-License-Identifier: BSD-3-Clause
// A run as an MCAP file for Foxglove.
#pragma once

#include "common/node/node.hpp"
#include "export/foxglove.hpp"
#include "export/mcap_writer.hpp"
#include "export/pose_pairing.hpp"
#include "viewer/core/scene/current_map.hpp"
#include "viewer/core/scene/scene.hpp"
#include "viewer/scene_updater.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>

namespace waymark::exporting {

/// Topics: /map, /scan, /pose, /pose_ellipse, /tf (world -> map -> odom -> base; world only where
/// there is a truth), /markers, /camera, /truth. When slam begins another map, the markers are
/// deleted, the next grid is written at once, and the world is aligned anew.
class McapExport final : public Node {
 public:
  /// @throws SetupError when the file cannot be created.
  McapExport(const std::filesystem::path& out, Inbox& inbox);

  void finish() override;

  bool failed() const override { return failed_; }

 private:
  void add(const annotated_scan_t& message);
  void add(const image_t& message);
  void add(const map_tiles_t& message);
  void add(const marker_map_t& message);
  void add(const slam_estimate_t& message);
  void add_odometry(const pose2D_t& message);
  void add_truth(const pose2D_t& message);
  /// Switches to that map when it is new, after a restart or a reset of slam.
  /// @return false for a late message of an earlier map.
  bool follow(std::int64_t map_id, Timestamp time);
  void begin_map(Timestamp time);
  /// Writes the transforms that have become known.
  void write_odometry();
  void write_truth();
  void count_losses();
  void write_map(Timestamp time);
  void write_transform(Timestamp time, const Json& transform);
  void write_pose(McapWriter::ChannelId channel, Timestamp time, const char* frame,
                  const Se2& pose);
  void write(McapWriter::ChannelId channel, Timestamp time, const Json& message);

  std::optional<McapWriter> writer_{};
  std::filesystem::path file_;
  Counters& counters_;
  viewer::Scene scene_{};
  viewer::SceneUpdater updater_;
  McapWriter::ChannelId map_{}, scan_{}, pose_{}, ellipse_{}, tf_{}, markers_{}, camera_{},
      truth_{};
  PosePairing odometry_{};
  PosePairing true_poses_{};
  viewer::CurrentMap current_map_{};
  std::optional<Timestamp> last_map_{};
  bool map_has_changed_{false};
  Timestamp newest_{};
  bool has_world_{false};
  bool failed_{false};
};

}  // namespace waymark::exporting
