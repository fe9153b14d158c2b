// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/page/map_page.hpp"

#include "common/geometry/principal_axes.hpp"
#include "viewer/core/drawing/path_points.hpp"
#include "viewer/core/scene/alignment.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::viewer {
namespace {

constexpr int kMargin_px = 60;
constexpr int kHeadingHeight_px = 158;
constexpr int kLegendHeight_px = 320;
constexpr int kNarrowLegendHeight_px = 1200;  // on a page below kMinPageWidth_px
constexpr int kGap_px = 30;
constexpr double kOverviewHeight_px = 600.0;
/// Odometry's path is left out of the strips if it would reduce their scale to less than this
/// share.
constexpr double kMinScaleShare = 0.85;
constexpr int kMinPageWidth_px = 1700;  // the legend needs this
/// Room around the map for the markers' labels.
constexpr double kLabelRoom_px = 74.0;
/// Overlap of neighbouring strips, so that objects at a cut are whole in one of them.
constexpr double kStripOverlap_m = 0.5;

class BoxBuilder {
 public:
  bool is_empty() const { return box_.isEmpty(); }

  void add(const Eigen::Vector2d& point) { box_.extend(point); }

  /// Adds the point if it lies within `reach`.
  void add_within(const Eigen::AlignedBox2d& reach, const Eigen::Vector2d& point) {
    if (reach.contains(point)) box_.extend(point);
  }

  /// The box so far, extended on each side by `share` of its larger side, but at least by
  /// `least_m`.
  Eigen::AlignedBox2d reach(double share, double least_m) const {
    if (box_.isEmpty())
      return {Eigen::Vector2d::Constant(-least_m), Eigen::Vector2d::Constant(least_m)};
    const double margin_m = std::max(least_m, share * box_.sizes().maxCoeff());
    return {box_.min().array() - margin_m, box_.max().array() + margin_m};
  }

  Box box() const {
    if (box_.isEmpty()) return {-1.0, -1.0, 1.0, 1.0};
    return {box_.min().x(), box_.min().y(), box_.max().x(), box_.max().y()};
  }

 private:
  Eigen::AlignedBox2d box_{};
};

/// Adds the outermost known cells of each row, which bound all known cells.
void add_known_cells(const GridMap& map, const Se2& view_from_map, BoxBuilder& bounds) {
  for (int row = 0; row < map.occupancy_percent.rows; ++row) {
    const schar* cells = map.occupancy_percent[row];
    const auto is_known = [&](int column) {
      return cells[column] >= 0;
    };
    int first = 0;
    int last = map.occupancy_percent.cols - 1;
    while (first <= last && !is_known(first))
      ++first;
    while (last > first && !is_known(last))
      --last;
    if (first > last) continue;
    bounds.add(view_from_map * map.cell_centre_m(row, first));
    bounds.add(view_from_map * map.cell_centre_m(row, last));
  }
}

/// Where to look if no cell is known: the first pose, or else the first marker.
std::optional<Eigen::Vector2d> start_of(const PageContent& content) {
  std::optional<Eigen::Vector2d> start;
  if (!content.landmarks.empty()) start = content.landmarks.front().map_from_marker.translation();
  if (!content.estimates.empty()) start = content.estimates.front().map_from_base.translation();
  return start && start->allFinite() ? start : std::nullopt;
}

Box padded(const Box& box, double margin_m) {
  return {box.left_m - margin_m, box.bottom_m - margin_m, box.right_m + margin_m,
          box.top_m + margin_m};
}

struct Folding {
  int num_strips{1};
  double px_per_m{0.0};

  double strip_width_m(const Box& box) const {
    return (box.width_m() + (num_strips - 1) * kStripOverlap_m) / num_strips;
  }
};

/// The number of strips with the largest scale, or a smaller number whose scale is nearly as large.
Folding best_folding(const Box& box, const MapPageStyle& style) {
  Folding best;
  const double width_px = style.page_width_px - 2 * kMargin_px;
  for (int n = 1; n <= style.max_strips; ++n) {
    Folding folding{n, 0.0};
    const double height_px = style.page_height_px - (n - 1) * (kGap_px + kRulerHeight_px);
    folding.px_per_m = std::min({width_px / folding.strip_width_m(box),
                                 height_px / (n * box.height_m()), style.max_scale_px_per_m});
    // More strips cut the map more often, so they need a clearly larger scale.
    if (folding.px_per_m > 1.25 * best.px_per_m) best = folding;
  }
  return best;
}

Box with_label_room(const Box& tight, const MapPageStyle& style) {
  const double rough_px_per_m = best_folding(padded(tight, 0.5), style).px_per_m;
  return padded(tight, kLabelRoom_px / rough_px_per_m);
}

Panel panel_at(const MapViewport& view, int left_px, int top_px) {
  return {view, cv::Rect{cv::Point{left_px, top_px}, view.size_px()}};
}

}  // namespace

PageContent content_of(const Scene& scene) {
  return {.map = scene.map.grid(),
          .landmarks = scene.landmarks,
          .changes = scene.changes.value_or(std::vector<MapChange>{}),
          .estimates = scene.estimates,
          .final_in_map = scene.final_trajectory,
          .truth_in_map = aligned_on_first(scene.estimates, scene.truth),
          .odometry_in_map = aligned_on_first(scene.estimates, scene.odometry),
          .particles = scene.particles};
}

