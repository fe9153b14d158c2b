// SPDX-License-Identifier: BSD-3-Clause
// Pictures of the world by MuJoCo's renderer, in memory.
#pragma once

#include "common/robot/robot_config.hpp"
#include "sim/core/camera/gl_context.hpp"
#include "sim/core/camera/plate_prints.hpp"
#include "sim/core/robot/physics.hpp"
#include "sim/core/world/marker_picture.hpp"
#include "sim/core/world/world.hpp"

#include <mujoco/mujoco.h>
#include <opencv2/core/mat.hpp>

#include <vector>

namespace waymark {

/// What is printed on the markers' plates.
enum class PlatePrint { kMarkers, kBlank };

struct PlateGeom {
  int geom{0};  ///< index of the geom in MuJoCo's model
  int id{0};    ///< id of the marker
};

/// Renders the robot's camera; the robot's body is not in the picture. One per thread.
class Renderer {
 public:
  /// @param physics  physics of `world`; must outlive the renderer.
  Renderer(const World& world, const MarkerPrint& print, PlatePrint plate_print,
           const Pinhole& pinhole, Physics& physics);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  /// 8-bit RGB, top row first; valid until the next call.
  /// @param world_from_camera  optical frame: x right, y down, z forward.
  const cv::Mat& render(const Eigen::Isometry3d& world_from_camera);

 private:
  void place_camera();
  void read_view();

  Physics& physics_;
  GlContext gl_;
  PlatePrints prints_;
  std::vector<PlateGeom> plates_;
  mjvOption options_{};
  mjvScene scene_{};
  mjrContext context_{};
  cv::Mat bottom_up_;
  cv::Mat depth_bottom_up_;
  View view_{};
};

}  // namespace waymark
