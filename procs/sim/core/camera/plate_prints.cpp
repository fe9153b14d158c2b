// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/camera/plate_prints.hpp"

#include <Eigen/LU>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace waymark {
namespace {

constexpr int kWhite = 255;
constexpr int kRaysPerSide = 8;
// A pixel shows the plate, not something in front of it, if the rendered inverse depth differs from
// the plate's by at most this share.
constexpr double kDepthTolerance = 0.002;

/// Offsets [px] of a pixel's 8 x 8 rays from its centre. The grid is sheared, so that its rays have
/// 64 different u and 64 different v, not 8: edges along pixel rows or columns are sampled 8 times
/// finer.
using RayPattern = std::array<Eigen::Vector2d, kRaysPerSide * kRaysPerSide>;

RayPattern ray_pattern() {
  constexpr double kRays = kRaysPerSide;
  RayPattern pattern;
  std::size_t next = 0;
  for (int row = 0; row < kRaysPerSide; ++row) {
    for (int column = 0; column < kRaysPerSide; ++column) {
      pattern[next++] = {(column + (row + 0.5) / kRays) / kRays - 0.5,
                         (row + (column + 0.5) / kRays) / kRays - 0.5};
    }
  }
  return pattern;
}

/// Homography from homogeneous pixels to homogeneous texels (column, row; 0 is the outer edge of
/// the first texel). The third coordinate is the plate's inverse depth 1/z [1/m] at the pixel.
Eigen::Matrix3d texel_from_pixel(const Pinhole& pinhole, const Eigen::Isometry3d& camera_from_plate,
                                 double texels_per_m, const cv::Size& size) {
  Eigen::Matrix3d camera_from_plane;
  camera_from_plane << camera_from_plate.linear().leftCols<2>(), camera_from_plate.translation();
  Eigen::Matrix3d texel_from_plane;
  texel_from_plane << texels_per_m, 0.0, 0.5 * size.width, 0.0, -texels_per_m, 0.5 * size.height,
      0.0, 0.0, 1.0;
  Eigen::Matrix3d ray_from_pixel;
  const double f = pinhole.focal_px;
  ray_from_pixel << 1.0 / f, 0.0, -pinhole.cx_px / f, 0.0, 1.0 / f, -pinhole.cy_px / f, 0.0, 0.0,
      1.0;
  return texel_from_plane * camera_from_plane.inverse() * ray_from_pixel;
}

/// Pixels that may show the plate; all pixels when a part of it lies behind the camera.
cv::Rect region_of(const Pinhole& pinhole, const Eigen::Isometry3d& camera_from_plate,
                   double half_m) {
  constexpr double kNearest_m = 0.01;
  const cv::Rect all{0, 0, pinhole.width_px, pinhole.height_px};
  Eigen::AlignedBox2d box;
  bool is_in_front = false;
  bool is_behind = false;
  for (const double x : {-half_m, half_m}) {
    for (const double y : {-half_m, half_m}) {
      const Eigen::Vector3d corner = camera_from_plate * Eigen::Vector3d{x, y, 0.0};
      (corner.z() > kNearest_m ? is_in_front : is_behind) = true;
      if (corner.z() <= kNearest_m) continue;
      box.extend(Eigen::Vector2d{pinhole.cx_px + pinhole.focal_px * corner.x() / corner.z(),
                                 pinhole.cy_px + pinhole.focal_px * corner.y() / corner.z()});
    }
  }
  if (!is_in_front) return {};
  if (is_behind) return all;
  const Eigen::AlignedBox2d picture{Eigen::Vector2d{-1.0, -1.0},
                                    Eigen::Vector2d{pinhole.width_px, pinhole.height_px}};
  box = box.intersection(picture);
  if (box.isEmpty()) return {};
  const Eigen::Vector2i low = box.min().array().floor().cast<int>();
  const Eigen::Vector2i high = box.max().array().ceil().cast<int>();
  return cv::Rect{cv::Point{low.x(), low.y()}, cv::Point{high.x() + 1, high.y() + 1}} & all;
}

int texel_at(double homogeneous, double scale, int count) {
  return std::clamp(static_cast<int>(std::floor(homogeneous / scale)), 0, count - 1);
}

/// Mean grey level of a print over a pixel's area.
class Sampler {
 public:
  Sampler(const cv::Mat& texels, const cv::Mat& sums, const Eigen::Matrix3d& texel_from_pixel)
      : texels_{texels}, sums_{sums}, texel_from_pixel_{texel_from_pixel} {
    const RayPattern pattern = ray_pattern();
    for (std::size_t i = 0; i < pattern.size(); ++i)
      steps_[i] = texel_from_pixel.leftCols<2>() * pattern[i];
  }

