// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sim_node.hpp"

#include "common/files/whole_file.hpp"
#include "common/files/writable_folder.hpp"
#include "common/geometry/rounded.hpp"
#include "common/lockstep/contents.hpp"
#include "common/logging/logging.hpp"
#include "common/messages/convert.hpp"

#include <fmt/format.h>

#include <string_view>
#include <system_error>

namespace waymark {
namespace {

static_assert(RunConfig::kMaxWindowTicks <= kMaxWindowTicks);

image_t to_image_message(const CameraFrame& frame) {
  image_t message{};
  message.utime = to_us(frame.time);
  message.width = frame.width_px;
  message.height = frame.height_px;
  message.row_stride = 0;
  message.pixelformat = image_t::PIXEL_FORMAT_MJPEG;
  message.size = static_cast<std::int32_t>(frame.jpeg.size());
  message.data = frame.jpeg;
  message.nmetadata = 0;
  return message;
}

std::string_view counter_of(CommandOutcome outcome) {
  switch (outcome) {
    case CommandOutcome::kInTime:
      return "DRIVE_COMMAND obeyed";
    case CommandOutcome::kLate:
      return "DRIVE_COMMAND late";
    case CommandOutcome::kOutdated:
      return "DRIVE_COMMAND dropped: a newer one has acted";
    case CommandOutcome::kTooMany:
      break;
  }
  return "DRIVE_COMMAND dropped: too many wait";
}

}  // namespace

SimNode::SimNode(const Config& config, Inbox& inbox) : config_{config}, inbox_{inbox} {
  if (!config_.out_dir.empty()) make_writable_folder(config_.out_dir);
  try {
    simulation_.emplace(config_);
  } catch (const SimulatorError& error) {
    throw SetupError{error.what()};
  }
  if (config_.route.source == DriveSource::kCommand) {
    inbox.on<twist2D_t>(channels::kDriveCommand,
                        [this](const twist2D_t& command) { handle(command); });
  }
}

void SimNode::begin() {
  if (config_.out_dir.empty()) return;
  try {
    write_start_files();
  } catch (const std::system_error& error) {
    throw SetupError{error.what()};
  }
}

void SimNode::write_start_files() {
  for (const char* of_an_earlier_run :
       {"truth_marker_moves.csv", "truth.tum", "truth.tum.unfinished"})
    std::filesystem::remove(config_.out_dir / of_an_earlier_run);
  write_whole_file(config_.out_dir / "scenario.toml", dump_config(config_));
  write_whole_file(config_.out_dir / "robot.toml", dump_robot_config(config_.robot));
  write_whole_file(config_.out_dir / "truth_markers.csv", truth_markers_csv(simulation_->world()));
  if (!config_.markers.moved.empty()) write_moves({});
  truth_.emplace(config_.out_dir / "truth.tum");
}

/// Rewrites truth_marker_moves.csv at each move, so that it is complete even if the run is cut
/// short.
void SimNode::write_moves(const std::vector<MovedMarker>& moved) {
  moved_markers_.insert(moved_markers_.end(), moved.begin(), moved.end());
  write_whole_file(config_.out_dir / "truth_marker_moves.csv",
                   truth_marker_moves_csv(moved_markers_));
}

std::int64_t SimNode::run_id() const {
  const std::string text = dump_config(config_);
  return content_hash({"scenario", {}, {text.begin(), text.end()}});
}

void SimNode::handle(const twist2D_t& command) {
  const Velocity velocity{double{command.vx}, double{command.wz}};
  const CommandOutcome outcome = simulation_->command(timestamp_from_us(command.utime), velocity);
  inbox_.counters().add(counter_of(outcome),
                        outcome == CommandOutcome::kInTime ? CountKind::kEvent : CountKind::kLoss);
}

std::vector<Message> SimNode::advance(Timestamp& tick_end) {
  const Tick tick = simulation_->advance();
  tick_end = tick.end;
  if (truth_ && !tick.moved_markers.empty()) write_moves(tick.moved_markers);
  std::vector<Message> messages;
  for (const OdometrySample& sample : tick.odometry) {
    messages.push_back(
        encode(channels::kOdometry, to_pose_message(sample.time, sample.odom_from_base)));
  }
  for (const TruePose& pose : tick.true_poses) {
    messages.push_back(
        encode(channels::kTruePose, to_pose_message(pose.time, pose.world_from_base)));
    if (truth_) truth_->add(pose);
  }
  for (const LidarScan& scan : tick.scans) {
    messages.push_back(config_.run.rolling_scan ? encode(channels::kMbotLidar, to_mbot_lidar(scan))
                                                : encode(channels::kLidar, to_planar_lidar(scan)));
  }
  for (const CameraFrame& frame : tick.frames)
    messages.push_back(encode(channels::kCamera, to_image_message(frame)));
  return messages;
}

std::string SimNode::progress_text() const {
  const Se2 at = simulation_->world_from_base();
  if (config_.route.source == DriveSource::kCommand || !config_.route.waypoints.empty()) {
    return fmt::format("at ({:.1f}, {:.1f}) m", rounded(at.x(), 10.0), rounded(at.y(), 10.0));
  }
  return fmt::format("x {:.1f} m of {:.1f} m", rounded(at.x(), 10.0), config_.route.end_x_m);
}

void SimNode::finish() {
  for (const TimedEvent& event : simulation_->pending_events())
    logging::warn("{}: did not begin in this run", event.key);
  if (truth_) truth_->finish();
}

}  // namespace waymark
