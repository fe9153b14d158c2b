// SPDX-License-Identifier: BSD-3-Clause
#include "common/command_line/command_line.hpp"
#include "common/errors/exit_codes.hpp"
#include "common/log/log_file.hpp"
#include "common/logging/logging.hpp"
#include "common/runtime/guard.hpp"
#include "import/carmen/carmen_reader.hpp"
#include "import/findings/findings.hpp"
#include "import/log/log_output.hpp"
#include "import/mbot/mbot_reader.hpp"
#include "import/rosbag/rosbag_reader.hpp"

#include <fmt/format.h>

namespace waymark {
namespace {

constexpr ProcessTraits kTraits{
    "import", "Turns logs of other robots into logs that every estimator can be replayed on.",
    false};

struct Options {
  std::filesystem::path file{};
  std::filesystem::path out{};
  bool tolerant{false};
  bool fix_reversed_odometry{false};
  std::optional<double> first_angle_deg{};
  std::optional<double> angle_step_deg{};
  std::optional<double> lidar_yaw_deg{};
  double odometry_scale{1.0};
  CarmenOptions carmen{};
  MbotOptions mbot{};
  RosbagOptions rosbag{};
};

/// Options of all log formats.
void add_common_options(Command& app, Options& options, LidarMounting& mounting) {
  app.add_option("FILE", options.file, "the log to read").required();
  app.add_option("--out", options.out,
                 "LCM log to write; robot.toml (and reference.tum) go beside it")
      .required();
  app.add_flag("--tolerant", options.tolerant, "exit with 0 even if lines or events were skipped");
  app.add_flag("--fix-reversed-odometry", options.fix_reversed_odometry,
               "reverse odometry where scans show that it counts driving backwards as forwards");
  app.add_option("--odometry-scale", options.odometry_scale,
                 "factor for odometry distances (0.0254 if they are in inches)")
      .check(positive_number());
  app.add_option("--lidar-x-m", mounting.x_m, "x of the LiDAR in the base frame")
      .check(finite_number());
  app.add_option("--lidar-y-m", mounting.y_m, "y of the LiDAR in the base frame")
      .check(finite_number());
  app.add_option("--lidar-yaw-deg", options.lidar_yaw_deg,
                 "direction of the LiDAR's x axis in the base frame")
      .check(angle_deg());
}

/// For formats whose scans do not contain the minimum range.
void add_range_min(Command& app, double& range_min_m) {
  app.add_option("--min-range-m", range_min_m, "shortest range measured")
      .check(nonnegative_number())
      .show_default();
}

Command add_carmen(Command& app, Options& options) {
  Command carmen = app.add_subcommand(
      "carmen",
      "CARMEN text log: FLASER, RLASER, ROBOTLASER1, ROBOTLASER2, ODOM; gzip, bzip2 or not");
  add_common_options(carmen, options, options.carmen.mounting);
  add_range_min(carmen, options.carmen.range_min_m);
  carmen.add_choice("--lidar", options.carmen.lidar,
                    {{"front", CarmenLidar::kFront}, {"rear", CarmenLidar::kRear}},
                    "front (FLASER, ROBOTLASER1; default) or rear (RLASER, ROBOTLASER2)");
  carmen.add_choice(
      "--odometry", options.carmen.odometry,
      {{"laser", CarmenOdometrySource::kLaserLines}, {"odom", CarmenOdometrySource::kOdomLines}},
      "laser (odometry poses of the LiDAR's lines) or odom (ODOM lines; default: laser if they "
      "move)");
  carmen.add_choice("--heading-unit", options.carmen.units.odometry_rad,
                    {{"rad", 1.0}, {"deg", radians(1.0)}}, "of poses (default: rad)");
  carmen.add_choice(
      "--stamps", options.carmen.stamps,
      {{"ipc", CarmenStamps::kIpc}, {"logger", CarmenStamps::kLogger}},
      "ipc or logger: which timestamp is a line's time (default: ipc if it advances)");
  carmen.add_choice("--time-unit", options.carmen.units.time_s,
                    {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}}, "of both timestamps (default: s)");
  carmen
      .add_option("--scan-period-s", options.carmen.scan_period_s,
                  "time between scans, for lines without timestamps")
      .check(positive_number());
  carmen
      .add_option("--max-range-m", options.carmen.range_max_m,
                  "ranges from here on mean no return (default: found from a peak of equal ranges, "
                  "else as the line says, else 81.83)")
      .check(positive_number());
  carmen.add_choice("--range-unit", options.carmen.range_unit_m,
                    {{"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}}, "of ranges (default: m)");
  carmen
      .add_option("--first-angle-deg", options.first_angle_deg,
                  "angle of beam 0 (default: as the line says; for FLASER and RLASER such that the "
                  "middle beam points ahead)")
      .check(angle_deg());
  carmen
      .add_option(
          "--angle-step-deg", options.angle_step_deg,
          "angle between beams (default: as the line says; for FLASER and RLASER the one that "
          "makes walls straight, or 180 degrees in total if walls do not decide)")
      .check(angle_deg());
  return carmen;
}

Command add_mbot(Command& app, Options& options) {
  Command mbot = app.add_subcommand(
      "mbot", "LCM log of an MBot robot (lidar_t) or of one with bot_core's planar_lidar_t");
  MbotOptions& chosen = options.mbot;
  add_common_options(mbot, options, chosen.mounting);
  add_range_min(mbot, chosen.range_min_m);
  mbot.add_option("--lidar-channel", chosen.lidar_channel, "lidar_t or planar_lidar_t")
      .show_default();
  mbot.add_option("--odometry-channel", chosen.odometry_channel,
                  "pose2D_t, pose_xyt_t, odometry_t or bot_core.pose_t");
  mbot.add_option("--encoder-channel", chosen.encoder_channel,
                  "left and right encoder ticks of a MAEBot (default, without --odometry-channel: "
                  "the only channel with ticks)");
  mbot.add_option("--camera-channel", chosen.camera_channel,
                  "image_t (default: CAMERA, if the log has such images)");
  mbot.add_option("--reference-channel", chosen.reference_channel,
                  "poses to write as reference.tum, types as for --odometry-channel");
  mbot.add_option("--meters-per-tick", chosen.meters_per_tick,
                  "distance per encoder tick (default: that of the MAEBot with such messages)")
      .check(positive_number());
  mbot.add_option("--wheel-base-m", chosen.wheel_base_m,
                  "distance between the wheels (default: the MAEBot's)")
      .check(positive_number());
  mbot.add_option("--max-range-m", chosen.range_max_m,
                  "ranges from here on mean no return (default: found from a peak of equal ranges, "
                  "else 6 for lidar_t, else the longest range)")
      .check(positive_number());
  return mbot;
}

Command add_rosbag(Command& app, Options& options) {
  Command rosbag = app.add_subcommand(
      "rosbag",
      "bag of ROS 1 (.bag) or ROS 2 (.db3, .mcap): LaserScan, Odometry, images, tf_static");
  RosbagOptions& chosen = options.rosbag;
  add_common_options(rosbag, options, chosen.mounting);
  rosbag.add_option("--scan-topic", chosen.scan_topic,
                    "sensor_msgs/LaserScan (default: the only one)");
  rosbag.add_option("--odometry-topic", chosen.odometry_topic,
                    "nav_msgs/Odometry (default: the only one)");
  rosbag.add_option("--image-topic", chosen.image_topic,
                    "sensor_msgs/CompressedImage or Image (default: the only one, if any)");
  rosbag.add_option("--camera-info-topic", chosen.camera_info_topic,
                    "sensor_msgs/CameraInfo (default: the only one)");
  rosbag
      .add_option("--max-range-m", chosen.range_max_m,
                  "ranges from here on mean no return (default: found from a peak of equal ranges, "
                  "else as the scans say)")
      .check(positive_number());
  rosbag.add_flag("--no-images", chosen.without_images, "leave the camera out");
  rosbag.add_option("--base-frame", chosen.base_frame,
                    "base frame in tf_static (default: the child frame of odometry)");
  return rosbag;
}

void convert_units(Options& options) {
  options.carmen.units.odometry_m = options.odometry_scale;
  const auto to_radians = [](const std::optional<double>& angle_deg) {
    return angle_deg ? std::optional{radians(*angle_deg)} : std::nullopt;
  };
  options.carmen.beams = {to_radians(options.first_angle_deg), to_radians(options.angle_step_deg)};
  const std::optional<double> yaw_rad = to_radians(options.lidar_yaw_deg);
  if (yaw_rad) {
    options.carmen.mounting.yaw_rad = options.mbot.mounting.yaw_rad =
        options.rosbag.mounting.yaw_rad = wrap_angle(*yaw_rad);
  }
}

void log_report(const ImportReport& report) {
  for (const std::string& message : report.messages())
    logging::warn("{}", message);
  for (const std::string& note : report.notes())
    logging::info("{}", note);
}

enum class Kind { kCarmen, kMbot, kRosbag };

ImportedLog read(const Options& options, Kind kind, ImportReport& report) {
  if (kind == Kind::kCarmen) return read_carmen_log(options.file, options.carmen, report);
  if (kind == Kind::kMbot) return read_mbot_log(options.file, options.mbot, report);
  return read_rosbag(options.file, options.rosbag, report);
}

int import(const Options& options, Kind kind) {
  protect_inputs("--out", options.out, {options.file});
  ImportReport report{options.file,
                      kind == Kind::kCarmen ? AddressUnit::kLine : AddressUnit::kByte};
  try {
    ImportedLog log = read(options, kind, report);
    if (kind != Kind::kCarmen) scale_distances(log.odometry, options.odometry_scale);
    examine(log,
            options.fix_reversed_odometry ? ReversedOdometry::kCorrect : ReversedOdometry::kReport,
            report);
    write_imported_log(log, report, options.out);
    log_report(report);
    fmt::print("{}", summary(log, report));
  } catch (...) {
    log_report(report);
    throw;
  }
  if (report.num_skipped() == 0 || options.tolerant) return kExitOk;
  logging::error("skipped {} (--tolerant accepts that)", report.num_skipped());
  return kExitFailed;
}

}  // namespace
}  // namespace waymark

int main(int argc, char** argv) {
  using namespace waymark;
  Options options;
  Program app{std::string{kTraits.purpose}, "waymark-import"};
  app.require_subcommand();
  const Command carmen = add_carmen(app, options);
  add_mbot(app, options);
  const Command rosbag = add_rosbag(app, options);
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  convert_units(options);
  const Kind kind = carmen.is_given()   ? Kind::kCarmen
                    : rosbag.is_given() ? Kind::kRosbag
                                        : Kind::kMbot;
  return run_guarded(kTraits, [&] { return import(options, kind); });
}
