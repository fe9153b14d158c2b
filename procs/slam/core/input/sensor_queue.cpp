// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/input/sensor_queue.hpp"

#include <algorithm>
#include <cmath>
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

/// A robot that stands may see the same again; this much further on it cannot.
constexpr double kElsewhere_m = 0.05;
constexpr double kElsewhere_rad = 0.05;
constexpr std::size_t kTooMany = 20;  // returns that agree by chance

bool are_same(const std::vector<double>& before, const std::vector<double>& now) {
  return std::equal(before.begin(), before.end(), now.begin(), now.end(),
                    [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); });
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
      return "odometry catching up after it was stuck or jumped";
    case Skip::kScanOutOfOrder:
      return "scans out of order";
    case Skip::kScanAhead:
      return "scans dropped: stamped ahead";
    case Skip::kScanWithoutReturns:
      return "scans without returns";
    case Skip::kScanRepeated:
      return "scans that repeat one from elsewhere";
    case Skip::kScanBeforeOdometry:
      return "scans before the first odometry";
    case Skip::kScanWithoutOdometry:
      return "scans after the last odometry";
    case Skip::kScanOverflow:
      return "scans dropped waiting for odometry";
    case Skip::kFrameOutOfOrder:
      return "camera frames out of order";
    case Skip::kFrameAhead:
      return "camera frames dropped: stamped ahead";
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

/// A sample that leads counts once another one is newer still: until then nothing has reached its
/// time.
void SensorQueue::add(const OdometrySample& sample) {
  if (const auto leading = std::exchange(leading_odometry_, std::nullopt)) {
    if (sample.time > leading->time) {
      take(*leading);
    } else if (sample.time > odometry_.newest()) {
      skip(Skip::kOdometryAhead);
    } else {
      leading_odometry_ = leading;
    }
  }
  if (shows_first_was_ahead(sample)) {
    skip(Skip::kOdometryAhead);
    odometry_ = {};
  }
  if (leads(sample)) {
    leading_odometry_ = sample;
  } else {
    take(sample);
  }
}

bool SensorQueue::leads(const OdometrySample& sample) const {
  if (odometry_.is_empty()) return false;
  const Duration step = sample.time - odometry_.newest();
  return step > 2 * usual_step_ && step <= ClockWatch::kLongestPause;
}

/// Nothing before it could tell.
bool SensorQueue::shows_first_was_ahead(const OdometrySample& sample) const {
  return odometry_.has_one() && !last_observed_ && sample.time < odometry_.newest() &&
         sample.time >= odometry_.newest() - kLongestLead;
}

void SensorQueue::take(const OdometrySample& sample) {
  const bool is_first = odometry_.is_empty();
  const Duration step = is_first ? kLongestStep : sample.time - odometry_.newest();
  const auto outcome = odometry_.add(sample);
  note(outcome);
  if (!is_refused(outcome)) {
    usual_step_ = std::min(step, 2 * usual_step_);
    clock_watch_.see_fitting();
    if (is_first) drop_what_is_ahead();
  } else if (clock_watch_.see_misfit(sample.time)) {
    set_clock();
    note(odometry_.add(sample));
  }
}

void SensorQueue::skip(Skip reason, std::size_t times) {
  skips_.insert(skips_.end(), times, reason);
}

void SensorQueue::note(OdometryBuffer::Outcome outcome) {
  switch (outcome) {
    case OdometryBuffer::Outcome::kAdded:
      break;
    case OdometryBuffer::Outcome::kOutOfOrder:
      skip(Skip::kOdometryOutOfOrder);
      break;
    case OdometryBuffer::Outcome::kTooFarAhead:
      skip(Skip::kOdometryAhead);
      break;
    case OdometryBuffer::Outcome::kJumped:
      skip(Skip::kOdometryJumped);
      break;
    case OdometryBuffer::Outcome::kCaughtUp:
      skip(Skip::kOdometryStuck);
      break;
  }
}

/// What was stamped by the clock as it was is moved to where odometry goes on, so that no motion is
/// lost.
void SensorQueue::set_clock() {
  skip(Skip::kClockSet);
  const Duration later = clock_watch_.first_misfit() - odometry_.newest();
  odometry_.shift(later);
  if (last_observed_) *last_observed_ += later;
  if (std::exchange(leading_odometry_, std::nullopt)) skip(Skip::kOdometryAhead);
  skip(Skip::kScanOutOfOrder, scans_.clear());
  skip(Skip::kFrameOutOfOrder, frames_.clear());
}

Timestamp SensorQueue::newest_odometry() const {
  return leading_odometry_ ? leading_odometry_->time : odometry_.newest();
}

bool SensorQueue::is_ahead(Timestamp time) const {
  return !odometry_.is_empty() && time > newest_odometry() + kLongestLead;
}

/// What came before any odometry could not be judged.
void SensorQueue::drop_what_is_ahead() {
  const auto drop_from = [this](auto& line, Skip reason) {
    const auto ahead = [this](const auto& waiting) {
      return is_ahead(waiting.time);
    };
    skip(reason, std::erase_if(line.values, ahead));
    if (line.newest && is_ahead(*line.newest)) line.newest.reset();
  };
  drop_from(scans_, Skip::kScanAhead);
  drop_from(frames_, Skip::kFrameAhead);
}

void SensorQueue::add(LidarScan measured) {
  LidarScan scan = at_middle_of_sweep(std::move(measured));
  if (last_observed_ && scan.time <= *last_observed_) return skip(Skip::kScanOutOfOrder);
  if (is_ahead(scan.time)) return skip(Skip::kScanAhead);
  auto judgement = scans_.judge(std::move(scan));
  skip(Skip::kScanAhead, judgement.ahead);
  skip(Skip::kScanOutOfOrder, judgement.late);
  for (LidarScan& fitting : judgement.fitting)
    line_up(std::move(fitting));
}

