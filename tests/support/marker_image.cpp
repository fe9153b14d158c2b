// SPDX-License-Identifier: BSD-3-Clause
#include "support/marker_image.hpp"

#include <opencv2/aruco.hpp>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace waymark::testing {
namespace {

constexpr int kRaysPerSide = 8;
constexpr int kMarginPx = 5;

cv::Ptr<cv::aruco::Dictionary> dictionary_named(const std::string& name) {
  static const std::map<std::string, cv::aruco::PREDEFINED_DICTIONARY_NAME> kKnown{
      {"DICT_4X4_50", cv::aruco::DICT_4X4_50},
      {"DICT_6X6_250", cv::aruco::DICT_6X6_250},
      {"DICT_APRILTAG_36h11", cv::aruco::DICT_APRILTAG_36h11}};
  return cv::aruco::getPredefinedDictionary(kKnown.at(name));
}

cv::Matx33d matrix_of(const CameraConfig& camera) {
  return {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
}

/// Brightness of the marker plane at a place in module units from the black square's top left.
double brightness(const cv::Mat& cells, const ImageLook& look, double column, double row) {
  const double modules = cells.cols;
  if (column >= 0 && column < modules && row >= 0 && row < modules) {
    return cells.at<std::uint8_t>(static_cast<int>(row), static_cast<int>(column)) != 0
               ? look.white
               : look.black;
  }
  const double zone = look.quiet_zone_modules;
  const bool in_zone =
      column >= -zone && column < modules + zone && row >= -zone && row < modules + zone;
  return in_zone ? look.white : look.wall;
}

/// Pixels that the marker with its quiet zone can touch.
cv::Rect region_of(const RobotConfig& robot, const Eigen::Isometry3d& camera_from_marker,
                   double half_side_m) {
  std::vector<cv::Point3d> outline;
  constexpr int kPointsPerSide = 10;  // a lens bends the sides
  for (int i = -kPointsPerSide; i <= kPointsPerSide; ++i) {
    const double at = half_side_m * i / kPointsPerSide;
    for (const Eigen::Vector3d& point :
         {Eigen::Vector3d{at, half_side_m, 0}, Eigen::Vector3d{at, -half_side_m, 0},
          Eigen::Vector3d{half_side_m, at, 0}, Eigen::Vector3d{-half_side_m, at, 0}}) {
      const Eigen::Vector3d seen = camera_from_marker * point;
      if (seen.z() > 0.05) outline.emplace_back(seen.x(), seen.y(), seen.z());
    }
  }
  if (outline.empty()) return {};
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(outline, cv::Vec3d{}, cv::Vec3d{}, matrix_of(robot.camera),
                    robot.camera.distortion, pixels);
  double low_u = 1e9;
  double low_v = 1e9;
  double high_u = -1e9;
  double high_v = -1e9;
  for (const cv::Point2d& pixel : pixels) {
    low_u = std::min(low_u, pixel.x);
    high_u = std::max(high_u, pixel.x);
    low_v = std::min(low_v, pixel.y);
    high_v = std::max(high_v, pixel.y);
  }
  const auto whole = [](double value) {
    return static_cast<int>(std::clamp(value, -1e5, 1e5));
  };
  const cv::Point low{whole(low_u) - kMarginPx, whole(low_v) - kMarginPx};
  const cv::Point high{whole(high_u) + kMarginPx, whole(high_v) + kMarginPx};
  return cv::Rect{low, high} & cv::Rect{0, 0, robot.camera.width_px, robot.camera.height_px};
}

/// Directions (x, y, z = 1 in the optical frame) of the rays through a region, row by row. Rows and
/// columns of rays are staggered, so that upright edges are sampled at 64 places per pixel, too.
std::vector<cv::Point2d> rays_through(const CameraConfig& camera, const cv::Rect& region) {
  const auto stagger = [](int line) {
    return ((line * 5 % kRaysPerSide + 0.5) / kRaysPerSide - 0.5) / kRaysPerSide;
  };
  std::vector<cv::Point2d> raw;
  for (int row = 0; row < region.height * kRaysPerSide; ++row) {
    for (int column = 0; column < region.width * kRaysPerSide; ++column) {
      raw.emplace_back(region.x + (column + 0.5) / kRaysPerSide - 0.5 + stagger(row),
                       region.y + (row + 0.5) / kRaysPerSide - 0.5 + stagger(column));
    }
  }
  std::vector<cv::Point2d> rays;
  if (std::ranges::all_of(camera.distortion, [](double k) { return k == 0.0; })) {
    for (const cv::Point2d& p : raw)
      rays.emplace_back((p.x - camera.cx_px) / camera.fx_px, (p.y - camera.cy_px) / camera.fy_px);
  } else {
    cv::undistortPoints(raw, rays, matrix_of(camera), camera.distortion, cv::noArray(),
                        cv::noArray(), cv::TermCriteria{cv::TermCriteria::COUNT, 30, 0});
  }
  return rays;
}

void paint(const RobotConfig& robot, const PlacedMarker& marker, const ImageLook& look,
           cv::Mat& image) {
  const auto dictionary = dictionary_named(robot.markers.dictionary);
  const int modules = dictionary->markerSize + 2;
  cv::Mat cells;
  cv::aruco::drawMarker(dictionary, marker.id, modules, cells, 1);
  const double module_m = robot.markers.size_m / modules;

  const cv::Rect region = region_of(robot, marker.camera_from_marker,
                                    (0.5 * modules + look.quiet_zone_modules) * module_m);
  if (region.empty()) return;
  const std::vector<cv::Point2d> rays = rays_through(robot.camera, region);

  cv::Mat fine(region.height * kRaysPerSide, region.width * kRaysPerSide, CV_32F);
  const Eigen::Isometry3d marker_from_camera = marker.camera_from_marker.inverse();
  const Eigen::Vector3d eye = marker_from_camera.translation();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Eigen::Vector3d ray =
        marker_from_camera.linear() * Eigen::Vector3d{rays[i].x, rays[i].y, 1.0};
    const double distance = -eye.z() / ray.z();
    const Eigen::Vector3d hit = eye + distance * ray;
    const bool on_plane = distance > 0 && eye.z() > 0;
    fine.at<float>(static_cast<int>(i) / fine.cols, static_cast<int>(i) % fine.cols) =
        static_cast<float>(on_plane ? brightness(cells, look, hit.x() / module_m + 0.5 * modules,
                                                 0.5 * modules - hit.y() / module_m)
                                    : look.wall);
  }
  if (look.blur_sigma_px > 0) {
    cv::GaussianBlur(fine, fine, {}, look.blur_sigma_px * kRaysPerSide, 0, cv::BORDER_REPLICATE);
  }
  cv::resize(fine, image(region), region.size(), 0, 0, cv::INTER_AREA);
}

}  // namespace

