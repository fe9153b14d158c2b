// SPDX-License-Identifier: BSD-3-Clause
#include "slam/slam_node.hpp"

#include "common/messages/convert.hpp"
#include "slam/estimator_factory.hpp"
#include "slam/slam_messages.hpp"

#include <spdlog/spdlog.h>

#include <string_view>
#include <utility>

namespace waymark {
namespace {

constexpr std::string_view kScansProcessed = "scans processed";

}  // namespace

SlamNode::SlamNode(const SlamConfig& config, Inbox& inbox, Outbox& outbox)
    : config_{config},
      counters_{inbox.counters()},
      outbox_{outbox},
      queue_{sensor_setup(config)},
      estimator_{make_estimator(config)} {
  inbox.on<planar_lidar_t>(channels::kLidar, [this](const auto& m) { take(to_scan(m)); });
  inbox.on<lidar_t>(channels::kMbotLidar, [this](const auto& m) { take(to_scan(m)); });
  inbox.on<pose2D_t>(channels::kOdometry, [this](const auto& m) {
    queue_.add(to_odometry(m));
    process_ready_scans();
  });
  inbox.on<marker_detections_t>(channels::kMarkers, [this](const auto& m) {
    queue_.add(to_detections(m));
    process_ready_scans();
  });
}

void SlamNode::finish() {
  queue_.finish();
  process_ready_scans();
  judge_input();
  if (!last_estimate_) return;
  for (const map_tiles_t& part :
       map_publisher_.complete(estimator_->redrawn_map(), *last_estimate_))
    outbox_.publish(channels::kSlamMap, part);
  publish_markers(*last_estimate_);
  publish_grid(*last_estimate_);
  for (const trajectory_t& part : to_messages(estimator_->trajectory()))
    outbox_.publish(channels::kSlamTrajectory, part);
  spdlog::info("{}", timer_.summary());
}

/// An input that nothing can be made of shall not look like success.
void SlamNode::judge_input() {
  const std::int64_t scans = counters_.get(received_on(channels::kLidar.name));
  const std::int64_t odometry = counters_.get(received_on(channels::kOdometry.name));
  if (!last_estimate_ && scans + odometry > 0) {
    failed_ = true;
    spdlog::error("no pose: of LIDAR {} and of ODOMETRY {} messages could be read; both are needed",
                  scans, odometry);
  }
  const std::int64_t processed = counters_.get(kScansProcessed);
  if (processed > 0 && counters_.get(to_string(Skip::kScanWithoutReturns)) >= processed) {
    failed_ = true;
    spdlog::error(
        "no map: no scan has a range from {} to {} m; are they in metres, and is [robot.lidar] "
        "that of this robot?",
        config_.robot.lidar.range_min_m, config_.robot.lidar.range_max_m);
  }
}

void SlamNode::take(LidarScan scan) {
  if (std::ssize(scan.ranges_m) != config_.robot.lidar.num_beams)
    counters_.add("scans with another number of beams than told");
  queue_.add(std::move(scan));
  process_ready_scans();
}

void SlamNode::process_ready_scans() {
  while (const auto ready = queue_.next())
    process(*ready);
  for (const Skip skip : queue_.take_skips())
    counters_.add(to_string(skip));
}

void SlamNode::process(const SensorQueue::Ready& ready) {
  timer_.start();
  const Estimate estimate = estimator_->update(ready.observation);
  timer_.stop(estimate.updated);
  const Timestamp time = estimate.time;
  const Se2 map_from_lidar = estimate.map_from_base * config_.robot.lidar.base_from_lidar();
  last_estimate_ = time;
  counters_.add(ready.scan ? kScansProcessed : "estimates while the LiDAR was silent");
  if (estimate.slipped) counters_.add("slips of the wheels");
  if (estimate.calibration_widened) counters_.add("calibration found worse than told");
  if (ready.scan && estimate.ranges_wrong) counters_.add("scans with wrong ranges");
  if (ready.scan)
    outbox_.publish(channels::kSlamScan,
                    to_message(*ready.scan, ready.observation, map_from_lidar));
  outbox_.publish(channels::kSlamPose, to_pose_message(time, estimate.map_from_base));
  outbox_.publish(channels::kSlamEstimate, to_message(estimate));
  outbox_.publish(channels::kSlamParticles, to_message(estimator_->particles(), time));
  publish_map_when_due(time);
}

void SlamNode::publish_map_when_due(Timestamp time) {
  if (next_map_ && time < *next_map_) return;
  next_map_ = time + duration_from_seconds(config_.slam.map_period_s);
  for (const map_tiles_t& part : map_publisher_.changes(estimator_->map(), time))
    outbox_.publish(channels::kSlamMap, part);
  publish_markers(time);
  publish_grid(time);
}

void SlamNode::publish_markers(Timestamp time) {
  for (const marker_map_t& part : to_messages(estimator_->landmarks(), time))
    outbox_.publish(channels::kSlamMarkers, part);
}

void SlamNode::publish_grid(Timestamp time) {
  if (!config_.slam.publish_grid) return;
  const auto grid = to_occupancy_grid(estimator_->map(), time);
  if (grid) {
    outbox_.publish(channels::kSlamGrid, *grid);
  } else {
    counters_.add("SLAM_GRID not sent: larger than a datagram");
  }
}

}  // namespace waymark
