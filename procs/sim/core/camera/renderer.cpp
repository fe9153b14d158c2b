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

std::vector<int> ids_of_geoms(const World& world, const mjModel& model) {
  std::vector<int> id_of_geom(static_cast<std::size_t>(model.ngeom), kNoMarker);
  for (std::size_t i = 0; i < world.markers.size(); ++i) {
    const std::string name = mjcf_names::kMarkerPrefix + std::to_string(i);
    const int geom = mj_name2id(&model, mjOBJ_GEOM, name.c_str());
    id_of_geom.at(static_cast<std::size_t>(geom)) = world.markers[i].id;
  }
  return id_of_geom;
}

void copy(const Eigen::Vector3d& from, float* to) {
  for (int i = 0; i < 3; ++i)
    to[i] = static_cast<float>(from[i]);
}

}  // namespace

Renderer::Renderer(const World& world, const MarkerPrint& print, PlatePrint plate_print,
                   const Pinhole& pinhole, Physics& physics)
    : physics_{physics},
      pinhole_{pinhole},
      textures_{pictures(world, print, plate_print)},
      id_of_geom_{ids_of_geoms(world, physics.model())},
      bottom_up_(pinhole.height_px, pinhole.width_px, CV_8UC3),
      picture_(pinhole.height_px, pinhole.width_px, CV_8UC3) {
  constexpr int kSpareGeoms = 10;
  mjv_defaultOption(&options_);
  std::fill(std::begin(options_.geomgroup), std::end(options_.geomgroup), mjtByte{1});
  options_.geomgroup[static_cast<int>(GeomGroup::kRobot)] = 0;
  std::fill(std::begin(options_.flags), std::end(options_.flags), mjtByte{0});
  options_.flags[mjVIS_TEXTURE] = 1;
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
  place_camera(world_from_camera);
  textures_.assign(id_of_geom_, scene_, context_);

  const mjrRect viewport{0, 0, pinhole_.width_px, pinhole_.height_px};
  mjr_render(viewport, &scene_, &context_);
  mjr_readPixels(bottom_up_.data, nullptr, viewport, &context_);
  cv::flip(bottom_up_, picture_, 0);
  return picture_;
}

/// Replaces MuJoCo's camera by ours. A picture reaches half a pixel beyond the outer centres.
void Renderer::place_camera(const Eigen::Isometry3d& world_from_camera) {
  mjvGLCamera& camera = scene_.camera[0];
  copy(world_from_camera.translation(), camera.pos);
  copy(world_from_camera.linear().col(2), camera.forward);
  copy(-world_from_camera.linear().col(1), camera.up);
  const double near_per_px = double{camera.frustum_near} / pinhole_.focal_px;
  const auto at_near = [near_per_px](double px) {
    return static_cast<float>(near_per_px * px);
  };
  camera.frustum_top = at_near(pinhole_.cy_px + 0.5);
  camera.frustum_bottom = at_near(pinhole_.cy_px + 0.5 - pinhole_.height_px);
  camera.frustum_center = at_near(0.5 * pinhole_.width_px - (pinhole_.cx_px + 0.5));
  scene_.camera[1] = camera;  // mjr_render takes the mean of both eyes
}

}  // namespace waymark
