// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/patient.hpp"

#include "common/errors/setup_error.hpp"
#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "import/carmen/carmen_reader.hpp"
#include "import/findings/range_noise.hpp"
#include "import/mbot/foreign_messages.hpp"
#include "import/mbot/mbot_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <fstream>
#include <set>

namespace waymark {
namespace {

constexpr std::size_t kScansForNoise = 1000;

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
};

Contents contents_of(const std::filesystem::path& file) {
  Contents contents;
  LogReader reader{file};
  while (const auto event = reader.next()) {
    ChannelTraffic& traffic = contents.channels[event->channel];
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

MbotOptions choose(const Contents& contents, const PatientChannels& wanted) {
  MbotOptions options{};
  options.lidar_channel = wanted.lidar;
  options.odometry_channel = wanted.odometry;
  options.encoder_channel = wanted.encoders;
  if (wanted.lidar.empty()) {
    if (contents.lidars.size() != 1) {
      throw SetupError{fmt::format(
          "{} channels have LiDAR scans ({}): give --lidar-channel", contents.lidars.size(),
          contents.lidars.empty() ? "none" : fmt::format("{}", fmt::join(contents.lidars, ", ")))};
    }
    options.lidar_channel = *contents.lidars.begin();
  }
  const std::string ours{channels::kOdometry.name};
  if (wanted.odometry.empty() && wanted.encoders.empty() && contents.channels.contains(ours))
    options.odometry_channel = ours;
  return options;
}

void estimate_noise(Patient& patient) {
  ImportedLog& log = patient.log;
  WallScatter scatter;
  const std::size_t every = 1 + log.scans.size() / kScansForNoise;
  for (std::size_t i = 0; i < log.scans.size(); i += every)
    scatter.add(scan_of(log.scans[i]));
  const auto sigma_m = scatter.sigma_m();
  patient.noise_is_estimated = sigma_m.has_value();
  log.robot.lidar.range_sigma_m = sigma_m.value_or(log.robot.lidar.range_sigma_m);
}

}  // namespace

Patient read_patient(const std::filesystem::path& file, const std::filesystem::path& robot,
                     const PatientChannels& channels) {
  const bool is_lcm = is_lcm_log(file);
  Patient patient{{}, {file, is_lcm ? AddressUnit::kByte : AddressUnit::kLine}, false, {}, {}};
  if (is_lcm) {
    const Contents contents = contents_of(file);
    patient.channels = contents.channels;
    patient.log = read_mbot_log(file, choose(contents, channels), patient.report);
  } else {
    patient.log = read_carmen_log(file, {}, patient.report);
  }
  std::filesystem::path description = robot;
  if (description.empty() && std::filesystem::exists(file.parent_path() / "robot.toml"))
    description = file.parent_path() / "robot.toml";
  if (!description.empty()) patient.described = load_config<RobotOnly>({{description}, {}}).robot;
  // An LCM log does not say where its LiDAR sits.
  if (is_lcm && patient.described) {
    LidarConfig& lidar = patient.log.robot.lidar;
    lidar.x_m = patient.described->lidar.x_m;
    lidar.y_m = patient.described->lidar.y_m;
    lidar.yaw_rad = patient.described->lidar.yaw_rad;
  }
  estimate_noise(patient);
  return patient;
}

}  // namespace waymark
