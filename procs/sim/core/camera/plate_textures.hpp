// SPDX-License-Identifier: BSD-3-Clause
// The markers' pictures as OpenGL textures of our own.
#pragma once

#include <mujoco/mujoco.h>
#include <opencv2/core/mat.hpp>

#include <map>
#include <vector>

namespace waymark {

/// One texture per id, as many as there are. MuJoCo 2.2.2 has room for 100 textures per context and
/// silently shows wrong ones beyond. So the model has a single placeholder, and for every frame the
/// nearest markers get a place in the context's table.
class PlateTextures {
 public:
  /// @param pictures  8-bit grey, top row first. Needs a current OpenGL context.
  explicit PlateTextures(const std::map<int, cv::Mat>& pictures);
  ~PlateTextures();
  PlateTextures(const PlateTextures&) = delete;
  PlateTextures& operator=(const PlateTextures&) = delete;

  /// Gives the scene's plates their textures; those that find no room stay blank (there are 90
  /// nearer ones).
  /// @param id_of_geom  marker id for each geom of the model, or kNoMarker.
  void assign(const std::vector<int>& id_of_geom, mjvScene& scene, mjrContext& context) const;

 private:
  std::map<int, unsigned int> texture_of_id_;
};

}  // namespace waymark
