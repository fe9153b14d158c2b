// SPDX-License-Identifier: BSD-3-Clause
// Pictures of a board as a known camera takes them: the printed sheet, warped.
#pragma once

#include "common/random/random.hpp"
#include "common/robot/camera_model.hpp"
#include "marker_sheet/pdf_pages.hpp"

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include <vector>

namespace waymark::calibrate {

/// A lens that differs from all default assumptions.
inline CameraConfig known_camera() {
  CameraConfig camera;
  camera.fx_px = 512.3;
  camera.fy_px = 514.9;
  camera.cx_px = 326.2;
  camera.cy_px = 236.4;
  camera.distortion = {-0.12, 0.05, 0.0006, -0.0004, 0.0};
  return camera;
}

/// Where a board is held: its middle in the middle `share` of the image, turned by up to
/// `most_tilt_rad` about both axes.
inline std::vector<Eigen::Isometry3d> hand_held(int num_views, double share, double most_tilt_rad,
                                                Random& random,
                                                const CameraConfig& camera = known_camera()) {
  std::vector<Eigen::Isometry3d> views;
  for (int i = 0; i < num_views; ++i) {
    const double z_m = random.uniform(0.28, 0.45);
    // The ninths of that area in turn.
    const double u = 0.5 + share * ((i % 3 + random.uniform()) / 3.0 - 0.5);
    const double v = 0.5 + share * ((i / 3 % 3 + random.uniform()) / 3.0 - 0.5);
    const Eigen::Vector3d middle_m{(u * camera.width_px - camera.cx_px) / camera.fx_px * z_m,
                                   (v * camera.height_px - camera.cy_px) / camera.fy_px * z_m, z_m};
    const BoardOptions board;
    Eigen::Isometry3d view = Eigen::Isometry3d::Identity();
    view.translate(middle_m);
    view.rotate(
        Eigen::AngleAxisd{random.uniform(-most_tilt_rad, most_tilt_rad), Eigen::Vector3d::UnitY()});
    view.rotate(
        Eigen::AngleAxisd{random.uniform(-most_tilt_rad, most_tilt_rad), Eigen::Vector3d::UnitX()});
    view.rotate(Eigen::AngleAxisd{random.uniform(-0.4, 0.4), Eigen::Vector3d::UnitZ()});
    view.translate(Eigen::Vector3d{-3.5 * board.square_m, -2.5 * board.square_m, 0.0});
    views.push_back(view);
  }
  return views;
}

class BoardRenderer {
 public:
  explicit BoardRenderer(const CameraConfig& camera) : camera_{camera} {
    const marker_sheet::Pattern pattern = marker_sheet::board_pattern({});
    const marker_sheet::SheetLayout layout = marker_sheet::layout_of(pattern);
    const marker_sheet::Sheet sheet = marker_sheet::draw_picture(pattern, 25.4 * kPxPerMm);
    sheet_ = sheet.picture;
    corner_px_ = kPxPerMm * Eigen::Vector2d{layout.pattern_x_mm, layout.pattern_y_mm};
    const CameraModel lens{camera};
    rays_.create(kFiner * camera.height_px, kFiner * camera.width_px);
    for (int row = 0; row < rays_.rows; ++row) {
      for (int column = 0; column < rays_.cols; ++column) {
        const Eigen::Vector2d raw_px{(column + 0.5) / kFiner - 0.5, (row + 0.5) / kFiner - 0.5};
        const Eigen::Vector2d ray = lens.normalized_from_ideal(lens.ideal_from_raw(raw_px));
        rays_(row, column) = {ray.x(), ray.y()};
      }
    }
  }

  /// A picture with blur of 0.7 px and noise of 2 grey levels.
  cv::Mat picture(const Eigen::Isometry3d& camera_from_board, Random& random) const {
    Eigen::Matrix3d image_from_board;
    image_from_board << camera_from_board.linear().leftCols<2>(), camera_from_board.translation();
    Eigen::Matrix3d sheet_from_board = Eigen::Matrix3d::Identity();
    sheet_from_board.topLeftCorner<2, 2>() *= 1e3 * kPxPerMm;
    sheet_from_board.topRightCorner<2, 1>() = corner_px_ - Eigen::Vector2d::Constant(0.5);
    const Eigen::Matrix3d sheet_from_image = sheet_from_board * image_from_board.inverse();
    cv::Matx33d warp;
    for (int k = 0; k < 9; ++k)
      warp.val[k] = sheet_from_image(k / 3, k % 3);
    cv::Mat places_px;
    cv::perspectiveTransform(rays_, places_px, warp);
    places_px.convertTo(places_px, CV_32F);
    cv::Mat fine;
    cv::remap(sheet_, fine, places_px, {}, cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar{200});
    cv::GaussianBlur(fine, fine, {}, 0.7 * kFiner);
    cv::Mat picture;
    cv::resize(fine, picture, {camera_.width_px, camera_.height_px}, 0.0, 0.0, cv::INTER_AREA);
    cv::Mat noise{picture.size(), CV_32F};
    cv::RNG{random()}.fill(noise, cv::RNG::NORMAL, 20.0, 2.0);
    cv::addWeighted(picture, 0.85, noise, 1.0, 0.0, picture, CV_8U);
    return picture;
  }

 private:
  static constexpr double kPxPerMm = 2.0;  // the resolution at which the nearest board is seen
  static constexpr int kFiner = 2;         // a pixel is the mean of kFiner x kFiner samples

  CameraConfig camera_;
  cv::Mat sheet_{};
  Eigen::Vector2d corner_px_{};  ///< upper left corner of the board in `sheet_`
  cv::Mat_<cv::Vec2d> rays_{};
};

}  // namespace waymark::calibrate
