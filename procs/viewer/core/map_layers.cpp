// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/map_layers.hpp"

#include "viewer/core/canvas.hpp"
#include "viewer/core/palette.hpp"

#include <Eigen/Eigenvalues>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace waymark::viewer {
namespace {

const Se2& pose_of(const EstimatedPose& pose) {
  return pose.map_from_base;
}

const Se2& pose_of(const TimedPose& pose) {
  return pose.frame_from_base;
}

/// The path on the page, thinned to steps that can be seen.
template <class Pose>
std::vector<cv::Point2d> thinned(const View& view, const std::vector<Pose>& path) {
  constexpr double kStep_px = 3.0;
  std::vector<cv::Point2d> points;
  for (const Pose& pose : path) {
    const cv::Point2d point = view(pose_of(pose).translation());
    if (points.empty() || cv::norm(point - points.back()) >= kStep_px) points.push_back(point);
  }
  return points;
}

cv::Scalar colour_of(Health health) {
  switch (health) {
    case Health::kInitialising:
      return palette::kInitialising;
    case Health::kDegenerate:
      return palette::kDegenerate;
    case Health::kLost:
      return palette::kLost;
    case Health::kTracking:
    case Health::kUnknown:
      break;
  }
  return palette::kNoHealth;
}

/// Every so many metres of the path.
std::vector<EstimatedPose> spaced(const std::vector<EstimatedPose>& estimates, double spacing_m) {
  std::vector<EstimatedPose> chosen;
  double travelled_m = 0.0;
  for (std::size_t i = 1; i < estimates.size(); ++i) {
    travelled_m +=
        (estimates[i].map_from_base.translation() - estimates[i - 1].map_from_base.translation())
            .norm();
    if (travelled_m < spacing_m) continue;
    chosen.push_back(estimates[i]);
    travelled_m = 0.0;
  }
  return chosen;
}

/// Semi-axes [m], longer first, and the longer one's direction in the map.
struct Ellipse {
  double major_m, minor_m, angle_rad;
};

Ellipse three_sigma(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes{covariance.topLeftCorner<2, 2>()};
  const Eigen::Vector2d sigma_m = axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const Eigen::Vector2d axis = axes.eigenvectors().col(1);
  return {3.0 * sigma_m(1), 3.0 * sigma_m(0), std::atan2(axis.y(), axis.x())};
}

}  // namespace

cv::Mat colour_cells(const GridMap& map) {
  std::array<Colour, 101> colours;
  for (int percent = 0; percent <= 100; ++percent)
    colours[static_cast<std::size_t>(percent)] =
        to_colour(blend(palette::kFree, palette::kOccupied, percent / 100.0));
  const Colour unknown = to_colour(palette::kUnknown);
  cv::Mat_<Colour> image(map.occupancy_percent.size());
  for (int row = 0; row < image.rows; ++row) {
    for (int column = 0; column < image.cols; ++column) {
      const int percent = map.occupancy_percent(row, column);
      image(row, column) =
          percent < 0 ? unknown : colours[static_cast<std::size_t>(std::min(percent, 100))];
    }
  }
  return image;
}

void draw_cells(cv::Mat& panel, const View& view, const GridMap& map, const cv::Mat& cell_colours) {
  panel.setTo(palette::kUnknown);
  if (map.empty()) return;
  cv::warpAffine(cell_colours, panel, cv::Mat{view.page_from_cells(map)}, panel.size(),
                 view.px_per_m * map.resolution_m < 1.0 ? cv::INTER_LINEAR : cv::INTER_NEAREST,
                 cv::BORDER_CONSTANT, palette::kUnknown);
}

void draw_health(cv::Mat& panel, const View& view, const std::vector<EstimatedPose>& estimates,
                 int width_px) {
  for (std::size_t begin = 0; begin < estimates.size();) {
    const Health health = estimates[begin].health;
    std::vector<EstimatedPose> stretch;
    std::size_t end = begin;
    for (; end < estimates.size() && estimates[end].health == health; ++end)
      stretch.push_back(estimates[end]);
    if (health != Health::kTracking) {
      std::vector<cv::Point2d> points = thinned(view, stretch);
      if (points.size() == 1) points.push_back(points.front());
      draw_polyline(panel, points, {colour_of(health), width_px});
    }
    begin = end;
  }
}

