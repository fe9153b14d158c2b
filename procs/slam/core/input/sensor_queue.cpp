// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/input/sensor_queue.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark {
namespace {

constexpr Duration kStepWithoutScan{200'000};  // a LiDAR's usual period

// Bounds of the queues, for up to 100 scans or frames a second.
constexpr std::size_t kCapacity = 2000;
constexpr Duration kMaxAge = std::chrono::seconds{20};
constexpr QueuePolicy kScanPolicy{.capacity = kCapacity,
                                  .max_age = kMaxAge,
                                  .out_of_order = Skip::kScanOutOfOrder,
                                  .ahead = Skip::kScanAhead,
                                  .overflow = Skip::kScanOverflow};
constexpr QueuePolicy kFramePolicy{.capacity = kCapacity,
                                   .max_age = kMaxAge,
                                   .out_of_order = Skip::kFrameOutOfOrder,
                                   .ahead = Skip::kFrameAhead,
                                   .overflow = Skip::kFrameOverflow};

/// Two different images never yield bitwise identical corners.
bool are_repeated(std::span<const MarkerDetection> before, std::span<const MarkerDetection> now) {
  return !now.empty() &&
         std::equal(before.begin(), before.end(), now.begin(), now.end(),
                    [](const MarkerDetection& a, const MarkerDetection& b) {
                      return a.id == b.id && a.corners_px == b.corners_px &&
                             a.base_from_marker.matrix() == b.base_from_marker.matrix();
                    });
}

/// Motion after which an identical scan cannot be new.
constexpr double kElsewhere_m = 0.05;
constexpr double kElsewhere_rad = 0.05;
constexpr std::size_t kTooMany = 20;  // so many returns are not identical by chance

bool are_same(const std::vector<double>& before, const std::vector<double>& now) {
  return std::equal(before.begin(), before.end(), now.begin(), now.end(),
                    [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); });
}

}  // namespace

SensorQueue::SensorQueue(const SensorSetup& setup)
    : setup_{setup},
      marker_wait_{duration_from_seconds(setup.preprocessing.marker_wait_s)},
      scan_wait_{duration_from_seconds(setup.preprocessing.scan_wait_s)},
      scans_{kScanPolicy},
      frames_{kFramePolicy} {}

void SensorQueue::add(const OdometrySample& sample) {
  const OdometryStream::News news = odometry_.add(sample, skips_);
  if (news.is_first) {  // earlier stamps could not be checked
    scans_.drop_after(odometry_.lead_limit(), skips_);
    frames_.drop_after(odometry_.lead_limit(), skips_);
  }
  if (news.clock_set) {
    if (last_observed_) *last_observed_ += *news.clock_set;
    clock_set_ += *news.clock_set;
    scans_.clear(skips_);
    frames_.clear(skips_);
  }
  scans_.add_held(odometry_.lead_limit(), skips_);
  frames_.add_held(odometry_.lead_limit(), skips_);
}

void SensorQueue::add(LidarScan measured) {
  LidarScan scan = at_middle_of_sweep(std::move(measured));
  if (last_observed_ && scan.time <= *last_observed_) return skips_.add(Skip::kScanOutOfOrder);
  if (odometry_.is_ahead(scan.time)) return scans_.hold(std::move(scan), skips_);
  scans_.add(std::move(scan), skips_);
}

void SensorQueue::add(MarkerDetections frame) {
  if (odometry_.is_ahead(frame.time)) return frames_.hold(std::move(frame), skips_);
  frames_.add(std::move(frame), skips_);
}

void SensorQueue::finish() {
  has_finished_ = true;
  odometry_.finish(skips_);
  scans_.drop_held(skips_);
  frames_.drop_held(skips_);
}

bool SensorQueue::is_ready(const LidarScan& scan) const {
  if (has_finished_) return true;
  if (!odometry_.has_passed(last_beam_time(scan))) return false;
  if (scans_.may_be_dropped(scan.time) && !odometry_.has_passed(scan.time + scan_wait_))
    return false;
  return frames_.has_reached(scan.time) || odometry_.has_passed(scan.time + marker_wait_);
}

std::optional<SensorQueue::Ready> SensorQueue::next() {
  while (!scans_.is_empty() && is_ready(scans_.front())) {
    if (auto ready = ready_from(scans_.pop())) return ready;
  }
  if (const auto time = next_without_scan()) return Ready{observation_at(*time, {}), std::nullopt};
  return std::nullopt;
}

