// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/input/sensor_queue.hpp"

#include <algorithm>
#include <utility>

namespace waymark {
namespace {

constexpr Duration kStepWithoutScan{200'000};  // a LiDAR's usual period
// Scans and frames may wait for odometry that comes in bursts; what is further ahead is stamped
// wrong.
constexpr Duration kLongestLead = std::chrono::seconds{10};

/// No camera sees the same twice to the last bit, unless it does not look again.
bool are_repeated(std::span<const MarkerDetection> before, std::span<const MarkerDetection> now) {
  return !now.empty() &&
         std::equal(before.begin(), before.end(), now.begin(), now.end(),
                    [](const MarkerDetection& a, const MarkerDetection& b) {
                      return a.id == b.id && a.corners_px == b.corners_px &&
                             a.base_from_marker.matrix() == b.base_from_marker.matrix();
                    });
}

bool is_refused(OdometryBuffer::Outcome outcome) {
  return outcome == OdometryBuffer::Outcome::kOutOfOrder ||
         outcome == OdometryBuffer::Outcome::kTooFarAhead;
}

}  // namespace

std::string_view to_string(Skip skip) {
  switch (skip) {
    case Skip::kOdometryOutOfOrder:
      return "odometry out of order";
    case Skip::kOdometryAhead:
      return "odometry rejected: time jumps ahead";
    case Skip::kClockSet:
      return "clock was set";
    case Skip::kOdometryJumped:
      return "odometry jumps";
    case Skip::kOdometryStuck:
      return "odometry catching up after it was stuck";
    case Skip::kScanOutOfOrder:
      return "scans out of order";
    case Skip::kScanAhead:
      return "scans dropped: far ahead of odometry";
    case Skip::kScanWithoutReturns:
      return "scans without returns";
    case Skip::kScanBeforeOdometry:
      return "scans before the first odometry";
    case Skip::kScanWithoutOdometry:
      return "scans after the last odometry";
    case Skip::kScanOverflow:
      return "scans dropped waiting for odometry";
    case Skip::kFrameOutOfOrder:
      return "camera frames out of order";
    case Skip::kFrameAhead:
      return "camera frames dropped: far ahead of odometry";
    case Skip::kFrameWithoutOdometry:
      return "camera frames dropped: too late, or before the first odometry";
    case Skip::kFrameOverflow:
      return "camera frames dropped waiting for a scan";
    case Skip::kFrameRepeated:
      return "camera frames that repeat the one before";
    case Skip::kMarkerImplausible:
      return "markers not upright";
    case Skip::kMarkerUncertain:
      return "markers too uncertain";
  }
  return "unknown";
}

void SensorQueue::add(const OdometrySample& sample) {
  const bool is_first = odometry_.is_empty();
  auto outcome = odometry_.add(sample);
  note(outcome);
  if (!is_refused(outcome)) {
    clock_watch_.see_fitting();
    if (is_first) drop_what_is_ahead();
  } else if (clock_watch_.see_misfit(sample.time)) {
    set_clock();
    note(odometry_.add(sample));
  }
}

void SensorQueue::note(OdometryBuffer::Outcome outcome) {
  switch (outcome) {
    case OdometryBuffer::Outcome::kAdded:
      break;
    case OdometryBuffer::Outcome::kOutOfOrder:
      skips_.push_back(Skip::kOdometryOutOfOrder);
      break;
    case OdometryBuffer::Outcome::kTooFarAhead:
      skips_.push_back(Skip::kOdometryAhead);
      break;
    case OdometryBuffer::Outcome::kJumped:
      skips_.push_back(Skip::kOdometryJumped);
      break;
    case OdometryBuffer::Outcome::kCaughtUp:
      skips_.push_back(Skip::kOdometryStuck);
      break;
  }
}

/// What was stamped by the clock as it was is moved to where odometry goes on, so that no motion is
/// lost.
void SensorQueue::set_clock() {
  skips_.push_back(Skip::kClockSet);
  const Duration later = clock_watch_.first_misfit() - odometry_.newest();
  odometry_.shift(later);
  if (last_observed_) *last_observed_ += later;
  skips_.insert(skips_.end(), scans_.size(), Skip::kScanOutOfOrder);
  skips_.insert(skips_.end(), frames_.size(), Skip::kFrameOutOfOrder);
  scans_.clear();
  frames_.clear();
  newest_scan_.reset();
  newest_frame_.reset();
}

bool SensorQueue::is_ahead(Timestamp time) const {
  return !odometry_.is_empty() && time > odometry_.newest() + kLongestLead;
}

/// What came before any odometry could not be judged.
void SensorQueue::drop_what_is_ahead() {
  const auto ahead = [this](const auto& waiting) {
    return is_ahead(waiting.time);
  };
  skips_.insert(skips_.end(), std::erase_if(scans_, ahead), Skip::kScanAhead);
  skips_.insert(skips_.end(), std::erase_if(frames_, ahead), Skip::kFrameAhead);
  if (newest_scan_ && is_ahead(*newest_scan_)) newest_scan_.reset();
  if (newest_frame_ && is_ahead(*newest_frame_)) newest_frame_.reset();
}

void SensorQueue::add(LidarScan measured) {
  LidarScan scan = at_middle_of_sweep(std::move(measured));
  if ((newest_scan_ && scan.time <= *newest_scan_) ||
      (last_observed_ && scan.time <= *last_observed_)) {
    skips_.push_back(Skip::kScanOutOfOrder);
    return;
  }
  if (is_ahead(scan.time)) {
    skips_.push_back(Skip::kScanAhead);
    return;
  }
  newest_scan_ = scan.time;
  scans_.push_back(std::move(scan));
  if (scans_.size() > kMaxScans) {
    scans_.pop_front();
    skips_.push_back(Skip::kScanOverflow);
  }
}

void SensorQueue::add(MarkerDetections frame) {
  if (newest_frame_ && frame.time <= *newest_frame_) {
    skips_.push_back(Skip::kFrameOutOfOrder);
    return;
  }
  if (is_ahead(frame.time)) {
    skips_.push_back(Skip::kFrameAhead);
    return;
  }
  newest_frame_ = frame.time;
  const bool is_repeated = are_repeated(newest_detections_, frame.detections);
  newest_detections_ = frame.detections;
  if (is_repeated) {
    skips_.push_back(Skip::kFrameRepeated);
    return;
  }
  frames_.push_back(std::move(frame));
  if (frames_.size() > kMaxFrames) {
    frames_.pop_front();
    skips_.push_back(Skip::kFrameOverflow);
  }
}

void SensorQueue::finish() {
  has_finished_ = true;
}

std::vector<Skip> SensorQueue::take_skips() {
  return std::exchange(skips_, {});
}

bool SensorQueue::has_passed(Timestamp time) const {
  return !odometry_.is_empty() && odometry_.newest() >= time;
}

bool SensorQueue::is_ready(const LidarScan& scan) const {
  if (has_finished_) return true;
  if (!has_passed(last_beam_time(scan))) return false;
  return (newest_frame_ && *newest_frame_ >= scan.time) ||
         has_passed(scan.time + setup_.marker_wait);
}

std::optional<SensorQueue::Ready> SensorQueue::next() {
  while (!scans_.empty() && is_ready(scans_.front())) {
    LidarScan scan = std::move(scans_.front());
    scans_.pop_front();
    if (!has_passed(last_beam_time(scan))) {
      skips_.push_back(Skip::kScanWithoutOdometry);
      continue;
    }
    if (!odometry_.covers(first_beam_time(scan))) {
      skips_.push_back(Skip::kScanBeforeOdometry);
      continue;
    }
    const std::vector<Beam> beams = beams_of(scan, setup_.lidar, odometry_);
    const MeanSweep sweep = mean_sweep(scan, odometry_);
    if (beams.empty()) skips_.push_back(Skip::kScanWithoutReturns);
    Ready ready{observation_at(scan.time, beams), std::nullopt};
    ready.observation.mean_sweep = sweep;
    ready.scan = std::move(scan);
    return ready;
  }
  if (const auto time = next_without_scan()) return Ready{observation_at(*time, {}), std::nullopt};
  return std::nullopt;
}

/// Only where odometry was measured: where it stays away, too, there is nothing to observe.
std::optional<Timestamp> SensorQueue::next_without_scan() const {
  if (!last_observed_ || !scans_.empty()) return std::nullopt;
  const auto time = odometry_.first_from(*last_observed_ + kStepWithoutScan);
  return time && has_passed(*time + setup_.scan_wait) ? time : std::nullopt;
}

Observation SensorQueue::observation_at(Timestamp time, std::span<const Beam> beams) {
  Observation observation = observe(time, beams);
  last_observed_ = time;
  // Camera frames that still belong to the next scan are at most marker_wait older than this one.
  odometry_.forget_before(time - setup_.marker_wait);
  return observation;
}

Observation SensorQueue::observe(Timestamp time, std::span<const Beam> beams) {
  Observation observation;
  observation.time = time;
  if (last_observed_ && odometry_.covers(*last_observed_)) {
    observation.motion = odometry_.motion_between(*last_observed_, time);
    if (const auto kept_back = odometry_.kept_back(*last_observed_, time)) {
      observation.motion = kept_back->then(observation.motion);
      observation.odometry_caught_up = true;
    }
  }
  while (!frames_.empty() && frames_.front().time <= time) {
    const MarkerDetections frame = std::move(frames_.front());
    frames_.pop_front();
    if (!odometry_.covers(frame.time)) {
      skips_.push_back(Skip::kFrameWithoutOdometry);
      continue;
    }
    observation.camera_reported = true;
    if (!setup_.blank_ids) sight_markers(frame, time, observation.sightings);
  }
  const bool camera_told = observation.camera_reported && !setup_.blank_ids;
  observation.beams = annotate(beams, observation.sightings, camera_told ? &setup_.camera : nullptr,
                               setup_.beam_tolerance_m);
  return observation;
}

std::optional<FocalSighting> SensorQueue::focal_sighting(const MarkerDetection& detection) const {
  if (!setup_.ray_of_pixel) return std::nullopt;
  std::array<Eigen::Vector2d, 4> corners;
  for (std::size_t i = 0; i < corners.size(); ++i)
    corners[i] = setup_.ray_of_pixel(detection.corners_px[i]);
  return focal_error_of(corners, setup_.corner_sigma);
}

void SensorQueue::sight_markers(const MarkerDetections& frame, Timestamp time,
                                std::vector<MarkerSighting>& sightings) {
  const Se2 scan_base_from_frame_base =
      odometry_.pose_at(time).inverse() * odometry_.pose_at(frame.time);
  for (const MarkerDetection& detection : frame.detections) {
    auto sighting =
        sight_marker(detection, frame.time, scan_base_from_frame_base, setup_.marker_size_m);
    if (!sighting) {
      skips_.push_back(Skip::kMarkerImplausible);
    } else if (sighting->sigma_along_m() > setup_.max_sigma_m) {
      skips_.push_back(Skip::kMarkerUncertain);
    } else {
      sighting->focal = focal_sighting(detection);
      sightings.push_back(*sighting);
    }
  }
}

}  // namespace waymark