void draw_paths(cv::Mat& panel, const View& view, const PageContent& content,
                const StrokeWidths& widths) {
  draw_polyline(panel, thinned(view, content.truth_in_map), {palette::kTrue, widths.true_px});
  draw_polyline(panel, thinned(view, content.odometry_in_map),
                {palette::kOdometry, widths.odometry_px});
  draw_polyline(panel, thinned(view, content.estimates),
                {palette::kEstimated, widths.estimated_px});
}

void draw_particles(cv::Mat& panel, const View& view, const std::vector<Se2>& particles) {
  for (const Se2& particle : particles)
    fill_circle(panel, view(particle.translation()), 2.0, palette::kParticle);
}

int ellipse_magnification(const std::vector<EstimatedPose>& estimates, double spacing_m,
                          double px_per_m) {
  constexpr double kVisible_px = 26.0;
  std::vector<double> radii_px;
  for (const EstimatedPose& pose : spaced(estimates, spacing_m))
    radii_px.push_back(px_per_m * three_sigma(pose.covariance).major_m);
  if (radii_px.empty()) return 1;
  std::nth_element(radii_px.begin(), radii_px.begin() + radii_px.size() / 2, radii_px.end());
  const double median_px = radii_px[radii_px.size() / 2];
  for (const int magnification : {1, 2, 5, 10, 20}) {
    if (magnification * median_px >= kVisible_px) return magnification;
  }
  return 50;
}

void draw_ellipses(cv::Mat& panel, const View& view, const std::vector<EstimatedPose>& estimates,
                   double spacing_m, int magnification) {
  for (const EstimatedPose& pose : spaced(estimates, spacing_m)) {
    const Ellipse ellipse = three_sigma(pose.covariance);
    const double scale = magnification * view.px_per_m;
    const cv::Point2d centre = view(pose.map_from_base.translation());
    const cv::Point2d along = view.direction(ellipse.angle_rad);
    const cv::Point2d across{-along.y, along.x};
    std::vector<cv::Point2d> outline;
    for (int degree = 0; degree <= 360; degree += 10) {
      const double angle = radians(degree);
      outline.push_back(centre + scale * ellipse.major_m * std::cos(angle) * along +
                        scale * ellipse.minor_m * std::sin(angle) * across);
    }
    draw_polyline(panel, outline, {palette::kEllipse, 2});
  }
}

void draw_ends(cv::Mat& panel, const View& view, const std::vector<EstimatedPose>& estimates) {
  if (estimates.empty()) return;
  const cv::Point2d start = view(estimates.front().map_from_base.translation());
  fill_circle(panel, start, 12.0, palette::kPage);
  draw_circle(panel, start, 11.0, {palette::kEstimated, 5});
  const Se2& last = estimates.back().map_from_base;
  const cv::Point2d end = view(last.translation());
  const cv::Point2d ahead = view.direction(last.theta());
  const cv::Point2d left{ahead.y, -ahead.x};
  const auto arrow = [&](double size_px) {
    return std::array<cv::Point2d, 4>{
        end + 1.3 * size_px * ahead, end - size_px * ahead + size_px * left,
        end - 0.5 * size_px * ahead, end - size_px * ahead - size_px * left};
  };
  fill_polygon(panel, arrow(21.0), palette::kPage);
  fill_polygon(panel, arrow(16.0), palette::kEstimated);
}

void draw_plates(cv::Mat& panel, const View& view, const std::vector<Landmark>& landmarks,
                 double marker_size_m, int width_px) {
  for (const Landmark& landmark : landmarks) {
    const cv::Point2d centre = view(landmark.map_from_marker.translation());
    const cv::Point2d facing = view.direction(landmark.map_from_marker.theta());
    const cv::Point2d along{-facing.y, facing.x};
    const double half_px = std::max(0.5 * marker_size_m * view.px_per_m, 3.0);
    draw_line(panel, centre - half_px * along, centre + half_px * along,
              {palette::kMarker, width_px});
    // A short peg tells the side that the marker faces.
    draw_line(panel, centre, centre + 1.8 * width_px * facing,
              {palette::kMarker, std::max(1, width_px / 2)});
  }
}

}  // namespace waymark::viewer