void SensorQueue::line_up(LidarScan scan) {
  scans_.push(std::move(scan));
  if (scans_.values.size() <= kMaxScans) return;
  scans_.values.pop_front();
  skip(Skip::kScanOverflow);
}

void SensorQueue::add(MarkerDetections frame) {
  if (is_ahead(frame.time)) return skip(Skip::kFrameAhead);
  auto judgement = frames_.judge(std::move(frame));
  skip(Skip::kFrameAhead, judgement.ahead);
  skip(Skip::kFrameOutOfOrder, judgement.late);
  for (MarkerDetections& fitting : judgement.fitting)
    line_up(std::move(fitting));
}

void SensorQueue::line_up(MarkerDetections frame) {
  const bool is_repeated = are_repeated(newest_detections_, frame.detections);
  newest_detections_ = frame.detections;
  if (is_repeated) {
    frames_.newest = frame.time;
    return skip(Skip::kFrameRepeated);
  }
  frames_.push(std::move(frame));
  if (frames_.values.size() <= kMaxFrames) return;
  frames_.values.pop_front();
  skip(Skip::kFrameOverflow);
}

void SensorQueue::finish() {
  has_finished_ = true;
  if (const auto leading = std::exchange(leading_odometry_, std::nullopt)) take(*leading);
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
  const bool is_doubtful = scans_.aside && scan.time > scans_.aside->time;
  if (is_doubtful && !has_passed(scan.time + setup_.scan_wait)) return false;
  return (frames_.newest && *frames_.newest >= scan.time) ||
         has_passed(scan.time + setup_.marker_wait);
}

std::optional<SensorQueue::Ready> SensorQueue::next() {
  while (!scans_.values.empty() && is_ready(scans_.values.front())) {
    LidarScan scan = std::move(scans_.values.front());
    scans_.values.pop_front();
    if (!has_passed(last_beam_time(scan))) {
      skip(Skip::kScanWithoutOdometry);
      continue;
    }
    if (!odometry_.covers(first_beam_time(scan))) {
      skip(Skip::kScanBeforeOdometry);
      continue;
    }
    const std::vector<Beam> beams = beams_of(scan, setup_.lidar, odometry_);
    const MeanSweep sweep = mean_sweep(scan, odometry_);
    if (beams.empty()) skip(Skip::kScanWithoutReturns);
    Ready ready{observation_at(scan.time, beams), std::nullopt};
    ready.observation.mean_sweep = sweep;
    if (repeats_one_from_elsewhere(scan, ready.observation.motion) && beams.size() >= kTooMany) {
      skip(Skip::kScanRepeated);
      ready.observation.beams.clear();
    }
    ready.scan = std::move(scan);
    return ready;
  }
  if (const auto time = next_without_scan()) return Ready{observation_at(*time, {}), std::nullopt};
  return std::nullopt;
}

bool SensorQueue::repeats_one_from_elsewhere(const LidarScan& scan, const Motion& motion) {
  since_new_ranges_ = since_new_ranges_.then(motion);
  if (!are_same(newest_ranges_m_, scan.ranges_m)) {
    newest_ranges_m_ = scan.ranges_m;
    since_new_ranges_ = {};
  }
  return since_new_ranges_.distance_m > kElsewhere_m || since_new_ranges_.turn_rad > kElsewhere_rad;
}

/// One that is further ahead may be stamped wrong, and holds nothing up.
bool SensorQueue::scan_is_due() const {
  return !scans_.values.empty() &&
         scans_.values.front().time <= newest_odometry() + setup_.scan_wait;
}

/// Only where odometry was measured: where it stays away, too, there is nothing to observe.
std::optional<Timestamp> SensorQueue::next_without_scan() const {
  if (!last_observed_ || scan_is_due()) return std::nullopt;
  const auto time = odometry_.first_from(*last_observed_ + kStepWithoutScan);
  return time && has_passed(*time + setup_.scan_wait) ? time : std::nullopt;
}

Observation SensorQueue::observation_at(Timestamp time, std::span<const Beam> beams) {
  Observation observation = observe(time, beams);
  last_observed_ = time;
  if (scans_.aside && scans_.aside->time <= time) {
    scans_.aside.reset();
    skip(Skip::kScanOutOfOrder);
  }
  // Camera frames that still belong to the next scan are at most marker_wait older than this one.
  odometry_.forget_before(time - setup_.marker_wait);
  return observation;
}

Observation SensorQueue::observe(Timestamp time, std::span<const Beam> beams) {
  Observation observation;
  observation.time = time;
  observation.odom_from_base = odometry_.sent_pose_at(time);
  if (last_observed_ && odometry_.covers(*last_observed_)) {
    observation.motion = odometry_.motion_between(*last_observed_, time);
    observation.odometry_doubtful = odometry_.is_doubtful(*last_observed_, time);
    if (const auto kept_back = odometry_.kept_back(*last_observed_, time)) {
      observation.motion = kept_back->then(observation.motion);
      observation.odometry_caught_up = true;
    }
  }
  while (!frames_.values.empty() && frames_.values.front().time <= time) {
    const MarkerDetections frame = std::move(frames_.values.front());
    frames_.values.pop_front();
    if (!odometry_.covers(frame.time)) {
      skip(Skip::kFrameWithoutOdometry);
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
      skip(Skip::kMarkerImplausible);
    } else if (sighting->sigma_along_m() > setup_.max_sigma_m) {
      skip(Skip::kMarkerUncertain);
    } else {
      sighting->focal = focal_sighting(detection);
      sightings.push_back(*sighting);
    }
  }
}

}  // namespace waymark
