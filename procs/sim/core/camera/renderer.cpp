// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/camera/renderer.hpp"

#include "common/sensors/sensors.hpp"
#include "sim/core/world/mjcf.hpp"

#include <opencv2/core.hpp>

#include <algorithm>
#include <map>
#include <string>

namespace waymark {
namespace {

std::map<int, cv::Mat> pictures(const World& world, const MarkerPrint& print,
                                PlatePrint plate_print) {
  std::map<int, cv::Mat> picture_of_id;
  for (const MarkerPlate& marker : world.markers) {
    if (picture_of_id.contains(marker.id)) continue;
    picture_of_id[marker.id] =
        plate_print == PlatePrint::kBlank ? blank_picture(print) : marker_picture(print, marker.id);
  }
  return picture_of_id;
}

std::vector<PlateGeom> plate_geoms(const World& world, const mjModel& model) {
  std::vector<PlateGeom> plates;
  for (std::size_t i = 0; i < world.markers.size(); ++i) {
    const std::string name = mjcf_names::kMarkerPrefix + std::to_string(i);
    plates.push_back({mj_name2id(&model, mjOBJ_GEOM, name.c_str()), world.markers[i].id});
  }
  return plates;
}

/// Pose of a plate's front face.
Eigen::Isometry3d world_from_front(const mjData& data, int geom) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>{data.geom_xmat + 9 * geom};
  pose.translation() = Eigen::Map<const Eigen::Vector3d>{data.geom_xpos + 3 * geom} +
                       0.5 * kPlateThickness_m * pose.linear().col(2);
  return pose;
}

void copy(const Eigen::Vector3d& from, float* to) {
  for (int i = 0; i < 3; ++i)
    to[i] = static_cast<float>(from[i]);
}

}  // namespace

Renderer::Renderer(const World& world, const MarkerPrint& print, PlatePrint plate_print,
                   const Pinhole& pinhole, Physics& physics)
    : physics_{physics},
      prints_{pictures(world, print, plate_print), plate_size_m(print)},
      plates_{plate_geoms(world, physics.model())},
      bottom_up_(pinhole.height_px, pinhole.width_px, CV_8UC3),
      depth_bottom_up_(pinhole.height_px, pinhole.width_px, CV_32F) {
  view_.pinhole = pinhole;
  constexpr int kSpareGeoms = 10;
  mjv_defaultOption(&options_);
  std::fill(std::begin(options_.geomgroup), std::end(options_.geomgroup), mjtByte{1});
  options_.geomgroup[static_cast<int>(GeomGroup::kRobot)] = 0;
  std::fill(std::begin(options_.flags), std::end(options_.flags), mjtByte{0});
  options_.flags[mjVIS_STATIC] = 1;

  mjv_defaultScene(&scene_);
  mjv_makeScene(&physics.model(), &scene_, physics.model().ngeom + kSpareGeoms);
  // Shadows, reflections, fog and the sky cost milliseconds and add nothing to this world.
  std::fill(std::begin(scene_.flags), std::end(scene_.flags), mjtByte{0});
  scene_.flags[mjRND_CULL_FACE] = 1;

  mjr_defaultContext(&context_);
  mjr_makeContext(&physics.model(), &context_, mjFONTSCALE_50);
  mjr_setBuffer(mjFB_OFFSCREEN, &context_);
}

Renderer::~Renderer() {
  mjr_freeContext(&context_);
  mjv_freeScene(&scene_);
}

const cv::Mat& Renderer::render(const Eigen::Isometry3d& world_from_camera) {
  mjvCamera free_camera;
  mjv_defaultCamera(&free_camera);
  mjv_updateScene(&physics_.model(), &physics_.data(), &options_, nullptr, &free_camera, mjCAT_ALL,
                  &scene_);
  view_.world_from_camera = world_from_camera;
  place_camera();
  const mjrRect viewport{0, 0, view_.pinhole.width_px, view_.pinhole.height_px};
  mjr_render(viewport, &scene_, &context_);
  read_view();
  for (const PlateGeom& plate : plates_)
    prints_.print(plate.id, world_from_front(physics_.data(), plate.geom), view_);
  return view_.rgb;
}

/// Sets MuJoCo's camera to the pose and pinhole of the view. A picture extends half a pixel beyond
/// the centres of its outermost pixels.
void Renderer::place_camera() {
  const Pinhole& pinhole = view_.pinhole;
  mjvGLCamera& camera = scene_.camera[0];
  copy(view_.world_from_camera.translation(), camera.pos);
  copy(view_.world_from_camera.linear().col(2), camera.forward);
  copy(-view_.world_from_camera.linear().col(1), camera.up);
  const double near_per_px = double{camera.frustum_near} / pinhole.focal_px;
  const auto at_near = [near_per_px](double px) {
    return static_cast<float>(near_per_px * px);
  };
  camera.frustum_top = at_near(pinhole.cy_px + 0.5);
  camera.frustum_bottom = at_near(pinhole.cy_px + 0.5 - pinhole.height_px);
  camera.frustum_center = at_near(0.5 * pinhole.width_px - (pinhole.cx_px + 0.5));
  scene_.camera[1] = camera;  // mjr_render averages the left and the right eye
}

/// OpenGL's depth is linear in 1/z: 0 at the near plane, 1 at the far one.
void Renderer::read_view() {
  const mjrRect viewport{0, 0, view_.pinhole.width_px, view_.pinhole.height_px};
  mjr_readPixels(bottom_up_.data, depth_bottom_up_.ptr<float>(), viewport, &context_);
  cv::flip(bottom_up_, view_.rgb, 0);
  cv::flip(depth_bottom_up_, view_.inverse_depth_per_m, 0);
  const double nearest_per_m = 1.0 / double{scene_.camera[0].frustum_near};
  const double farthest_per_m = 1.0 / double{scene_.camera[0].frustum_far};
  view_.inverse_depth_per_m.convertTo(view_.inverse_depth_per_m, CV_32F,
                                      farthest_per_m - nearest_per_m, nearest_per_m);
}

}  // namespace waymark
