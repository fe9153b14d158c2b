// SPDX-License-Identifier: BSD-3-Clause
// Input: random choices for a drive of valid, but absurd messages and commands. Slam must not
// throw, unless commands have made the map larger than the largest grid, and must publish valid
// messages: encode() checks them.
#include "common/messages/bounds.hpp"
#include "common/messages/convert.hpp"
#include "slam/slam_node.hpp"

#include <fuzzer/FuzzedDataProvider.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>

namespace waymark::fuzz {
namespace {

constexpr int kMaxMessages = 200;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr std::array kRanges_m{kNan, kInfinity, -1.0, 0.0,  1e-6,
                               0.05, 0.5,       3.4,  30.0, bounds::kRange_m};
constexpr std::array kBeams{0, 1, 2, 3, 8, 15, 45, 180, 181, 360, 1081};
constexpr std::array kSizes{1e-9, 1e-3, 0.02, 0.1, 1.0, 30.0, 3e3, bounds::kPosition_m};
constexpr std::array kSigmas{1e-300, 1e-9, 0.01, 0.1, 1.0, 1e3, 1e9, 1e200};
constexpr std::array<std::int64_t, 9> kWaits_us{0,         1,          20'000,   100'000,   500'000,
                                                3'000'000, 60'000'000, -100'000, -3'000'000};

class Drive {
 public:
  explicit Drive(std::span<const std::uint8_t> bytes) : bytes_{bytes.data(), bytes.size()} {
    config_.slam.estimator =
        bytes_.PickValueInArray({EstimatorName::kWaymark, EstimatorName::kGmapping,
                                 EstimatorName::kMarkerMatching, EstimatorName::kOdometry});
    config_.slam.commands = true;
    config_.slam.gmapping.particles = 2;
    config_.slam.marker_matching.particles = 3;
    half_m_ = {size_m(), size_m()};
  }

  void run() {
    Inbox inbox;
    Outbox outbox;
    SlamNode node{config_, inbox, outbox};
    try {
      for (int i = 0; i < kMaxMessages && bytes_.remaining_bytes() > 0; ++i) {
        if (const auto message = next_valid()) inbox.deliver(*message);
        outbox.take();
      }
    } catch (const std::length_error&) {
      if (num_commands_ == 0) throw;
    }
    node.finish();
  }

 private:
  double size_m() {
    return bytes_.PickValueInArray(kSizes) * bytes_.ConsumeFloatingPointInRange(0.5, 2.0);
  }

  /// A number of either sign, mostly small.
  double signed_size() {
    return bytes_.PickValueInArray(kSizes) * bytes_.ConsumeFloatingPointInRange(-1.0, 1.0);
  }

  /// nullopt for a message that is not valid: these are tested by the target `messages`.
  std::optional<Message> next_valid() {
    try {
      return next();
    } catch (const std::logic_error&) {
      return std::nullopt;
    }
  }

  Message next() {
    time_us_ += bytes_.ConsumeBool() ? 50'000 : bytes_.PickValueInArray(kWaits_us);
    switch (bytes_.ConsumeIntegralInRange(0, 15)) {
      case 0:
        return command();
      case 1:
      case 2:
      case 3:
      case 4:
        return lidar();
      case 5:
      case 6:
      case 7:
        return markers();
      default:
        return odometry();
    }
  }

  Message odometry() {
    const Se2 step{signed_size(), signed_size(), signed_size()};
    const Se2 moved =
        bytes_.ConsumeBool() ? step : here_ * Se2{std::min(step.x(), 0.1), 0.0, 0.1 * step.y()};
    here_ = {std::clamp(moved.x(), -bounds::kPosition_m, bounds::kPosition_m),
             std::clamp(moved.y(), -bounds::kPosition_m, bounds::kPosition_m), moved.theta()};
    return encode(channels::kOdometry, to_pose_message(time(), here_));
  }

  /// A scan of a rectangular room, or with one range everywhere; some beams have other ranges.
  Message lidar() {
    LidarScan scan;
    scan.time = time();
    const int beams = bytes_.PickValueInArray(kBeams);
    const bool in_room = bytes_.ConsumeBool();
    const double everywhere_m = bytes_.PickValueInArray(kRanges_m);
    for (int i = 0; i < beams; ++i) {
      scan.angles_rad.push_back(2.0 * std::numbers::pi * i / beams);
      scan.ranges_m.push_back(in_room ? to_wall_m(scan.angles_rad.back() + here_.theta())
                                      : everywhere_m);
    }
    for (int odd = bytes_.ConsumeIntegralInRange(0, 8); odd > 0 && beams > 0; --odd) {
      const auto first = bytes_.ConsumeIntegralInRange(0, beams - 1);
      const auto last = bytes_.ConsumeIntegralInRange(first, beams);
      std::fill(scan.ranges_m.begin() + first, scan.ranges_m.begin() + last,
                bytes_.PickValueInArray(kRanges_m));
    }
    return encode(channels::kLidar, to_planar_lidar(scan));
  }

  double to_wall_m(double heading_rad) const {
    const double along_x =
        (std::copysign(half_m_[0], std::cos(heading_rad)) - here_.x()) / std::cos(heading_rad);
    const double along_y =
        (std::copysign(half_m_[1], std::sin(heading_rad)) - here_.y()) / std::sin(heading_rad);
    return std::clamp(std::min(along_x, along_y), 0.0, bounds::kRange_m);
  }

  Message markers() {
    MarkerDetections frame;
    frame.time = time();
    frame.image_width_px = 640;
    frame.image_height_px = 480;
    for (int count = bytes_.ConsumeIntegralInRange(0, 3); count > 0; --count) {
      MarkerDetection seen;
      seen.id = bytes_.ConsumeIntegralInRange(0, 3);
      for (Eigen::Vector2d& corner : seen.corners_px)
        corner = {bytes_.ConsumeFloatingPointInRange(-10.0, 650.0),
                  bytes_.ConsumeFloatingPointInRange(-10.0, 490.0)};
      for (Eigen::Isometry3d* pose : {&seen.base_from_marker, &seen.other_base_from_marker}) {
        pose->translation() = Eigen::Vector3d{signed_size(), signed_size(), signed_size()};
        pose->linear() =
            Eigen::AngleAxisd{bytes_.ConsumeFloatingPointInRange(-4.0, 4.0),
                              Eigen::Vector3d::Unit(bytes_.ConsumeIntegralInRange(0, 2))}
                .toRotationMatrix();
      }
      for (int i = 0; i < 6; ++i)
        seen.covariance_in_base(i, i) = bytes_.PickValueInArray(kSizes);
      seen.reprojection_error_px = bytes_.PickValueInArray(kSizes);
      seen.other_reprojection_error_px = bytes_.PickValueInArray(kSizes);
      seen.width_px = bytes_.ConsumeFloatingPointInRange(0.0, 600.0);
      frame.detections.push_back(seen);
    }
    return encode(channels::kMarkers, to_detections_message(frame));
  }

  /// A command other than "save", for which there is no folder.
  Message command() {
    command_t command{};
    command.utime = to_us(time());
    command.command_id = ++num_commands_;
    command.in_tick = bytes_.ConsumeBool() ? 1 : 0;
    command.kind = bytes_.PickValueInArray(
        {command_t::KIND_RESET, command_t::KIND_SET_POSE, command_t::KIND_SET_MODE});
    for (double& coordinate : command.pose)
      coordinate = signed_size();
    for (double& sigma : command.sigmas)
      sigma = bytes_.PickValueInArray(kSigmas);
    command.mode = bytes_.PickValueInArray(
        {command_t::MODE_MAP, command_t::MODE_LOCALISE, command_t::MODE_EXTEND});
    return encode(channels::kSlamCommand, command);
  }

  Timestamp time() const {
    return timestamp_from_us(std::clamp<std::int64_t>(time_us_, 0, bounds::kTime_us));
  }

  FuzzedDataProvider bytes_;
  SlamConfig config_{};
  std::array<double, 2> half_m_{};
  Se2 here_{};
  std::int64_t time_us_{1'000'000'000};
  std::int64_t num_commands_{0};
};

}  // namespace
}  // namespace waymark::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  waymark::fuzz::Drive{{data, size}}.run();
  return 0;
}
