// SPDX-License-Identifier: BSD-3-Clause
#include "import/mbot/mbot_reader.hpp"

#include "common/errors/setup_error.hpp"
#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "import/findings/no_return.hpp"
#include "import/log/time_order.hpp"
#include "import/mbot/clocks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <ranges>
#include <set>
#include <span>
#include <utility>

namespace waymark {
namespace {

constexpr int kMaxBeams = 4000;                 // limit of robot.lidar.num_beams
constexpr double kRplidarRangeMax_m = 6.0;      // RPLIDAR A1
constexpr std::int64_t kEventHeaderBytes = 28;  // in LCM's log format

class MbotReader {
 public:
  MbotReader(const MbotOptions& options, ImportReport& report)
      : options_{options}, report_{report} {}

  void add(const Message& event, std::int64_t at);
  void note_garbage(std::int64_t num_bytes, std::int64_t end);
  ImportedLog finish();

 private:
  void check_channels();
  void apply_ticks();
  std::optional<double> usual_range_max_m() const;
  void add_lidar(const Message& event, std::int64_t at);
  void add_rotating(const lidar_t& scan, const Message& event, std::int64_t at);
  void add_planar(const planar_lidar_t& scan, const Message& event, std::int64_t at);
  void add_pose(const Message& event, std::int64_t at, std::vector<ImportedPose>& poses,
                ChannelClock& clock);
  void add_encoders(const Message& event, std::int64_t at);
  void add_image(const Message& event, std::int64_t at);
  void describe_camera();
  bool ranges_are_good(std::span<const float> ranges, const std::string& channel, std::int64_t at);

  void skip(const LineProblem& problem, const std::string& channel, std::int64_t at) {
    report_.skip(problem.kind, at, channel + ": " + problem.detail);
  }

