// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/doctor_input.hpp"

#include "common/errors/setup_error.hpp"
#include "common/log/log_file.hpp"
#include "common/markers/marker_dictionary.hpp"
#include "common/messages/codec.hpp"
#include "import/carmen/carmen_reader.hpp"
#include "import/findings/range_noise.hpp"
#include "import/mbot/foreign_messages.hpp"
#include "import/mbot/mbot_reader.hpp"
#include "import/rosbag/bag.hpp"
#include "import/rosbag/rosbag_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <fstream>
#include <ranges>
#include <set>

namespace waymark {
namespace {

constexpr std::size_t kScansForNoise = 1000;
constexpr double kClockStep_s = 10.0;  // between consecutive records of a log, of any channel

bool is_lcm_log(const std::filesystem::path& file) {
  constexpr std::array<char, 4> kMagic{'\xED', '\xA1', '\xDA', '\x01'};
  std::array<char, 4> start{};
  std::ifstream stream{file, std::ios::binary};
  stream.read(start.data(), start.size());
  return stream && start == kMagic;
}

struct Contents {
  std::map<std::string, ChannelTraffic> channels{};
  std::set<std::string> lidars{};
  double duration_s{0.0};
};

/// Time between consecutive records; 0 where the recorder's clock was set.
double time_between_s(Timestamp before, Timestamp after) {
  const double gap_s = to_seconds(after - before);
  return gap_s > 0.0 && gap_s < kClockStep_s ? gap_s : 0.0;
}

Contents contents_of(const std::filesystem::path& file) {
  Contents contents;
  LogReader reader{file};
  std::optional<Timestamp> last;
  while (const auto event = reader.next()) {
    contents.duration_s += time_between_s(last.value_or(event->time), event->time);
    last = event->time;
    ChannelTraffic& traffic = contents.channels[event->channel];
    if (traffic.messages == 0) traffic.first_s = contents.duration_s;
    traffic.last_s = contents.duration_s;
    const auto bytes = static_cast<std::int64_t>(event->payload.size());
    ++traffic.messages;
    traffic.bytes += bytes;
    traffic.largest_bytes = std::max(traffic.largest_bytes, bytes);
    const std::int64_t type = fingerprint_of(event->payload);
    if (type == lidar_t::getHash() || type == planar_lidar_t::getHash())
      contents.lidars.insert(event->channel);
  }
  return contents;
}

std::string names_of(const Contents& contents) {
  if (contents.channels.empty()) return "no channel";
  return fmt::format("{}", fmt::join(contents.channels | std::views::keys, ", "));
}

MbotOptions choose(const Contents& contents, const InputChannels& wanted) {
  MbotOptions options{};
  options.lidar_channel = wanted.lidar;
  options.odometry_channel = wanted.odometry;
  options.encoder_channel = wanted.encoders;
  if (wanted.lidar.empty()) {
    if (contents.lidars.empty()) {
      throw SetupError{fmt::format(
          "no channel has LiDAR scans (lidar_t or planar_lidar_t); the log has {}: did the LiDAR's "
          "driver run while it was recorded?",
          names_of(contents))};
    }
    if (contents.lidars.size() > 1) {
      throw SetupError{fmt::format("{} channels have LiDAR scans ({}): give --lidar-channel",
                                   contents.lidars.size(), fmt::join(contents.lidars, ", "))};
    }
    options.lidar_channel = *contents.lidars.begin();
  }
  const std::string ours{channels::kOdometry.name};
  if (wanted.odometry.empty() && wanted.encoders.empty() && contents.channels.contains(ours))
    options.odometry_channel = ours;
  return options;
}

ImportedLog read_log(const std::filesystem::path& file, const Contents& contents,
                     const MbotOptions& options, ImportReport& report) {
  try {
    return read_mbot_log(file, options, report);
  } catch (const SetupError& error) {
    const bool was_chosen = !options.odometry_channel.empty() || !options.encoder_channel.empty();
    if (was_chosen) throw;
    throw SetupError{fmt::format(
        "the log has no {}, but {}: did the driver of odometry run while it was recorded? If "
        "another channel has it, {}",
        channels::kOdometry.name, names_of(contents), error.what())};
  }
}

/// A recorder that was killed leaves its log under another name.
void check_is_there(const std::filesystem::path& file) {
  const std::filesystem::path part = part_path_of(file);
  if (std::filesystem::exists(file) || !std::filesystem::exists(part)) return;
  throw SetupError{fmt::format(
      "{}: there is no such file, but '{}': its recorder runs still, or was killed; give that one, "
      "which is complete up to the last seconds",
      file.string(), part.string())};
}

ImportedLog read_as_carmen(const std::filesystem::path& file, ImportReport& report) {
  try {
    return read_carmen_log(file, {}, report);
  } catch (const NotACarmenLog&) {
    throw SetupError{file.string() +
                     ": is no log: neither an LCM log nor a bag of ROS, and no line begins with a "
                     "keyword of CARMEN's logs"};
  }
}

void estimate_noise(DoctorInput& input) {
  ImportedLog& log = input.log;
  WallScatter scatter;
  const std::size_t every = 1 + log.scans.size() / kScansForNoise;
  for (std::size_t i = 0; i < log.scans.size(); i += every)
    scatter.add(scan_of(log.scans[i]));
  const auto sigma_m = scatter.sigma_m();
  input.noise_is_estimated = sigma_m.has_value();
  log.robot.lidar.range_sigma_m = sigma_m.value_or(log.robot.lidar.range_sigma_m);
}

}  // namespace

Silence silence_of(const DoctorInput& input, const std::string& channel) {
  const auto traffic = input.channels.find(channel);
  if (traffic == input.channels.end()) return {};
  return {traffic->second.first_s, input.recorded_s - traffic->second.last_s};
}

DoctorInput read_input(const std::filesystem::path& file,
                       const std::vector<std::filesystem::path>& robot, const InputChannels& wanted,
                       const ShowProgress& progress) {
  check_is_there(file);
  DoctorInput input{.report = {file, AddressUnit::kByte}, .mounting = Mounting::kInLog};
  if (is_lcm_log(file)) {
    const Contents contents = contents_of(file);
    const MbotOptions options = choose(contents, wanted);
    input.channels = contents.channels;
    input.recorded_s = contents.duration_s;
    input.lidar_channel = options.lidar_channel;
    input.odometry_channel =
        options.odometry_channel.empty() ? options.encoder_channel : options.odometry_channel;
    input.log = read_log(file, contents, options, input.report);
    input.mounting = Mounting::kUnknown;
  } else if (is_bag(file)) {
    input.log = read_rosbag(file, {.without_images = true}, input.report);
  } else {
    input.report.set_address_unit(AddressUnit::kLine);
    input.log = read_as_carmen(file, input.report);
  }
  std::vector<std::filesystem::path> descriptions = robot;
  if (descriptions.empty() && std::filesystem::exists(file.parent_path() / "robot.toml"))
    descriptions.push_back(file.parent_path() / "robot.toml");
  if (!descriptions.empty()) {
    input.described = load_config<RobotOnly>({descriptions, {}}).robot;
    input.mounting = Mounting::kDescribed;
    const std::string& dictionary = input.described->markers.dictionary;
    if (!find_dictionary(dictionary)) {
      throw SetupError{fmt::format("{}: robot.markers.dictionary: there is no '{}'; known are {}",
                                   descriptions.back().string(), dictionary,
                                   fmt::join(dictionary_names(), ", "))};
    }
    LidarConfig& lidar = input.log.robot.lidar;
    lidar.x_m = input.described->lidar.x_m;
    lidar.y_m = input.described->lidar.y_m;
    lidar.yaw_rad = input.described->lidar.yaw_rad;
    for (ImportedScan& scan : input.log.scans)
      correct(scan, input.described->lidar.mirrored,
              duration_from_seconds(input.described->lidar.late_s));
    if (input.channels.contains(std::string{channels::kCamera.name})) {
      input.camera = read_camera(file, *input.described, progress);
    } else if (input.channels.contains(std::string{channels::kMarkers.name})) {
      input.camera = read_markers(file, *input.described);
    }
    if (input.camera) {
      for (CameraSighting& sighting : input.camera->sightings)
        sighting.time +=
            input.log.images_shift - duration_from_seconds(input.described->camera.late_s);
    }
  }
  estimate_noise(input);
  return input;
}

}  // namespace waymark
