// SPDX-License-Identifier: BSD-3-Clause
#include "import/mbot_reader.hpp"

#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "common/node/node.hpp"
#include "import/time_order.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

namespace waymark {
namespace {

constexpr int kMaxBeams = 4000;                 // as robot.lidar.num_beams
constexpr std::int64_t kEventHeaderBytes = 28;  // of LCM's log format

class MbotReader {
 public:
  MbotReader(const MbotOptions& options, ImportReport& report)
      : options_{options}, report_{report} {}

  void take(const Message& event, std::int64_t at);
  void take_garbage(std::int64_t num_bytes, std::int64_t end);
  ImportedLog finish();

 private:
  void take_lidar(const Message& event, std::int64_t at);
  void take_rotating(const lidar_t& scan, const Message& event, std::int64_t at);
  void take_planar(planar_lidar_t scan, std::int64_t at);
  void take_pose(const Message& event, std::int64_t at, std::vector<ImportedPose>& poses);
  void take_encoders(const Message& event, std::int64_t at);
  bool ranges_are_good(std::span<const float> ranges, const std::string& channel, std::int64_t at);

  void skip(const LineProblem& problem, const std::string& channel, std::int64_t at) {
    report_.skip(problem.kind, at, channel + ": " + problem.detail);
  }

  const MbotOptions& options_;
  ImportReport& report_;
  ImportedLog log_{};
  std::vector<EncoderTicks> ticks_{};
  bool has_planar_scans_{false};
  std::map<std::string, std::int64_t> events_by_channel_{};
};

void MbotReader::take(const Message& event, std::int64_t at) {
  ++events_by_channel_[event.channel];
  if (event.channel == options_.lidar_channel) take_lidar(event, at);
  if (event.channel == options_.odometry_channel) take_pose(event, at, log_.odometry);
  if (event.channel == options_.encoder_channel) take_encoders(event, at);
  if (event.channel == options_.reference_channel) take_pose(event, at, log_.reference);
}

void MbotReader::take_garbage(std::int64_t num_bytes, std::int64_t end) {
  report_.skip("no LCM event", end - num_bytes, fmt::format("{} bytes", num_bytes));
}

void MbotReader::take_lidar(const Message& event, std::int64_t at) {
  const std::int64_t fingerprint = fingerprint_of(event.payload);
  RejectReason reason = RejectReason::kNone;
  if (fingerprint == lidar_t::getHash()) {
    const Decoded<lidar_t> decoded = decode<lidar_t>(event.payload);
    if (decoded.message) return take_rotating(*decoded.message, event, at);
    reason = decoded.reason;
  } else if (fingerprint == planar_lidar_t::getHash()) {
    Decoded<planar_lidar_t> decoded = decode<planar_lidar_t>(event.payload);
    if (decoded.message) return take_planar(std::move(*decoded.message), at);
    reason = decoded.reason;
  } else {
    return skip(unknown_type(event.payload), event.channel, at);
  }
  skip({"bad scan message", std::string{to_string(reason)}}, event.channel, at);
}

bool MbotReader::ranges_are_good(std::span<const float> ranges, const std::string& channel,
                                 std::int64_t at) {
  if (ranges.size() > kMaxBeams) {
    skip({"too many beams", fmt::format("{}", ranges.size())}, channel, at);
    return false;
  }
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    if (ranges[i] >= 0.0F || std::isnan(ranges[i])) continue;  // NaN = not measured (REP-117)
    skip({"negative range", fmt::format("range {} of {} is {}", i, ranges.size(), ranges[i])},
         channel, at);
    return false;
  }
  return true;
}

void MbotReader::take_rotating(const lidar_t& scan, const Message& event, std::int64_t at) {
  if (!ranges_are_good(scan.ranges, event.channel, at)) return;
  double longest_m = 0.0;
  for (const float range_m : scan.ranges) {
    if (std::isfinite(range_m)) longest_m = std::max(longest_m, double{range_m});
  }
  const Timestamp time = timestamp_from_us(scan.utime);
  const Timestamp last = timestamp_from_us(std::max(scan.utime, std::ranges::max(scan.times)));
  const Message message{std::string{channels::kMbotLidar.name}, time, event.payload};
  log_.scans.push_back({time, last, at, scan.num_ranges, longest_m, message, {}});
}

void MbotReader::take_planar(planar_lidar_t scan, std::int64_t at) {
  if (!ranges_are_good(scan.ranges, options_.lidar_channel, at)) return;
  has_planar_scans_ = true;
  double longest_m = 0.0;
  for (float& range_m : scan.ranges) {
    if (double{range_m} >= options_.range_max_m) range_m = std::numeric_limits<float>::infinity();
    if (range_m == 0.0F) range_m = std::numeric_limits<float>::quiet_NaN();
    if (std::isfinite(range_m)) longest_m = std::max(longest_m, double{range_m});
  }
  const Timestamp time = timestamp_from_us(scan.utime);
  log_.scans.push_back(
      {time, time, at, scan.nranges, longest_m, encode(channels::kLidar, scan), {}});
}

void MbotReader::take_pose(const Message& event, std::int64_t at,
                           std::vector<ImportedPose>& poses) {
  const PoseResult result = read_pose(event.payload);
  if (const auto* problem = std::get_if<LineProblem>(&result)) {
    return skip(*problem, event.channel, at);
  }
  const auto& [time, pose] = std::get<ForeignPose>(result);
  poses.push_back({time, at, pose});
}

void MbotReader::take_encoders(const Message& event, std::int64_t at) {
  const EncoderResult result = read_encoders(event.payload);
  if (const auto* problem = std::get_if<LineProblem>(&result)) {
    return skip(*problem, event.channel, at);
  }
  ticks_.push_back(std::get<EncoderTicks>(result));
  ticks_.back().at = at;
}

ImportedLog MbotReader::finish() {
  for (const auto& [channel, count] : events_by_channel_) {
    log_.contents += fmt::format("{}{} {}", log_.contents.empty() ? "" : ", ", channel, count);
  }
  if (log_.contents.empty()) throw SetupError{"the file holds no LCM event"};
  for (const std::string& channel : {options_.lidar_channel, options_.odometry_channel,
                                     options_.encoder_channel, options_.reference_channel}) {
    if (channel.empty() || events_by_channel_.contains(channel)) continue;
    throw SetupError{
        fmt::format("there is no channel {} in the log; it holds {}", channel, log_.contents)};
  }
  if (!ticks_.empty()) {
    keep_ascending(ticks_, "an encoder reading", report_);
    log_.odometry = wheel_odometry(ticks_, options_.wheels, report_);
    log_.robot.base.wheel_separation_m = options_.wheels.wheel_base_m;
  }
  // A rotating LiDAR has a few beams more or less in each turn; evenly spaced ones have not.
  if (has_planar_scans_) keep_usual_beam_count(log_.scans, report_);
  LidarConfig& lidar = log_.robot.lidar;
  lidar.range_min_m = options_.range_min_m;
  lidar.range_max_m = options_.range_max_m;
  lidar.x_m = options_.mounting.x_m.value_or(0.0);
  lidar.y_m = options_.mounting.y_m.value_or(0.0);
  lidar.yaw_rad = options_.mounting.yaw_rad.value_or(0.0);
  complete(log_, report_);
  return std::move(log_);
}

LogReader open_log(const std::filesystem::path& file) {
  try {
    LogReader log{file};
    if (log.size_bytes() == 0) throw SetupError{file.string() + ": is empty"};
    return log;
  } catch (const SetupError&) {
    throw;
  } catch (const std::exception& error) {
    throw SetupError{error.what()};
  }
}

}  // namespace

ImportedLog read_mbot_log(const std::filesystem::path& file, const MbotOptions& options,
                          ImportReport& report) {
  if (options.odometry_channel.empty() == options.encoder_channel.empty()) {
    throw SetupError{"give either --odometry-channel or --encoder-channel"};
  }
  LogReader log = open_log(file);
  MbotReader reader{options, report};
  std::int64_t garbage_bytes = 0;
  while (const auto event = log.next()) {
    const std::int64_t at =
        log.offset_bytes() - kEventHeaderBytes -
        static_cast<std::int64_t>(event->channel.size() + event->payload.size());
    if (log.skipped_bytes() > garbage_bytes) {
      reader.take_garbage(log.skipped_bytes() - garbage_bytes, at);
      garbage_bytes = log.skipped_bytes();
    }
    reader.take(*event, at);
  }
  if (log.skipped_bytes() > garbage_bytes) {
    reader.take_garbage(log.skipped_bytes() - garbage_bytes, log.size_bytes());
  }
  return reader.finish();
}

}  // namespace waymark
