// SPDX-License-Identifier: BSD-3-Clause
// The slam process: sensors in, pose and map out.
#pragma once

#include "common/messages/channels.hpp"
#include "common/node/node.hpp"
#include "slam/command_desk.hpp"
#include "slam/core/estimators/estimator.hpp"
#include "slam/core/input/sensor_queue.hpp"
#include "slam/correction.hpp"
#include "slam/findings_text.hpp"
#include "slam/last_pose.hpp"
#include "slam/map_publisher.hpp"
#include "slam/period.hpp"
#include "slam/slam_config.hpp"
#include "slam/update_timer.hpp"

#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// Subscribes to LIDAR, ODOMETRY, MARKERS and SLAM_COMMAND, never to ground truth. Publishes
/// - SLAM_ESTIMATE for every observation and, once the pose is known, SLAM_POSE, SLAM_CORRECTION,
///   SLAM_PARTICLES and (with a scan) SLAM_SCAN;
/// - once per map period SLAM_MAP, SLAM_MARKERS, SLAM_FINDINGS (estimator waymark) and, with a
///   loaded map or a survey, SLAM_CHANGES;
/// - SLAM_REPLY for every SLAM_COMMAND, unless there are too many;
/// - at the end the whole map, SLAM_TRAJECTORY and MAP_GRAPH.
/// SLAM_GRID and the MBot's channels are used if [channels] names them.
class SlamNode final : public Node {
 public:
  using Config = SlamConfig;
  static constexpr ProcessTraits kTraits{
      .name = "slam",
      .purpose =
          "Estimates where the robot is and draws the map, from LIDAR, ODOMETRY and MARKERS.",
      .joins_midway = false};

  SlamNode(const SlamConfig& config, Inbox& inbox, Outbox& outbox);

  /// Reads map and survey as the process would, and writes nothing. @throws SetupError
  static void check(const Config& config);

  /// Processes the scans that still wait for camera frames; publishes the whole map and the final
  /// trajectory. Is called even after the estimator has thrown: then it does each of these as far
  /// as possible.
  void finish() override;

  /// True if the messages gave no pose or no map, the map could not be saved, or finish() was
  /// incomplete.
  bool failed() const override { return failed_; }

  std::vector<std::string_view> needed_channels() const override {
    return {channels::kLidar.name, channels::kOdometry.name};
  }

 private:
  /// Ids of the map files in whose frame the map is, of each kind the newest; 0: none. Any of them
  /// may be the one with which slam is started again.
  struct MapFileIds {
    std::int64_t loaded{0};
    std::int64_t saved{0};  ///< by --save-map
    std::int64_t named{0};  ///< by a command
  };

  std::int64_t save_map_to(const std::filesystem::path& file, const MapSnapshot& map);
  std::string_view why_no_map() const;
  bool save_map();
  void publish_end(Timestamp time);
  void attempt(std::string_view part, const std::function<void()>& work);
  std::string obey(const Command& command);
  std::string save_named(const std::string& name);
  std::string reset();
  std::string set_pose(const StartPose& pose);
  std::string set_mode(MapMode mode);
  void begin_estimator(MapMode mode, std::shared_ptr<const MapSnapshot> map,
                       const StartPose& start);
  void localise_anywhere();

  void resume_last_pose(const Observation& first);
  void keep_last_pose();
  void handle(LidarScan scan);
  void check_input();
  std::optional<std::vector<Finding>> findings() const;
  void process_ready_scans();
  void process(const SensorQueue::Ready& ready);
  void publish_map_when_due(Timestamp time);
  void save_map_when_due(Timestamp time);

  /// With map_id_ in each part.
  template <class Type>
  void publish(Channel<Type> channel, std::vector<Type> parts) {
    for (Type& part : parts) {
      part.map_id = map_id_;
      outbox_.publish(channel, part);
    }
  }

  void publish_markers(Timestamp time);
  void publish_findings(Timestamp time);
  void publish_grid(Timestamp time);
  void publish_mbot_status(Timestamp time);
  /// Request of an MBot's web app for a new map, or to localise anew in the loaded one.
  void obey(const mbot_slam_reset_t& reset);

  SlamConfig config_;
  Counters& counters_;
  Outbox& outbox_;
  SensorQueue queue_;
  std::string frame_{};  ///< name of the map's frame
  std::shared_ptr<const MapSnapshot> loaded_map_;
  const StartPose configured_start_;  ///< as resolved for the loaded map
  std::vector<SurveyedMarker> survey_;
  std::int64_t map_id_;  ///< id of the published map; 0: not begun
  MapFileIds map_file_ids_;
  std::unique_ptr<Estimator> estimator_;
  MapPublisher map_publisher_{};
  CorrectionMaker correction_{};
  CommandDesk command_desk_{};
  std::optional<Timestamp> last_estimate_time_{};  ///< newest estimate with a pose, in any map
  std::optional<Estimate> newest_estimate_{};      ///< newest one with a pose in this map
  std::optional<LastPose> known_pose_{};  ///< newest pose of good health, in this map's frame
  Se2 odom_from_base_{};                  ///< odometry at the newest observation, as it was sent
  Timestamp newest_{};                    ///< time of the newest observation
  std::set<int> named_survey_ids_{};
  LoadedMapFit refuted_{};   ///< of estimators in this map whose start was refuted
  bool was_resumed_{false};  ///< resume_last_pose() was called, successfully or not
  bool is_broken_{false};    ///< the estimator has thrown and gets no more scans
  Period map_period_;
  Period save_period_;
  UpdateTimer timer_{};
  bool failed_{false};
};

}  // namespace waymark
