// SPDX-License-Identifier: BSD-3-Clause
// Draws the markers onto the blank plates of a rendered picture.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>

#include <map>

namespace waymark {

/// A pinhole with square pixels; pixel centres are integers.
struct Pinhole {
  int width_px{0};
  int height_px{0};
  double focal_px{0.0};
  double cx_px{0.0};
  double cy_px{0.0};
};

/// A rendered picture with its depth.
struct View {
  Pinhole pinhole{};
  Eigen::Isometry3d world_from_camera{};  ///< optical frame: x right, y down, z forward
  cv::Mat rgb{};                          ///< 8 bit, three channels
  cv::Mat inverse_depth_per_m{};          ///< float: 1/z at each pixel's centre
};

/// Draws the printed pictures of all marker ids. Each camera pixel gets the mean of the print over
/// the pixel's area, as on a sensor. OpenGL's texture filters average over fewer samples: they
/// would displace edges along a row of pixels by up to 0.04 px, equally for all markers at one
/// height.
class PlatePrints {
 public:
  /// @param pictures       8-bit grey pictures of whole plates, top row first, of at most a million
  ///                       texels each, by id.
  /// @param plate_size_m   side of a plate.
  PlatePrints(const std::map<int, cv::Mat>& pictures, double plate_size_m);

  /// Multiplies the pixels of the view that show a plate by the grey level printed there.
  /// @param world_from_plate  frame of the plate's front face: origin in its middle, x right, y up,
  ///                          z away from the wall.
  void print(int id, const Eigen::Isometry3d& world_from_plate, View& view) const;

 private:
  struct Print {
    cv::Mat texels{};
    cv::Mat sums{};  ///< integral image
  };

  std::map<int, Print> print_of_id_;
  double plate_size_m_;
};

}  // namespace waymark
