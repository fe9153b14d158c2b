// SPDX-License-Identifier: BSD-3-Clause
// Turns three streams of sensor values into observations, whatever order they arrive in.
#pragma once

#include "common/time/clock_watch.hpp"
#include "slam/core/input/waiting_line.hpp"
#include "slam/core/motion/odometry_buffer.hpp"
#include "slam/core/scan/observation.hpp"

#include <functional>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

namespace waymark {

/// Sensors as the queue needs to know them.
struct SensorSetup {
  LidarSetup lidar{};
  CameraView camera{};
  double marker_size_m{0.4};
  double beam_tolerance_m{0.08};  ///< a beam that ends this near to a marker's segment is on it
  double max_sigma_m{0.05};       ///< sightings less certain than this are not used
  Duration marker_wait{250'000};  ///< how long a scan waits for the camera frames up to its time
  Duration scan_wait{1'000'000};  ///< how late a scan may be before it is done without
  /// Ray of a pixel: its point at distance 1 in front of a camera without lens errors.
  std::function<Eigen::Vector2d(const Eigen::Vector2d&)> ray_of_pixel{};
  double corner_sigma{1e-4};  ///< of a marker's corner, same unit as ray_of_pixel
  bool blank_ids{false};      ///< control: forget all markers
};

/// Why a value was not used.
enum class Skip {
  kOdometryOutOfOrder,
  kOdometryAhead,   ///< by more than any pause, or of the odometry that followed it
  kClockSet,        ///< what waits is dropped, motion goes on
  kOdometryJumped,  ///< used as a new beginning, its jump is not
  kOdometryStuck,   ///< stood still or jumped about, and then said at once what was driven
  kScanOutOfOrder,
  kScanAhead,           ///< of odometry by far, or of the scans that followed it
  kScanWithoutReturns,  ///< odometry and camera are
  kScanRepeated,        ///< range for range one from elsewhere: the LiDAR is stuck
  kScanBeforeOdometry,
  kScanWithoutOdometry,  ///< the input ended before the odometry for it came
  kScanOverflow,         ///< odometry stays away
  kFrameOutOfOrder,
  kFrameAhead,            ///< of odometry by far, or of the frames that followed it
  kFrameWithoutOdometry,  ///< it has been forgotten, or begins later
  kFrameOverflow,
  kFrameRepeated,  ///< pixel for pixel the one before: the camera is stuck, or nothing moves
  kMarkerImplausible,
  kMarkerUncertain,
};

std::string_view to_string(Skip skip);

/// A scan becomes an observation when odometry covers it and the camera frames up to its time have
/// come (or marker_wait of odometry has passed without them). While the LiDAR is silent, so that
/// scan_wait of odometry has passed without a scan, odometry and camera make observations of their
/// own. So the result depends on the values and not on how they were grouped on their way.
///
/// A value that is stamped wrong costs itself: what it leads or lags behind is judged by the values
/// of its own sensor that follow it. Only when the clock was set do all stamps count anew.
class SensorQueue {
 public:
  explicit SensorQueue(const SensorSetup& setup) : setup_{setup} {}

  void add(const OdometrySample& sample);
  void add(LidarScan scan);
  void add(MarkerDetections frame);
  /// No more values will come: stop waiting for them.
  void finish();

  /// The next observation that is ready; call until there is none.
  struct Ready {
    Observation observation{};
    std::optional<LidarScan> scan{};  ///< nothing while the LiDAR is silent
  };

  std::optional<Ready> next();

  /// What was skipped since the last call, in order.
  std::vector<Skip> take_skips();

 private:
  void take(const OdometrySample& sample);
  bool leads(const OdometrySample& sample) const;
  bool shows_first_was_ahead(const OdometrySample& sample) const;
  Timestamp newest_odometry() const;
  void note(OdometryBuffer::Outcome outcome);
  void skip(Skip reason, std::size_t times = 1);
  void set_clock();
  void drop_what_is_ahead();
  bool is_ahead(Timestamp time) const;
  void line_up(LidarScan scan);
  void line_up(MarkerDetections frame);
  bool is_ready(const LidarScan& scan) const;
  bool has_passed(Timestamp time) const;
  bool scan_is_due() const;
  std::optional<Timestamp> next_without_scan() const;
  bool repeats_one_from_elsewhere(const LidarScan& scan, const Motion& motion);
  Observation observation_at(Timestamp time, std::span<const Beam> beams);
  Observation observe(Timestamp time, std::span<const Beam> beams);
  std::optional<FocalSighting> focal_sighting(const MarkerDetection& detection) const;
  void sight_markers(const MarkerDetections& frame, Timestamp time,
                     std::vector<MarkerSighting>& sightings);

  static constexpr Duration kLongestStep{500'000};
  static constexpr std::size_t kMaxScans = 100;
  static constexpr std::size_t kMaxFrames = 200;

  SensorSetup setup_;
  OdometryBuffer odometry_{};
  ClockWatch clock_watch_{};
  Duration usual_step_{kLongestStep};  ///< of odometry, twice as long may be usual, too
  std::optional<OdometrySample> leading_odometry_{};  ///< after a longer one, until the next comes
  WaitingLine<LidarScan> scans_{};
  WaitingLine<MarkerDetections> frames_{};
  std::vector<MarkerDetection> newest_detections_{};
  std::vector<double> newest_ranges_m_{};
  Motion since_new_ranges_{};
  std::optional<Timestamp> last_observed_{};
  std::vector<Skip> skips_{};
  bool has_finished_{false};
};

}  // namespace waymark
