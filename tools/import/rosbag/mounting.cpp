// SPDX-License-Identifier: BSD-3-Clause
#include "import/rosbag/mounting.hpp"

#include "common/messages/codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kLevel = 0.98;                   // cosine of 11 degrees
constexpr std::size_t kDistortionParameters = 5;  // OpenCV's k1 k2 p1 p2 k3

std::string name_of(const std::string& base_frame) {
  return base_frame.empty() ? "the base" : base_frame;
}

bool has_projection(const RosCameraInfo& info) {
  const auto& p = info.projection;
  return std::ranges::all_of(p, [](double d) { return std::isfinite(d); }) && p[0] > 0.0 &&
         p[5] > 0.0;
}

/// Rectified images are those of a pinhole camera with the projection matrix P.
void describe_pinhole(CameraConfig& camera, const RosCameraInfo& info, ImportReport& report) {
  const auto& p = info.projection;
  const bool is_known = has_projection(info);
  const auto& k = info.camera_matrix;
  camera.fx_px = is_known ? p[0] : k[0];
  camera.cx_px = is_known ? p[2] : k[2];
  camera.fy_px = is_known ? p[5] : k[4];
  camera.cy_px = is_known ? p[6] : k[5];
  camera.distortion.assign(kDistortionParameters, 0.0);
  report.note(is_known ? "the images are rectified: the lens is taken from CameraInfo's P, "
                         "without distortion"
                       : "the images are rectified, but CameraInfo has no P: the lens is "
                         "taken from its K, without distortion; check [robot.camera]");
}

void describe_lens(CameraConfig& camera, const RosCameraInfo& info, ImportReport& report) {
  const auto& k = info.camera_matrix;
  camera.fx_px = k[0];
  camera.cx_px = k[2];
  camera.fy_px = k[4];
  camera.cy_px = k[5];
  const bool is_known =
      info.distortion_model == "plumb_bob" && info.distortion.size() <= kDistortionParameters;
  camera.distortion.assign(kDistortionParameters, 0.0);
  if (is_known) {
    std::ranges::copy(info.distortion, camera.distortion.begin());
  } else if (std::ranges::any_of(info.distortion, [](double d) { return d != 0.0; })) {
    report.note(fmt::format("the lens model '{}' is not known here: its distortion is left out",
                            info.distortion_model));
  }
}

}  // namespace

LidarOrientation describe_lidar(LidarConfig& lidar, const StaticFrames& transforms,
                                const SensorFrames& frames, const LidarMounting& given,
                                ImportReport& report) {
  LidarOrientation orientation = LidarOrientation::kUpright;
  lidar.x_m = lidar.y_m = lidar.yaw_rad = 0.0;
  if (const auto base_from_lidar = transforms.find(frames.base, frames.lidar)) {
    const Eigen::Vector3d forward = base_from_lidar->linear().col(0);
    const double up = base_from_lidar->linear()(2, 2);
    lidar.x_m = base_from_lidar->translation().x();
    lidar.y_m = base_from_lidar->translation().y();
    lidar.z_m = std::max(0.0, base_from_lidar->translation().z());
    lidar.yaw_rad = std::atan2(forward.y(), forward.x());
    if (up < 0.0) {
      orientation = LidarOrientation::kUpsideDown;
      report.note(frames.lidar + " is mounted upside down: its angles are turned round");
    }
    if (std::abs(up) < kLevel) {
      report.note(fmt::format("{} is not level in {}: its beams are taken as if it were",
                              frames.lidar, name_of(frames.base)));
    }
  } else {
    report.note(fmt::format(
        "no fixed transforms lead from {} to {}: the LiDAR counts as mounted at the origin; "
        "--lidar-x-m, --lidar-y-m, --lidar-yaw-deg and --base-frame say otherwise",
        name_of(frames.base), frames.lidar));
  }
  lidar.x_m = given.x_m.value_or(lidar.x_m);
  lidar.y_m = given.y_m.value_or(lidar.y_m);
  lidar.yaw_rad = given.yaw_rad.value_or(lidar.yaw_rad);
  return orientation;
}

void describe_camera(CameraConfig& camera, const StaticFrames& transforms,
                     const SensorFrames& frames, const std::optional<RosCameraInfo>& info,
                     const ImportedImage& image, ImageRectification rectification,
                     ImportReport& report) {
  const image_t picture = decode<image_t>(image.message.payload).message.value();
  camera.width_px = picture.width;
  camera.height_px = picture.height;
  const bool is_known =
      info && (info->camera_matrix[0] > 0.0 ||
               (rectification == ImageRectification::kRectified && has_projection(*info)));
  if (!is_known) {
    report.note("no CameraInfo: the camera's focal length is a guess; edit [robot.camera]");
  } else if (info->width_px != picture.width || info->height_px != picture.height) {
    report.note(fmt::format(
        "CameraInfo is of images of {}x{}, but they have {}x{}: the camera's focal length is a "
        "guess; edit [robot.camera]",
        info->width_px, info->height_px, picture.width, picture.height));
  } else if (rectification == ImageRectification::kRectified) {
    describe_pinhole(camera, *info, report);
  } else {
    describe_lens(camera, *info, report);
  }
  const auto base_from_optical = transforms.find(frames.base, frames.camera);
  if (!base_from_optical) {
    return report.note(
        fmt::format("no fixed transforms lead from {} to {}: where the camera is mounted is a "
                    "guess; edit [robot.camera]",
                    name_of(frames.base), frames.camera));
  }
  camera.x_m = base_from_optical->translation().x();
  camera.y_m = base_from_optical->translation().y();
  camera.z_m = std::max(0.0, base_from_optical->translation().z());
  camera.roll_rad = camera.pitch_rad = camera.yaw_rad = 0.0;
  const Eigen::Matrix3d level = camera.base_from_camera().linear();  // of a camera that is level
  const Eigen::Matrix3d turn = base_from_optical->linear() * level.transpose();
  camera.yaw_rad = std::atan2(turn(1, 0), turn(0, 0));
  camera.pitch_rad = std::atan2(-turn(2, 0), std::hypot(turn(2, 1), turn(2, 2)));
  camera.roll_rad = std::atan2(turn(2, 1), turn(2, 2));
}

}  // namespace waymark