cv::Mat render_markers(const RobotConfig& robot, const std::vector<PlacedMarker>& markers,
                       const ImageLook& look, Random random) {
  cv::Mat image{robot.camera.height_px, robot.camera.width_px, CV_32F, cv::Scalar::all(look.wall)};
  for (const PlacedMarker& marker : markers)
    paint(robot, marker, look, image);
  if (look.noise_sigma > 0) {
    for (int row = 0; row < image.rows; ++row) {
      for (int column = 0; column < image.cols; ++column) {
        image.at<float>(row, column) += static_cast<float>(random.normal(0.0, look.noise_sigma));
      }
    }
  }
  cv::Mat gray;
  image.convertTo(gray, CV_8U);
  return gray;
}

Eigen::Isometry3d base_from_upright_marker(const Eigen::Vector3d& centre_in_base_m,
                                           double facing_yaw_rad) {
  Eigen::Isometry3d base_from_marker = Eigen::Isometry3d::Identity();
  base_from_marker.translation() = centre_in_base_m;
  const Eigen::Vector3d out{std::cos(facing_yaw_rad), std::sin(facing_yaw_rad), 0.0};
  base_from_marker.linear().col(2) = out;
  base_from_marker.linear().col(1) = Eigen::Vector3d::UnitZ();
  base_from_marker.linear().col(0) = Eigen::Vector3d::UnitZ().cross(out);
  return base_from_marker;
}

}  // namespace waymark::testing
