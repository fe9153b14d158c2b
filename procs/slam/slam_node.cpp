// SPDX-License-Identifier: BSD-3-Clause
#include "slam/slam_node.hpp"

#include "common/files/writable_folder.hpp"
#include "common/logging/logging.hpp"
#include "common/messages/convert.hpp"
#include "common/robot/described_sensors.hpp"
#include "slam/estimator_factory.hpp"
#include "slam/map_file.hpp"
#include "slam/skip_counts.hpp"
#include "slam/slam_inputs.hpp"
#include "slam/slam_messages.hpp"

#include <string_view>
#include <utility>

namespace waymark {
namespace {

constexpr std::string_view kScansProcessed = "scans processed";
constexpr std::string_view kEstimatesWithoutPose = "estimates before the pose in the map was known";

std::int32_t mbot_mode(MapMode mode) {
  if (mode == MapMode::kLocalise) return slam_status_t::MODE_LOCALISATION_ONLY;
  return slam_status_t::MODE_FULL;
}

}  // namespace

SlamNode::SlamNode(const SlamConfig& config, Inbox& inbox, Outbox& outbox)
    : config_{config},
      counters_{inbox.counters()},
      outbox_{outbox},
      queue_{sensor_setup(config)},
      loaded_map_{load_map(config_, frame_)},
      configured_start_{config_.slam.start},
      survey_{load_survey(config_)},
      map_id_{loaded_map_ && config_.slam.mode == MapMode::kLocalise ? loaded_map_->map_id : 0},
      map_file_ids_{.loaded = loaded_map_ ? loaded_map_->map_id : 0},
      estimator_{make_estimator(config_, loaded_map_, survey_)},
      map_period_{config.slam.map_period_s, Period::First::kAtOnce},
      save_period_{config.slam.save_map_every_s, Period::First::kAfterAPeriod} {
  if (!config.slam.state_folder.empty()) make_writable_folder(config.slam.state_folder);
  inbox.on<planar_lidar_t>(channels::kLidar, [this](const auto& m) { handle(to_scan(m)); });
  inbox.on<lidar_t>(channels::kMbotLidar, [this](const auto& m) { handle(to_scan(m)); });
  inbox.on<pose2D_t>(channels::kOdometry, [this](const auto& m) {
    queue_.add(to_odometry(m));
    process_ready_scans();
  });
  inbox.on<marker_detections_t>(channels::kMarkers, [this](const auto& m) {
    queue_.add(as_described(to_detections(m), config_.robot.camera));
    process_ready_scans();
  });
  if (config.channels.uses(channels::kMbotSystemReset.name)) {
    inbox.on<mbot_slam_reset_t>(channels::kMbotSystemReset, [this](const auto& m) { obey(m); });
  }
  inbox.on<command_t>(channels::kSlamCommand, [this](const auto& m) {
    const auto reply =
        command_desk_.handle(m, newest_, [this](const Command& command) { return obey(command); });
    if (reply)
      outbox_.publish(channels::kSlamReply, *reply);
    else
      counters_.add("SLAM_COMMAND dropped: too many", CountKind::kLoss);
  });
}

void SlamNode::check(const Config& config) {
  if (!config.slam.state_folder.empty()) check_writable_folder(config.slam.state_folder);
  Config read = config;
  std::string frame;
  const auto map = load_map(read, frame);
  make_estimator(read, map, load_survey(read));
}

void SlamNode::finish() {
  attempt("the last scans", [this] {
    queue_.finish();
    process_ready_scans();
  });
  check_input();
  if (!config_.save_map.empty()) attempt("the map to save", [this] { failed_ |= !save_map(); });
  keep_last_pose();
  if (last_estimate_time_) publish_end(*last_estimate_time_);
}

void SlamNode::publish_end(Timestamp time) {
  attempt("the map", [&] {
    publish(channels::kSlamMap, map_publisher_.all_tiles(estimator_->redrawn_map(), time));
    publish_markers(time);
    publish_grid(time);
  });
  attempt("the trajectory",
          [&] { publish(channels::kSlamTrajectory, to_messages(estimator_->trajectory())); });
  attempt("the graph", [&] {
    const auto graph = estimator_->pose_graph();
    if (!graph) return;
    for (const pose_graph_t& part : to_messages(*graph, time))
      outbox_.publish(channels::kMapGraph, part);
  });
  publish_findings(time);
  if (const auto found = findings()) logging::info("found: {}", sentence_of(*found));
  logging::info("{}", timer_.summary());
}

/// Runs one part of finish(); an exception in it is logged and does not prevent the others.
void SlamNode::attempt(std::string_view part, const std::function<void()>& work) {
  try {
    work();
  } catch (const std::exception& error) {
    failed_ = true;
    logging::error("{}: {}", part, error.what());
  }
}

std::optional<std::vector<Finding>> SlamNode::findings() const {
  std::optional<SensorStatistics> found = estimator_->statistics();
  if (!found) return std::nullopt;
  found->loaded_map += refuted_;
  return reportable_findings(*found, counters_.get(count_of(Skip::kScanRepeated).name));
}

/// Publishes the findings; shares of unused data are also counted, for the status.
void SlamNode::publish_findings(Timestamp time) {
  const auto found = findings();
  if (!found) return;
  outbox_.publish(channels::kSlamFindings, to_message(*found, time, map_id_));
  for (const Finding& finding : *found) {
    if (!finding.share) continue;
    const auto count = static_cast<std::int64_t>(finding.value);
    std::string name = finding.name;
    std::ranges::replace(name, '_', ' ');
    counters_.add(name, CountKind::kEvent, count - counters_.get(name));
  }
}

std::string_view SlamNode::why_no_map() const {
  if (loaded_map_)
    return "neither markers nor walls confirmed the pose in the loaded map, or most of them "
           "contradict it";
  if (!survey_.empty() && !newest_estimate_) return "the survey's frame is not known yet";
  return "no scan was processed yet, or the estimator cannot save maps";
}

/// @return whether it was saved; if not, the reason is logged.
bool SlamNode::save_map() {
  const auto map = estimator_->snapshot();
  if (!map) {
    logging::error("no map to save: {}", why_no_map());
    return false;
  }
  try {
    if (config_.keeps_old_map) {
      const auto name = move_aside(config_.save_map);
      logging::warn("the map that was in '{}' is in '{}'", config_.save_map.string(),
                    name.string());
      config_.keeps_old_map = false;
    }
    map_file_ids_.saved = save_map_to(config_.save_map, *map);
  } catch (const std::exception& error) {
    logging::error("{}", error.what());
    return false;
  }
  return true;
}

/// Reports inputs from which no pose or map could be computed as a failure.
void SlamNode::check_input() {
  const std::int64_t scans = counters_.get(received_on(channels::kLidar.name));
  const std::int64_t odometry = counters_.get(received_on(channels::kOdometry.name));
  const std::int64_t without_pose = counters_.get(kEstimatesWithoutPose);
  if (!last_estimate_time_ && without_pose > 0 && loaded_map_ == nullptr) {
    failed_ = true;
    logging::error(
        "no pose: in {} estimates the survey's frame was never known; that takes two surveyed "
        "markers, or one with yaw, each sighted three times",
        without_pose);
  } else if (loaded_map_ != nullptr && without_pose > 0 &&
             (!last_estimate_time_ || (refuted_.scans > 0 && !newest_estimate_))) {
    failed_ = true;
    logging::error(
        "no pose: in {} estimates the robot's pose in '{}' was never certain; more than one place, "
        "or none, fits the observations",
        without_pose, config_.load_map.string());
  } else if (!last_estimate_time_ && scans + odometry > 0) {
    failed_ = true;
    logging::error(
        "no pose: of LIDAR {} and of ODOMETRY {} messages could be read; both are needed", scans,
        odometry);
  }
  const std::int64_t processed = counters_.get(kScansProcessed);
  if (processed > 0 && counters_.get(count_of(Skip::kScanWithoutReturns).name) >= processed) {
    failed_ = true;
    logging::error(
        "no map: no scan has a range from {} to {} m; are they in metres, and is [robot.lidar] "
        "that of this robot?",
        config_.robot.lidar.range_min_m, config_.robot.lidar.range_max_m);
  }
}

void SlamNode::handle(LidarScan scan) {
  if (std::ssize(scan.ranges_m) != config_.robot.lidar.num_beams)
    counters_.add("scans with another number of beams than configured");
  queue_.add(as_described(std::move(scan), config_.robot.lidar));
  process_ready_scans();
}

void SlamNode::process_ready_scans() {
  while (!is_broken_) {
    const auto ready = queue_.next();
    if (!ready) break;
    is_broken_ = true;  // unless process() returns
    process(*ready);
    is_broken_ = false;
  }
  for (const Skip skip : queue_.take_skips()) {
    const SkipCount count = count_of(skip);
    counters_.add(count.name, count.kind);
  }
}

void SlamNode::process(const SensorQueue::Ready& ready) {
  newest_ = ready.observation.time;
  odom_from_base_ = ready.observation.odom_from_base;
  if (map_id_ == 0) map_id_ = new_map_id(newest_, map_file_ids_.loaded);
  if (!was_resumed_) resume_last_pose(ready.observation);
  timer_.start();
  const Estimate estimate = estimator_->update(ready.observation);
  timer_.stop(estimate.updated);
  const Timestamp time = estimate.time;
  counters_.add(ready.scan ? kScansProcessed : "estimates while the LiDAR was silent");
  slam_estimate_t message = to_message(estimate);
  message.map_id = map_id_;
  publish_mbot_status(time);
  if (!estimate.has_pose) {
    counters_.add(kEstimatesWithoutPose);
    outbox_.publish(channels::kSlamEstimate, message);
    if (loaded_map_) publish_map_when_due(time);  // so that a user can command a pose in it
    return;
  }
  const Se2 map_from_lidar = estimate.map_from_base * config_.robot.lidar.base_from_lidar();
  last_estimate_time_ = time;
  newest_estimate_ = estimate;
  if (estimate.odometry_refused) counters_.add("steps of the odometry that were rejected");
  if (estimate.calibration_widened) counters_.add("calibration found worse than configured");
  if (ready.scan && estimate.ranges_wrong) counters_.add("scans with wrong ranges");
  if (ready.scan)
    outbox_.publish(channels::kSlamScan,
                    to_message(*ready.scan, ready.observation, map_from_lidar));
  outbox_.publish(channels::kSlamPose, to_pose_message(time, estimate.map_from_base));
  outbox_.publish(channels::kSlamEstimate, message);
  outbox_.publish(channels::kSlamCorrection, correction_.make(estimate, odom_from_base_, map_id_));
  outbox_.publish(channels::kSlamParticles, to_message(estimator_->particles(), time));
  publish_map_when_due(time);
  if (estimate.start_refuted) localise_anywhere();
}

void SlamNode::publish_map_when_due(Timestamp time) {
  if (!map_period_.is_due(time)) return;
  publish(channels::kSlamMap, map_publisher_.changed_tiles(estimator_->map(), time));
  publish_markers(time);
  publish_grid(time);
  publish_findings(time);
  save_map_when_due(time);
  keep_last_pose();
}

/// A failure to save is only counted here: a later save may succeed. At the end it is a failure.
void SlamNode::save_map_when_due(Timestamp time) {
  if (config_.slam.save_map_every_s <= 0.0 || !save_period_.is_due(time)) return;
  if (!save_map()) counters_.add("map not saved", CountKind::kLoss);
}

void SlamNode::publish_markers(Timestamp time) {
  publish(channels::kSlamMarkers, to_messages(estimator_->landmarks(), time));
  if (loaded_map_ == nullptr && survey_.empty()) return;
  const std::vector<MapChange> changes = estimator_->changes();
  outbox_.publish(channels::kSlamChanges, to_message(changes, time, map_id_));
  for (const MapChange& change : changes)
    if (change.kind == MapChange::Kind::kSurveyOff && named_survey_ids_.insert(change.id).second)
      logging::warn("surveyed marker {} contradicts the survey by {:.1f} sigma", change.id,
                    change.sigmas);
}

void SlamNode::publish_grid(Timestamp time) {
  if (!config_.channels.uses(channels::kSlamGrid.name)) return;
  if (const auto grid = to_occupancy_grid(estimator_->map(), time))
    outbox_.publish(channels::kSlamGrid, *grid);
}

void SlamNode::publish_mbot_status(Timestamp time) {
  if (!config_.channels.uses(channels::kMbotSlamStatus.name)) return;
  slam_status_t status{};
  status.utime = to_us(time);
  status.slam_mode = mbot_mode(config_.slam.mode);
  status.map_path = config_.load_map.string();
  outbox_.publish(channels::kMbotSlamStatus, status);
}

void SlamNode::obey(const mbot_slam_reset_t& reset) {
  const std::int32_t mode = mbot_mode(config_.slam.mode);
  if (reset.slam_mode != mode || reset.retain_pose != 0) {
    counters_.add("MBOT_SYSTEM_RESET refused");
    logging::warn(
        "MBOT_SYSTEM_RESET refused: it asks for mode {}{}, but slam runs in mode {} and begins at "
        "slam.start",
        reset.slam_mode, reset.retain_pose != 0 ? " at the current pose" : "", mode);
    return;
  }
  counters_.add("MBOT_SYSTEM_RESET obeyed");
  logging::info("MBOT_SYSTEM_RESET: begins anew");
  queue_ = SensorQueue{sensor_setup(config_)};
  begin_estimator(config_.slam.mode, loaded_map_, configured_start_);
}

}  // namespace waymark