std::optional<SensorQueue::Ready> SensorQueue::ready_from(LidarScan scan) {
  if (!odometry_.has_passed(last_beam_time(scan))) {
    skips_.add(Skip::kScanWithoutOdometry);
    return std::nullopt;
  }
  if (!odometry_.buffer().covers(first_beam_time(scan))) {
    skips_.add(Skip::kScanBeforeOdometry);
    return std::nullopt;
  }
  const std::vector<Beam> beams = beams_of(scan, setup_.lidar, odometry_.buffer());
  const MeanSweep sweep = mean_sweep(scan, odometry_.buffer());
  if (beams.empty()) skips_.add(Skip::kScanWithoutReturns);
  Ready ready{observation_at(scan.time, beams), std::nullopt};
  ready.observation.mean_sweep = sweep;
  if (repeats_one_from_elsewhere(scan, ready.observation.motion) && beams.size() >= kTooMany) {
    skips_.add(Skip::kScanRepeated);
    ready.observation.beams.clear();
  }
  ready.scan = std::move(scan);
  return ready;
}

bool SensorQueue::repeats_one_from_elsewhere(const LidarScan& scan, const Motion& motion) {
  since_new_ranges_ = since_new_ranges_.then(motion);
  if (!are_same(newest_ranges_m_, scan.ranges_m)) {
    newest_ranges_m_ = scan.ranges_m;
    since_new_ranges_ = {};
  }
  return since_new_ranges_.distance_m > kElsewhere_m || since_new_ranges_.turn_rad > kElsewhere_rad;
}

bool SensorQueue::repeats_the_one_before(const MarkerDetections& frame) {
  const bool is_repeated = are_repeated(newest_detections_, frame.detections);
  newest_detections_ = frame.detections;
  return is_repeated;
}

/// A scan further ahead may have a wrong stamp, and must not block observations without a scan.
bool SensorQueue::scan_is_due() const {
  return !scans_.is_empty() && scans_.front().time <= odometry_.newest() + scan_wait_;
}

/// Time of an observation without a scan, at a sample of the odometry.
std::optional<Timestamp> SensorQueue::next_without_scan() const {
  if (!last_observed_ || scan_is_due()) return std::nullopt;
  const auto time = odometry_.buffer().first_from(*last_observed_ + kStepWithoutScan);
  return time && odometry_.has_passed(*time + scan_wait_) ? time : std::nullopt;
}

Observation SensorQueue::observation_at(Timestamp time, std::span<const Beam> beams) {
  Observation observation;
  observation.time = time;
  if (last_observed_) observation.elapsed_s = to_seconds(time - *last_observed_);
  observation.clock_set = std::exchange(clock_set_, {});
  add_motion(time, observation);
  add_frames(time, observation);
  const bool camera_saw_all = observation.camera_reported && !setup_.blank_ids;
  observation.beams =
      annotate(beams, observation.sightings, camera_saw_all ? &setup_.camera : nullptr,
               setup_.preprocessing.beam_tolerance_m);
  last_observed_ = time;
  scans_.drop_candidate_until(time, skips_);
  // Camera frames that still belong to the next scan are at most marker_wait_ older than this one.
  odometry_.forget_before(time - marker_wait_);
  return observation;
}

void SensorQueue::add_motion(Timestamp time, Observation& observation) const {
  const OdometryBuffer& odometry = odometry_.buffer();
  observation.odom_from_base = odometry.sent_pose_at(time);
  if (!last_observed_ || !odometry.covers(*last_observed_)) return;
  observation.motion = odometry.motion_between(*last_observed_, time);
  observation.odometry_jumped = odometry.has_jumped(*last_observed_, time);
  if (const auto late_motion = odometry.late_motion(*last_observed_, time)) {
    observation.motion = late_motion->then(observation.motion);
    observation.odometry_caught_up = true;
  }
}

void SensorQueue::add_frames(Timestamp time, Observation& observation) {
  while (!frames_.is_empty() && frames_.front().time <= time) {
    const MarkerDetections frame = frames_.pop();
    if (repeats_the_one_before(frame)) {
      skips_.add(Skip::kFrameRepeated);
      continue;
    }
    if (!odometry_.buffer().covers(frame.time)) {
      skips_.add(Skip::kFrameWithoutOdometry);
      continue;
    }
    observation.camera_reported = true;
    if (!setup_.blank_ids) add_sightings(frame, time, observation.sightings);
  }
}

void SensorQueue::add_sightings(const MarkerDetections& frame, Timestamp time,
                                std::vector<MarkerSighting>& sightings) {
  const Se2 scan_base_from_frame_base =
      odometry_.buffer().pose_at(time).inverse() * odometry_.buffer().pose_at(frame.time);
  for (const MarkerDetection& detection : frame.detections) {
    auto sighting =
        sight_marker(detection, frame.time, scan_base_from_frame_base, setup_.marker_size_m);
    if (!sighting) {
      skips_.add(Skip::kMarkerImplausible);
    } else if (sighting->sigma_along_wall_m() > setup_.preprocessing.max_sigma_m) {
      skips_.add(Skip::kMarkerUncertain);
    } else {
      sightings.push_back(*sighting);
    }
  }
}

}  // namespace waymark
