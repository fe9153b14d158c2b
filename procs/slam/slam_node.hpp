// SPDX-License-Identifier: BSD-3-Clause
// The slam process: sensors in, pose and map out.
#pragma once

#include "common/messages/channels.hpp"
#include "common/node/node.hpp"
#include "slam/core/estimators/estimator.hpp"
#include "slam/core/input/sensor_queue.hpp"
#include "slam/map_publisher.hpp"
#include "slam/slam_config.hpp"
#include "slam/update_timer.hpp"

#include <memory>
#include <optional>

namespace waymark {

/// Hears LIDAR, ODOMETRY and MARKERS, never the truth. Answers every scan with SLAM_SCAN,
/// SLAM_POSE, SLAM_ESTIMATE and SLAM_PARTICLES, and once per map period with SLAM_MAP and
/// SLAM_MARKERS.
class SlamNode final : public Node {
 public:
  using Config = SlamConfig;
  static constexpr ProcessTraits kTraits{
      .name = "slam",
      .purpose =
          "Estimates where the robot is and draws the map, from LIDAR, ODOMETRY and MARKERS.",
      .joins_midway = false};

  SlamNode(const SlamConfig& config, Inbox& inbox, Outbox& outbox);

  /// Uses the scans that still wait for camera frames; sends the whole map, and on SLAM_TRAJECTORY
  /// the way there as it is known at the end.
  void finish() override;

  /// True when sensors were heard, but no pose or no map could be made of them.
  bool failed() const override { return failed_; }

 private:
  void save_map();
  void take(LidarScan scan);
  void judge_input();
  void say_findings();
  void count_findings();
  std::int64_t repeated_scans() const;
  void process_ready_scans();
  void process(const SensorQueue::Ready& ready);
  void publish_map_when_due(Timestamp time);
  void publish_markers(Timestamp time);
  void publish_grid(Timestamp time);
  void publish_mbot_status(Timestamp time);
  /// An MBot's web app wants a new map, or to be found anew in the loaded one.
  void obey(const mbot_slam_reset_t& reset);
  /// Forgets everything but the loaded map.
  void begin_anew();

  SlamConfig config_;
  Counters& counters_;
  Outbox& outbox_;
  SensorQueue queue_;
  std::shared_ptr<const MapSnapshot> loaded_map_;
  std::int64_t map_id_;  ///< 0: of no file
  std::unique_ptr<Estimator> estimator_;
  MapPublisher map_publisher_{};
  std::optional<Timestamp> last_estimate_{};
  std::optional<Timestamp> next_map_{};
  UpdateTimer timer_{};
  bool failed_{false};
};

}  // namespace waymark
