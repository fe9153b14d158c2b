// SPDX-License-Identifier: BSD-3-Clause
#include "slam/slam_config.hpp"

#include "common/markers/marker_dictionary.hpp"
#include "slam/parallel.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

namespace waymark {
namespace {

/// The horizontal wedge in which a marker is wholly in the image and large enough to be detected.
CameraView camera_view(const CameraConfig& camera, const MarkerConfig& markers,
                       const Preprocessing& preprocessing) {
  const Eigen::Isometry3d base_from_camera = camera.base_from_camera();
  const Eigen::Vector3d forward = base_from_camera.linear().col(2);
  CameraView view;
  view.base_from_camera = {Eigen::Vector2d{base_from_camera.translation().head<2>()},
                           std::atan2(forward.y(), forward.x())};
  view.left_rad = std::atan(camera.cx_px / camera.fx_px) - preprocessing.view_margin_rad;
  view.right_rad = -std::atan((camera.width_px - 1 - camera.cx_px) / camera.fx_px) +
                   preprocessing.view_margin_rad;
  view.range_min_m = std::max(
      view.range_min_m, markers.size_m * camera.fy_px / static_cast<double>(camera.height_px));
  view.range_max_m = markers.size_m * camera.fx_px / preprocessing.detectable_px;
  return view;
}

SightingNoise sighting_noise(const CameraConfig& camera, const MarkerConfig& markers) {
  return {.calibration = {camera.yaw_sigma_rad, camera.focal_sigma, markers.standoff_sigma_m},
          .bearing_rad = camera.bearing_sigma_rad,
          .position_m = camera.position_sigma_m,
          .bulge_m = markers.bulge_sigma_m,
          .skew_rad = markers.skew_sigma_rad};
}

std::string_view name_of(EstimatorName estimator) {
  switch (estimator) {
    case EstimatorName::kOdometry:
      return "odometry";
    case EstimatorName::kGmapping:
      return "gmapping";
    case EstimatorName::kMarkerMatching:
      return "marker_matching";
    case EstimatorName::kWaymark:
      break;
  }
  return "waymark";
}

}  // namespace

void SlamSection::describe(Fields& fields) {
  const auto named = [](EstimatorName name) {
    return std::pair{name_of(name), name};
  };
  fields.choice("estimator", estimator,
                {named(EstimatorName::kOdometry), named(EstimatorName::kGmapping),
                 named(EstimatorName::kMarkerMatching), named(EstimatorName::kWaymark)},
                "method; each has options of its own, see --dump-config");
  const std::string unused = fmt::format("slam.estimator = {} does not use it", name_of(estimator));
  const auto of = [&](std::initializer_list<EstimatorName> users, auto visit) {
    fields.when(std::ranges::find(users, estimator) != users.end(), unused, visit);
  };
  fields.field("seed", seed, {0.0, 9e15}, "of all random numbers");
  of({EstimatorName::kGmapping}, [&] {
    fields.field("threads", threads, {1.0, 256.0},
                 "for the particles; any number gives the same result");
  });
  fields.field("blank_ids", blank_ids,
               "control experiment: treat every camera frame as if it showed no marker");
  fields.field("map_period_s", map_period_s, {0.001, 86400.0},
               "message time between two SLAM_MAP and SLAM_MARKERS updates");
  of({EstimatorName::kWaymark}, [&] {
    fields.choice(
        "mode", mode,
        {{"map", MapMode::kMap}, {"localise", MapMode::kLocalise}, {"extend", MapMode::kExtend}},
        "draw a new map, or use the one of --load-map: as it is, or to add to it");
    fields.choice(
        "start", start.kind,
        {{"origin", StartKind::kOrigin},
         {"pose", StartKind::kPose},
         {"last", StartKind::kLast},
         {"anywhere", StartKind::kAnywhere}},
        "where in the loaded map: at its origin (where mapping began or, with a survey, "
        "the survey's origin), at start_pose, where slam stopped (by state_folder, else as "
        "anywhere), or unknown");
    fields.when(start.kind == StartKind::kPose, "only slam.start = pose uses it",
                [&] { fields.section("start_pose", start); });
    fields.field(
        "save_map_every_s", save_map_every_s, {0.0, 86400.0},
        "message time between two saves to --save-map while mapping, so that slam can be restarted "
        "with start = last and continue this map; 0: only at the end");
  });
  fields.field("state_folder", state_folder,
               "folder for last_pose.toml and for maps that are saved on command; empty: none");
  fields.field("commands", commands, "whether SLAM_COMMAND is obeyed (waymark-command)");
  fields.section("preprocessing", preprocessing);
  of({EstimatorName::kOdometry, EstimatorName::kMarkerMatching}, [&] {
    fields.section("motion", motion);
    fields.section("gate", gate);
  });
  fields.section("grid", grid);
  of({EstimatorName::kGmapping}, [&] { fields.section("gmapping", gmapping); });
  of({EstimatorName::kMarkerMatching}, [&] { fields.section("marker_matching", marker_matching); });
  of({EstimatorName::kWaymark}, [&] { fields.section("waymark", waymark); });
}

void SlamConfig::describe(Fields& fields) {
  fields.section("robot", robot);
  fields.section("slam", slam);
}

void SlamConfig::check(Problems& problems) const {
  robot.check(problems);
  check_dictionary(robot.markers, problems);
  const bool is_within_a_map =
      slam.start.kind == StartKind::kPose || slam.start.kind == StartKind::kAnywhere;
  if (slam.mode == MapMode::kMap && is_within_a_map)
    problems.add("slam.start", "needs a loaded map: set slam.mode");
  if (slam.start.kind == StartKind::kLast && slam.state_folder.empty())
    problems.add("slam.start", "\"last\" needs slam.state_folder, where the last pose is kept");
  if (slam.grid.face_spacing_m > slam.grid.resolution_m) {
    problems.add("slam.grid.face_spacing_m", "must not be above resolution_m");
  }
}

SensorSetup sensor_setup(const SlamConfig& config) {
  const LidarConfig& lidar = config.robot.lidar;
  SensorSetup setup;
  setup.lidar = {lidar.base_from_lidar(), lidar.range_min_m, lidar.range_max_m};
  setup.camera = camera_view(config.robot.camera, config.robot.markers, config.slam.preprocessing);
  setup.marker_size_m = config.robot.markers.size_m;
  setup.preprocessing = config.slam.preprocessing;
  setup.blank_ids = config.slam.blank_ids;
  return setup;
}

EstimatorSetup estimator_setup(const SlamConfig& config) {
  EstimatorSetup setup;
  setup.grid = config.slam.grid;
  setup.motion = config.slam.motion;
  setup.gate = config.slam.gate;
  setup.range_sigma_m = config.robot.lidar.range_sigma_m;
  setup.half_track_m = 0.5 * config.robot.base.wheel_separation_m;
  setup.camera = sensor_setup(config).camera;
  setup.sighting_noise = sighting_noise(config.robot.camera, config.robot.markers);
  setup.range_max_m = config.robot.lidar.range_max_m;
  setup.parallel_for = parallel_for_with(config.slam.threads);
  setup.seed = static_cast<std::uint64_t>(config.slam.seed);
  setup.map_mode = config.slam.mode;
  setup.start = config.slam.start;
  if (setup.start.kind == StartKind::kLast) setup.start.kind = StartKind::kAnywhere;
  if (setup.start.kind == StartKind::kOrigin) {
    setup.start.x_m = 0.0;
    setup.start.y_m = 0.0;
    setup.start.yaw_rad = 0.0;
  }
  return setup;
}

}  // namespace waymark