Box bounds(const PageContent& content, const Se2& view_from_map, OdometryPath odometry) {
  BoxBuilder bounds;
  add_known_cells(content.map, view_from_map, bounds);
  const bool has_cells = !bounds.is_empty();
  if (const auto start = start_of(content); !has_cells && start) bounds.add(view_from_map * *start);
  const Eigen::AlignedBox2d reach_of_paths = bounds.reach(2.0, 100.0);
  const Eigen::AlignedBox2d reach_of_markers = has_cells ? bounds.reach(0.1, 3.0) : reach_of_paths;
  for (const Landmark& landmark : content.landmarks)
    bounds.add_within(reach_of_markers, view_from_map * landmark.map_from_marker.translation());
  const auto add_path = [&](const auto& path) {
    for (const auto& pose : path)
      bounds.add_within(reach_of_paths, view_from_map * pose_of(pose).translation());
  };
  add_path(content.estimates);
  add_path(content.final_in_map);
  add_path(content.truth_in_map);
  if (odometry == OdometryPath::kIncluded) add_path(content.odometry_in_map);
  return bounds.box();
}

Se2 view_from_map(const GridMap& map) {
  constexpr double kLong = 5.0;  // least length / width of a long map
  const double kNearlyHorizontal_rad = radians(20);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d sum_of_squares = Eigen::Matrix2d::Zero();
  double count = 0.0;
  for (int row = 0; row < map.occupancy_percent.rows; ++row) {
    for (int column = 0; column < map.occupancy_percent.cols; ++column) {
      if (map.occupancy_percent(row, column) < 0) continue;
      const Eigen::Vector2d point = map.cell_centre_m(row, column);
      sum += point;
      sum_of_squares += point * point.transpose();
      count += 1.0;
    }
  }
  if (count < 2.0) return {};
  const Eigen::Vector2d mean = sum / count;
  const PrincipalAxes axes = principal_axes(sum_of_squares / count - mean * mean.transpose());
  if (axes.values(1) < kLong * kLong * std::max(axes.values(0), 1e-9)) return {};
  Eigen::Vector2d axis = axes.directions.col(1);
  if (axis.x() < 0.0) axis = -axis;
  const double angle_rad = std::atan2(axis.y(), axis.x());
  return std::abs(angle_rad) < kNearlyHorizontal_rad ? Se2{} : Se2{0.0, 0.0, -angle_rad};
}

MapPage lay_out(const PageContent& content, const MapPageStyle& style) {
  const Se2 view_from_map = viewer::view_from_map(content.map);
  // Odometry that would shrink the map is drawn in the overview only.
  const Box whole_box =
      with_label_room(bounds(content, view_from_map, OdometryPath::kIncluded), style);
  Box box = with_label_room(bounds(content, view_from_map, OdometryPath::kLeftOut), style);
  const bool odometry_fits =
      best_folding(whole_box, style).px_per_m >= kMinScaleShare * best_folding(box, style).px_per_m;
  if (odometry_fits) box = whole_box;
  const Folding folding = best_folding(box, style);

  MapPage page{.odometry_in_strips =
                   odometry_fits ? OdometryPath::kIncluded : OdometryPath::kLeftOut};
  int y_px = kHeadingHeight_px;
  const int inner_px = style.page_width_px - 2 * kMargin_px;
  if (folding.num_strips > 1 || !odometry_fits) {
    const double px_per_m =
        std::min(inner_px / whole_box.width_m(), kOverviewHeight_px / whole_box.height_m());
    page.overview = panel_at({view_from_map, whole_box, px_per_m}, kMargin_px, y_px);
    y_px = page.overview->page_px.br().y + 2 * kGap_px;
  }
  const double strip_m = folding.strip_width_m(box);
  int right_px = std::min(kMinPageWidth_px, style.page_width_px) - kMargin_px;
  for (int k = 0; k < folding.num_strips; ++k) {
    Box part = box;
    part.left_m = box.left_m + k * (strip_m - kStripOverlap_m);
    part.right_m = part.left_m + strip_m;
    page.strips.push_back(panel_at({view_from_map, part, folding.px_per_m}, kMargin_px, y_px));
    y_px = page.strips.back().page_px.br().y + kRulerHeight_px + kGap_px;
    right_px = std::max(right_px, page.strips.back().page_px.br().x);
  }
  if (page.overview) right_px = std::max(right_px, page.overview->page_px.br().x);
  if (folding.num_strips == 1) {  // a single small map stands in the middle
    cv::Rect& only = page.strips.front().page_px;
    only.x += (right_px - only.br().x) / 2;
  }
  page.heading_px = {kMargin_px, 0, right_px - kMargin_px, kHeadingHeight_px};
  const bool is_narrow = right_px + kMargin_px < kMinPageWidth_px;
  page.legend_px = {kMargin_px, y_px - kGap_px, right_px - kMargin_px,
                    is_narrow ? kNarrowLegendHeight_px : kLegendHeight_px};
  page.size_px = {right_px + kMargin_px, page.legend_px.br().y};
  return page;
}

}  // namespace waymark::viewer