  const MbotOptions& options_;
  ImportReport& report_;
  ImportedLog log_{};
  std::vector<EncoderTicks> ticks_{};
  ChannelClock lidar_clock_{};
  ChannelClock odometry_clock_{};
  ChannelClock reference_clock_{};
  ChannelClock camera_clock_{};
  std::int64_t num_foreign_images_{0};  ///< messages on CAMERA that are no image_t
  bool has_planar_scans_{false};
  std::map<std::string, std::int64_t> events_by_channel_{};
};

void MbotReader::add(const Message& event, std::int64_t at) {
  ++events_by_channel_[event.channel];
  if (event.channel == options_.lidar_channel) add_lidar(event, at);
  if (event.channel == options_.odometry_channel)
    add_pose(event, at, log_.odometry, odometry_clock_);
  if (event.channel == options_.encoder_channel) add_encoders(event, at);
  if (event.channel == (options_.camera_channel.empty() ? std::string{channels::kCamera.name}
                                                        : options_.camera_channel))
    add_image(event, at);
  if (event.channel == options_.reference_channel)
    add_pose(event, at, log_.reference, reference_clock_);
}

void MbotReader::note_garbage(std::int64_t num_bytes, std::int64_t end) {
  report_.skip("no LCM event", end - num_bytes, fmt::format("{} bytes", num_bytes));
}

void MbotReader::add_lidar(const Message& event, std::int64_t at) {
  const std::int64_t fingerprint = fingerprint_of(event.payload);
  RejectReason reason = RejectReason::kNone;
  if (fingerprint == lidar_t::getHash()) {
    const Decoded<lidar_t> decoded = decode<lidar_t>(event.payload);
    if (decoded.message) return add_rotating(*decoded.message, event, at);
    reason = decoded.reason;
  } else if (fingerprint == planar_lidar_t::getHash()) {
    const Decoded<planar_lidar_t> decoded = decode<planar_lidar_t>(event.payload);
    if (decoded.message) return add_planar(*decoded.message, event, at);
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

void MbotReader::add_rotating(const lidar_t& scan, const Message& event, std::int64_t at) {
  if (!ranges_are_good(scan.ranges, event.channel, at)) return;
  const Timestamp time = timestamp_from_us(scan.utime);
  const Timestamp last = timestamp_from_us(std::max(scan.utime, std::ranges::max(scan.times)));
  lidar_clock_.add(time, event.time);
  const Message message{std::string{channels::kMbotLidar.name}, time, event.payload};
  log_.scans.push_back({time, last, at, scan.num_ranges, 0.0, message, {}});
}

void MbotReader::add_planar(const planar_lidar_t& scan, const Message& event, std::int64_t at) {
  if (!ranges_are_good(scan.ranges, event.channel, at)) return;
  has_planar_scans_ = true;
  const Timestamp time = timestamp_from_us(scan.utime);
  lidar_clock_.add(time, event.time);
  log_.scans.push_back({time, time, at, scan.nranges, 0.0, encode(channels::kLidar, scan), {}});
}

void MbotReader::add_pose(const Message& event, std::int64_t at, std::vector<ImportedPose>& poses,
                          ChannelClock& clock) {
  const PoseResult result = read_pose(event.payload);
  if (const auto* problem = std::get_if<LineProblem>(&result)) {
    return skip(*problem, event.channel, at);
  }
  const auto& [time, pose] = std::get<ForeignPose>(result);
  poses.push_back({time, at, pose});
  clock.add(time, event.time);
}

void MbotReader::add_encoders(const Message& event, std::int64_t at) {
  const EncoderResult result = read_encoders(event.payload);
  if (const auto* problem = std::get_if<LineProblem>(&result)) {
    return skip(*problem, event.channel, at);
  }
  ticks_.push_back(std::get<EncoderTicks>(result));
  ticks_.back().at = at;
  odometry_clock_.add(ticks_.back().time, event.time);
}

void MbotReader::add_image(const Message& event, std::int64_t at) {
  if (fingerprint_of(event.payload) != image_t::getHash()) {
    if (!options_.camera_channel.empty())
      return skip(unknown_type(event.payload), event.channel, at);
    ++num_foreign_images_;
    return;
  }
  const Decoded<image_t> decoded = decode<image_t>(event.payload);
  if (!decoded.message)
    return skip({"bad image message", std::string{to_string(decoded.reason)}}, event.channel, at);
  const Timestamp time = timestamp_from_us(decoded.message->utime);
  camera_clock_.add(time, event.time);
  log_.images.push_back({time, at, encode(channels::kCamera, *decoded.message)});
}

void MbotReader::describe_camera() {
  if (num_foreign_images_ > 0) {
    report_.note(fmt::format("{} messages of {} are no image_t: they are not taken over",
                             num_foreign_images_, channels::kCamera.name));
  }
  if (log_.images.empty()) return;
  const auto image = decode<image_t>(log_.images.front().message.payload).message;
  log_.robot.camera.width_px = image->width;
  log_.robot.camera.height_px = image->height;
  report_.note(
      "the log does not say what lens the camera has, nor where it sits: [robot.camera] in "
      "robot.toml has the values of another one; put yours there (docs/robot.md)");
}

void MbotReader::check_channels() {
  for (const auto& [channel, count] : events_by_channel_) {
    log_.contents += fmt::format("{}{} {}", log_.contents.empty() ? "" : ", ", channel, count);
  }
  if (log_.contents.empty()) throw SetupError{"the file holds no LCM event"};
  const std::array<std::pair<std::string_view, std::string_view>, 5> wanted{
      {{"--lidar-channel", options_.lidar_channel},
       {"--camera-channel", options_.camera_channel},
       {"--odometry-channel", options_.odometry_channel},
       {"--encoder-channel", options_.encoder_channel},
       {"--reference-channel", options_.reference_channel}}};
  for (const auto& [option, channel] : wanted) {
    if (channel.empty() || events_by_channel_.contains(std::string{channel})) continue;
    throw SetupError{fmt::format("there is no channel {} in the log; it holds {}: give {}", channel,
                                 log_.contents, option)};
  }
}

void MbotReader::apply_ticks() {
  if (ticks_.empty()) return;
  restore_order(ticks_, "encoder reading", report_);
  keep_ascending(ticks_, "an encoder reading", report_);
  WheelGeometry wheels = geometry_of(ticks_.front().robot_model);
  wheels.meters_per_tick = options_.meters_per_tick.value_or(wheels.meters_per_tick);
  wheels.wheel_base_m = options_.wheel_base_m.value_or(wheels.wheel_base_m);
  log_.odometry = wheel_odometry(ticks_, wheels, report_);
  log_.robot.base.wheel_separation_m = wheels.wheel_base_m;
}

/// Range limit of the usual LiDAR (RPLIDAR A1); nullopt if some range is longer, or the log has
/// planar_lidar_t scans.
std::optional<double> MbotReader::usual_range_max_m() const {
  if (has_planar_scans_) return std::nullopt;
  double longest_m = 0.0;
  for (const ImportedScan& scan : log_.scans) {
    for (const double range_m : scan_of(scan).ranges_m) {
      if (std::isfinite(range_m)) longest_m = std::max(longest_m, range_m);
    }
  }
  return longest_m <= kRplidarRangeMax_m ? std::optional{kRplidarRangeMax_m} : std::nullopt;
}

ImportedLog MbotReader::finish() {
  check_channels();
  apply_ticks();
  log_.odometry_shift =
      put_on_clock(lidar_clock_, odometry_clock_, "odometry", log_.odometry, report_);
  put_on_clock(lidar_clock_, reference_clock_, "reference", log_.reference, report_);
  log_.images_shift = put_on_clock(lidar_clock_, camera_clock_, log_.images, report_);
  describe_camera();
  // Turns of a rotating LiDAR (lidar_t) differ by a few beams; planar_lidar_t scans do not.
  if (has_planar_scans_) keep_usual_beam_count(log_.scans, report_);
  LidarConfig& lidar = log_.robot.lidar;
  lidar.range_min_m = options_.range_min_m;
  lidar.x_m = options_.mounting.x_m.value_or(0.0);
  lidar.y_m = options_.mounting.y_m.value_or(0.0);
  lidar.yaw_rad = options_.mounting.yaw_rad.value_or(0.0);
  make_consistent(log_, report_);
  mark_no_returns(log_, {options_.range_max_m, usual_range_max_m()}, report_);
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

/// Channels that may hold the odometry, if the user names none.
struct Candidates {
  std::map<std::string, std::int64_t> channels{};
  std::set<std::string> ticks{};
  std::set<std::string> poses{};
};

Candidates find_candidates(LogReader log) {
  Candidates found;
  while (const auto event = log.next()) {
    ++found.channels[event->channel];
    const ForeignKind kind = kind_of(event->payload);
    if (kind == ForeignKind::kTicks) found.ticks.insert(event->channel);
    if (kind == ForeignKind::kPose) found.poses.insert(event->channel);
  }
  return found;
}

/// The only channel with ticks. Pose channels are not chosen, only listed in the error: they may be
/// another program's estimates.
std::string choose_encoder_channel(const std::filesystem::path& file, ImportReport& report) {
  const Candidates found = find_candidates(open_log(file));
  if (found.channels.empty()) throw SetupError{"the file holds no LCM event"};
  if (found.ticks.size() == 1) {
    report.note(
        fmt::format("odometry is taken from the encoder ticks of {}, the only ones; "
                    "--odometry-channel or --encoder-channel says otherwise",
                    *found.ticks.begin()));
    return *found.ticks.begin();
  }
  if (found.ticks.empty() && found.poses.empty()) {
    throw SetupError{fmt::format(
        "the log has no odometry: none of its channels ({}) has poses or encoder ticks that are "
        "known here",
        fmt::join(found.channels | std::views::keys, ", "))};
  }
  throw SetupError{fmt::format(
      "give --odometry-channel or --encoder-channel: there are poses in {}, encoder ticks in {}",
      found.poses.empty() ? "none" : fmt::format("{}", fmt::join(found.poses, ", ")),
      found.ticks.empty() ? "none" : fmt::format("{}", fmt::join(found.ticks, ", ")))};
}

}  // namespace

ImportedLog read_mbot_log(const std::filesystem::path& file, const MbotOptions& options,
                          ImportReport& report) {
  if (!options.odometry_channel.empty() && !options.encoder_channel.empty())
    throw SetupError{"give either --odometry-channel or --encoder-channel"};
  MbotOptions chosen = options;
  if (options.odometry_channel.empty() && options.encoder_channel.empty())
    chosen.encoder_channel = choose_encoder_channel(file, report);
  LogReader log = open_log(file);
  MbotReader reader{chosen, report};
  std::int64_t garbage_bytes = 0;
  while (const auto event = log.next()) {
    const std::int64_t at =
        log.offset_bytes() - kEventHeaderBytes -
        static_cast<std::int64_t>(event->channel.size() + event->payload.size());
    if (log.skipped_bytes() > garbage_bytes) {
      reader.note_garbage(log.skipped_bytes() - garbage_bytes, at);
      garbage_bytes = log.skipped_bytes();
    }
    reader.add(*event, at);
  }
  if (log.skipped_bytes() > garbage_bytes) {
    reader.note_garbage(log.skipped_bytes() - garbage_bytes, log.size_bytes());
  }
  return reader.finish();
}

}  // namespace waymark