  /// @param centre  texel_from_pixel * pixel, with a positive third coordinate.
  double mean_over_pixel(const Eigen::Vector3d& centre) const {
    const cv::Rect touched = texels_of(centre);
    const int first = texels_.at<std::uint8_t>(touched.tl());
    if (sum_of(touched) == first * touched.area()) return first;
    double sum = 0.0;
    for (const Eigen::Vector3d& step : steps_) {
      const Eigen::Vector3d place = centre + step;
      sum += texels_.at<std::uint8_t>(texel_at(place.y(), place.z(), texels_.rows),
                                      texel_at(place.x(), place.z(), texels_.cols));
    }
    return sum / static_cast<double>(steps_.size());
  }

 private:
  /// Rectangle around all texels under a pixel.
  cv::Rect texels_of(const Eigen::Vector3d& centre) const {
    int left = texels_.cols, right = 0, top = texels_.rows, bottom = 0;
    for (const double u : {-0.5, 0.5}) {
      for (const double v : {-0.5, 0.5}) {
        const Eigen::Vector3d corner =
            centre + u * texel_from_pixel_.col(0) + v * texel_from_pixel_.col(1);
        const int column = texel_at(corner.x(), corner.z(), texels_.cols);
        const int row = texel_at(corner.y(), corner.z(), texels_.rows);
        left = std::min(left, column);
        right = std::max(right, column);
        top = std::min(top, row);
        bottom = std::max(bottom, row);
      }
    }
    return {left, top, right - left + 1, bottom - top + 1};
  }

  int sum_of(const cv::Rect& area) const {
    return sums_.at<int>(area.br()) - sums_.at<int>(area.y, area.br().x) -
           sums_.at<int>(area.br().y, area.x) + sums_.at<int>(area.tl());
  }

  const cv::Mat& texels_;
  const cv::Mat& sums_;
  const Eigen::Matrix3d& texel_from_pixel_;
  std::array<Eigen::Vector3d, kRaysPerSide * kRaysPerSide> steps_{};
};

void darken(cv::Vec3b& pixel, double grey) {
  for (int channel = 0; channel < 3; ++channel)
    pixel[channel] = cv::saturate_cast<std::uint8_t>(pixel[channel] * grey / kWhite);
}

}  // namespace

PlatePrints::PlatePrints(const std::map<int, cv::Mat>& pictures, double plate_size_m)
    : plate_size_m_{plate_size_m} {
  for (const auto& [id, picture] : pictures) {
    Print& print = print_of_id_[id];
    print.texels = picture.clone();
    cv::integral(picture, print.sums, CV_32S);
  }
}

void PlatePrints::print(int id, const Eigen::Isometry3d& world_from_plate, View& view) const {
  const Print& print = print_of_id_.at(id);
  const cv::Mat& texels = print.texels;
  const Eigen::Isometry3d camera_from_plate = view.world_from_camera.inverse() * world_from_plate;
  const bool shows_its_back =
      camera_from_plate.linear().col(2).dot(camera_from_plate.translation()) >= 0.0;
  const cv::Rect region = region_of(view.pinhole, camera_from_plate, 0.5 * plate_size_m_);
  if (shows_its_back || region.empty()) return;
  const Eigen::Matrix3d to_texel =
      texel_from_pixel(view.pinhole, camera_from_plate, texels.cols / plate_size_m_, texels.size());
  const Sampler sampler{texels, print.sums, to_texel};
  for (int v = region.y; v < region.br().y; ++v) {
    for (int u = region.x; u < region.br().x; ++u) {
      const Eigen::Vector3d texel = to_texel * Eigen::Vector3d(u, v, 1.0);
      const double inverse_depth = texel.z();
      const bool is_on_plate = inverse_depth > 0.0 && texel.x() >= 0.0 && texel.y() >= 0.0 &&
                               texel.x() < texels.cols * inverse_depth &&
                               texel.y() < texels.rows * inverse_depth;
      if (!is_on_plate) continue;
      const double rendered = double{view.inverse_depth_per_m.at<float>(v, u)};
      if (std::abs(rendered - inverse_depth) > kDepthTolerance * inverse_depth) continue;
      darken(view.rgb.at<cv::Vec3b>(v, u), sampler.mean_over_pixel(texel));
    }
  }
}

}  // namespace waymark
