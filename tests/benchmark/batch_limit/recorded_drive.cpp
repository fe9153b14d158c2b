// SPDX-License-Identifier: BSD-3-Clause
#include "batch_limit/recorded_drive.hpp"

#include "benchmark/deliver.hpp"
#include "common/log/log_file.hpp"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace waymark::benchmark {
namespace {

constexpr double kSamePlace_m = 0.3;
constexpr double kNoWall = 1e3;  // [m, rad]: nothing is held to a wall that vague

/// What the camera alone says of the markers that the walls do not contradict: a batch knows the
/// walls better than one scan does.
std::vector<MarkerMeasurement> camera_measurements(const Observation& observation,
                                                   const EstimatorSetup& setup,
                                                   const MarkerMeasurementConfig& config) {
  MarkerSensors sensors{setup.range_sigma_m, setup.camera.base_from_camera, setup.sighting_noise};
  const auto estimated = measure_markers(observation, sensors, {}, config);
  sensors.sigmas.bulge_m = kNoWall;
  sensors.sigmas.skew_rad = kNoWall;
  auto measured = measure_markers(observation, sensors, {}, config);
  std::erase_if(measured, [&](const MarkerMeasurement& one) {
    return std::ranges::none_of(estimated, [&](const MarkerMeasurement& other) {
      return one.id == other.id &&
             (one.base_from_marker.translation() - other.base_from_marker.translation()).norm() <
                 kSamePlace_m;
    });
  });
  return measured;
}

/// Makes stops of observations; keeps those out that come too soon after the last stop.
class StopCollector {
 public:
  explicit StopCollector(const SlamConfig& config)
      : waymark_{config.slam.waymark}, setup_{estimator_setup(config)} {
    noise_ = {setup_.range_sigma_m, waymark_.scan.roughness_m, setup_.range_max_m};
  }

  void add(const Observation& observation) {
    since_stop_ = since_stop_.then(observation.motion);
    newest_ = observation;
    if (stops_.empty() || since_stop_.distance_m >= kStopDistance_m ||
        since_stop_.turn_rad >= kStopTurn_rad)
      stop();
  }

  std::vector<Stop> finish() {
    if (newest_ && stops_.back().time < newest_->time) stop();
    return std::move(stops_);
  }

 private:
  void stop() {
    stops_.push_back({newest_->time, since_stop_, wall_lines(newest_->beams, noise_),
                      camera_measurements(*newest_, setup_, waymark_.markers)});
    since_stop_ = {};
  }

  WaymarkConfig waymark_;
  EstimatorSetup setup_;
  LineNoise noise_{};
  std::optional<Observation> newest_{};
  Motion since_stop_{};
  std::vector<Stop> stops_{};
};

}  // namespace

RecordedDrive recorded_drive(const std::filesystem::path& log, const SlamConfig& config) {
  LogReader reader{log};
  SensorQueue queue{sensor_setup(config)};
  StopCollector collector{config};
  const auto is_wanted = [](std::string_view channel) {
    return channel == channels::kLidar.name || channel == channels::kOdometry.name ||
           channel == channels::kMarkers.name;
  };
  const auto take_ready = [&] {
    while (const auto ready = queue.next())
      collector.add(ready->observation);
  };
  while (const auto message = reader.next(is_wanted)) {
    deliver(*message, queue);
    take_ready();
  }
  queue.finish();
  take_ready();
  RecordedDrive drive{collector.finish(), reader.skipped_bytes()};
  if (drive.stops.empty())
    throw std::runtime_error{log.string() +
                             ": no LIDAR scan with ODOMETRY around it; is this the "
                             "log of a run?"};
  return drive;
}

}  // namespace waymark::benchmark
