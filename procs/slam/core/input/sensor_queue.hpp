// SPDX-License-Identifier: BSD-3-Clause
// Combines three streams of sensor values into observations, in whatever order they arrive.
#pragma once

#include "slam/core/input/odometry_stream.hpp"
#include "slam/core/input/preprocessing.hpp"
#include "slam/core/input/skip.hpp"
#include "slam/core/input/stamped_queue.hpp"
#include "slam/core/scan/observation.hpp"

#include <optional>
#include <span>
#include <vector>

namespace waymark {

/// Description of the sensors.
struct SensorSetup {
  LidarSetup lidar{};
  CameraView camera{};
  double marker_size_m{0.4};
  Preprocessing preprocessing{};
  bool blank_ids{false};  ///< control experiment: ignore all markers
};

/// A scan becomes an observation when odometry covers it and the camera frames up to its time have
/// arrived, or when marker_wait_s of odometry has passed without them. When scan_wait_s of odometry
/// has passed without a scan, the LiDAR is silent, and odometry and camera alone make observations.
/// So the result depends on the values only, and not on how they are interleaved.
///
/// A wrong stamp affects its own value only: the next values of the same sensor decide whether a
/// value that is ahead or late is wrong. After a step of the clock, waiting scans and frames are
/// dropped; odometry continues.
class SensorQueue {
 public:
  explicit SensorQueue(const SensorSetup& setup);

  void add(const OdometrySample& sample);
  void add(LidarScan scan);
  void add(MarkerDetections frame);
  /// To be called after the last value: next() stops waiting.
  void finish();

  struct Ready {
    Observation observation{};
    std::optional<LidarScan> scan{};  ///< none while the LiDAR is silent
  };

  /// The next observation that is ready; call until there is none.
  std::optional<Ready> next();

  /// Why values were skipped since the last call, in order.
  std::vector<Skip> take_skips() { return skips_.take(); }

 private:
  bool is_ready(const LidarScan& scan) const;
  bool scan_is_due() const;
  std::optional<Ready> ready_from(LidarScan scan);
  std::optional<Timestamp> next_without_scan() const;
  bool repeats_one_from_elsewhere(const LidarScan& scan, const Motion& motion);
  bool repeats_the_one_before(const MarkerDetections& frame);
  Observation observation_at(Timestamp time, std::span<const Beam> beams);
  void add_motion(Timestamp time, Observation& observation) const;
  void add_frames(Timestamp time, Observation& observation);
  void add_sightings(const MarkerDetections& frame, Timestamp time,
                     std::vector<MarkerSighting>& sightings);

  SensorSetup setup_;
  Duration marker_wait_;
  Duration scan_wait_;
  OdometryStream odometry_{};
  StampedQueue<LidarScan> scans_;
  StampedQueue<MarkerDetections> frames_;
  std::vector<MarkerDetection> newest_detections_{};
  std::vector<double> newest_ranges_m_{};
  Motion since_new_ranges_{};  ///< motion since the ranges last changed
  std::optional<Timestamp> last_observed_{};
  Duration clock_set_{};  ///< since the last observation
  Skips skips_{};
  bool has_finished_{false};
};

}  // namespace waymark
