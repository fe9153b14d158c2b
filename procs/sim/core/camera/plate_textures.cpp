// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/camera/plate_textures.hpp"

#include "common/sensors/sensors.hpp"

#define GL_GLEXT_PROTOTYPES  // libOSMesa exports what the headers hide otherwise
#include <GL/gl.h>
#include <GL/glext.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace waymark {
namespace {

constexpr int kFirstSlot = 8;  // the model's own textures come first
constexpr int kSlots = 98;     // of the 100 in mjrContext

/// Trilinear with full anisotropy: markers are seen at 60 to 80 degrees, where plain mipmaps blur
/// away half of the range of detection. Repeating, because MuJoCo's coordinates run from -1 to 0.
unsigned int upload(const cv::Mat& picture) {
  unsigned int texture = 0;
  glGenTextures(1, &texture);
  glBindTexture(GL_TEXTURE_2D, texture);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_REPEAT);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTexParameterf(GL_TEXTURE_2D, GL_TEXTURE_MAX_ANISOTROPY_EXT, 16.0F);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTexImage2D(GL_TEXTURE_2D, 0, GL_LUMINANCE8, picture.cols, picture.rows, 0, GL_LUMINANCE,
               GL_UNSIGNED_BYTE, picture.data);
  glGenerateMipmap(GL_TEXTURE_2D);
  return texture;
}

double squared_distance(const mjvGeom& geom, const mjvScene& scene) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i)
    sum += std::pow(double{geom.pos[i]} - double{scene.camera[0].pos[i]}, 2);
  return sum;
}

}  // namespace

PlateTextures::PlateTextures(const std::map<int, cv::Mat>& pictures) {
  for (const auto& [id, picture] : pictures)
    texture_of_id_[id] = upload(picture);
}

PlateTextures::~PlateTextures() {
  for (const auto& [id, texture] : texture_of_id_)
    glDeleteTextures(1, &texture);
}

void PlateTextures::assign(const std::vector<int>& id_of_geom, mjvScene& scene,
                           mjrContext& context) const {
  struct Plate {
    double squared_distance_m2;
    int scene_index;
    int id;
  };

  std::vector<Plate> plates;
  for (int i = 0; i < scene.ngeom; ++i) {
    const mjvGeom& geom = scene.geoms[i];
    if (geom.objtype != mjOBJ_GEOM) continue;
    const int id = id_of_geom[static_cast<std::size_t>(geom.objid)];
    if (id != kNoMarker) plates.push_back({squared_distance(geom, scene), i, id});
  }
  std::sort(plates.begin(), plates.end(), [](const Plate& a, const Plate& b) {
    return std::pair{a.squared_distance_m2, a.scene_index} <
           std::pair{b.squared_distance_m2, b.scene_index};
  });

  std::map<int, int> slot_of_id;
  for (const Plate& plate : plates) {
    const int next = kFirstSlot + static_cast<int>(slot_of_id.size());
    if (next >= kSlots && !slot_of_id.contains(plate.id)) {
      scene.geoms[plate.scene_index].texid = -1;
      continue;
    }
    const int slot = slot_of_id.try_emplace(plate.id, next).first->second;
    context.texture[slot] = texture_of_id_.at(plate.id);
    context.textureType[slot] = mjTEXTURE_2D;
    scene.geoms[plate.scene_index].texid = slot;
  }
}

}  // namespace waymark
