// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/layers/path_marks.hpp"

#include "common/geometry/principal_axes.hpp"
#include "viewer/core/drawing/canvas.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/drawing/path_points.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>

namespace waymark::viewer {
namespace {

// Sizes of marks where mark_scale() is 1.
constexpr double kLongestBar_px = 34.0;   // half length
constexpr double kShortestBar_px = 11.0;  // half length
constexpr int kBarWidth_px = 6;
/// Largest number of marks of one kind; more would hide the map.
constexpr std::size_t kMaxMarks = 60;

bool is_finite(const EstimatedPose& pose) {
  return pose.map_from_base.translation().allFinite();
}

bool has_ellipse(const EstimatedPose& pose) {
  return is_finite(pose) && two_sigma_ellipse(pose.covariance);
}

bool has_weak_axis(const EstimatedPose& pose) {
  return is_finite(pose) && pose.weak_axis && pose.weak_axis->direction.allFinite() &&
         pose.weak_axis->information >= 0.0;
}

double distance_m(const EstimatedPose& a, const EstimatedPose& b) {
  return (a.map_from_base.translation() - b.map_from_base.translation()).norm();
}

double major_m(const EstimatedPose& pose) {
  return two_sigma_ellipse(pose.covariance)->major_m;
}

/// 1, 2 or 5 times a power of ten: the smallest that is not shorter than the limit.
double round_length_from(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= limit) return factor * power;
  }
  return 10.0 * power;
}

std::vector<EstimatedPose> ellipse_candidates(const std::vector<EstimatedPose>& estimates,
                                              double spacing_m) {
  std::vector<EstimatedPose> chosen;
  double travelled_m = 0.0;
  const EstimatedPose* before = nullptr;
  for (const EstimatedPose& pose : estimates) {
    if (!has_ellipse(pose)) continue;
    if (before != nullptr) travelled_m += distance_m(*before, pose);
    before = &pose;
    if (travelled_m < spacing_m) continue;
    chosen.push_back(pose);
    travelled_m = 0.0;
  }
  if (before != nullptr && (chosen.empty() || chosen.back().time != before->time))
    chosen.push_back(*before);
  return chosen;
}

std::vector<EstimatedPose> weak_axis_candidates(const std::vector<EstimatedPose>& estimates,
                                                double spacing_m) {
  std::vector<EstimatedPose> chosen;
  const EstimatedPose* before = nullptr;  // previous pose; null if its scan observed all directions
  double travelled_m = 0.0;
  for (const EstimatedPose& pose : estimates) {
    if (!has_weak_axis(pose)) {
      before = nullptr;
      continue;
    }
    if (before != nullptr) travelled_m += distance_m(*before, pose);
    const bool is_start = before == nullptr || before->weak_axis->source != pose.weak_axis->source;
    before = &pose;
    if (!is_start && travelled_m < spacing_m) continue;
    chosen.push_back(pose);
    travelled_m = 0.0;
  }
  return chosen;
}

/// Candidates that keep the clearance from those already chosen, in the order given.
std::vector<EstimatedPose> with_clearance(const std::vector<EstimatedPose>& candidates,
                                          double clearance_m) {
  std::vector<EstimatedPose> kept;
  for (const EstimatedPose& candidate : candidates) {
    const bool has_room = std::none_of(kept.begin(), kept.end(), [&](const EstimatedPose& other) {
      return distance_m(candidate, other) < clearance_m;
    });
    if (has_room) kept.push_back(candidate);
  }
  return kept;
}

/// Keeps marks with clearance, from the highest rank down, at most kMaxMarks; in order of time.
std::vector<EstimatedPose> thinned_out(std::vector<EstimatedPose> candidates, double clearance_m,
                                       const std::function<double(const EstimatedPose&)>& rank) {
  std::stable_sort(
      candidates.begin(), candidates.end(),
      [&](const EstimatedPose& a, const EstimatedPose& b) { return rank(a) > rank(b); });
  std::vector<EstimatedPose> kept = with_clearance(candidates, clearance_m);
  while (kept.size() > kMaxMarks) {
    clearance_m *= 1.2;
    kept = with_clearance(kept, clearance_m);
  }
  std::sort(kept.begin(), kept.end(),
            [](const EstimatedPose& a, const EstimatedPose& b) { return a.time < b.time; });
  return kept;
}

/// Importance of a weak axis among overlapping ones: one that nothing observes matters most.
double rank_of(WeakAxisSource source) {
  switch (source) {
    case WeakAxisSource::kNothing:
      return 3.0;
    case WeakAxisSource::kOdometry:
      return 2.0;
    case WeakAxisSource::kMarkers:
      return 1.0;
    case WeakAxisSource::kUnknown:
      break;
  }
  return 0.0;
}

/// The factor that makes the median ellipse visible without making the largest ones cover the page.
int magnification_of(const std::vector<EstimatedPose>& ellipses, double px_per_m) {
  const double visible_px = 26.0 * mark_scale(px_per_m);
  const double too_large_px = 100.0 * mark_scale(px_per_m);
  constexpr double kLargeShare = 0.95;
  if (ellipses.empty()) return 1;
  std::vector<double> radii_px;
  for (const EstimatedPose& pose : ellipses)
    radii_px.push_back(px_per_m * major_m(pose));
  std::sort(radii_px.begin(), radii_px.end());
  const double middle_px = radii_px[radii_px.size() / 2];
  const auto last = static_cast<double>(radii_px.size() - 1);
  const double large_px = radii_px[static_cast<std::size_t>(std::lround(kLargeShare * last))];
  int chosen = 1;
  for (const int magnification : {2, 5, 10, 20, 50}) {
    if (chosen * middle_px >= visible_px || magnification * large_px > too_large_px) break;
    chosen = magnification;
  }
  return chosen;
}

std::vector<cv::Point2d> outline_of(const Ellipse& ellipse, const EstimatedPose& pose,
                                    const MapViewport& view, int magnification) {
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
  return outline;
}

cv::Scalar colour_of(WeakAxisSource source) {
  switch (source) {
    case WeakAxisSource::kOdometry:
      return palette::kOdometry;
    case WeakAxisSource::kMarkers:
      return palette::kMarker;
    case WeakAxisSource::kNothing:
      return palette::kInk;
    case WeakAxisSource::kUnknown:
      break;
  }
  return palette::kFaintInk;
}

int bar_width_px(double scale) {
  return std::max(3, static_cast<int>(std::lround(scale * kBarWidth_px)));
}

}  // namespace

std::optional<Ellipse> two_sigma_ellipse(const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix2d position = covariance.topLeftCorner<2, 2>();
  if (!position.allFinite()) return std::nullopt;
  const PrincipalAxes axes = principal_axes(position);
  // Rounding may make a variance of zero slightly negative.
  constexpr double kRounding = 1e-9;
  const double largest = std::max(axes.values(1), 0.0);
  if (!axes.values.allFinite() || axes.values(0) < -kRounding * largest || axes.values(1) < 0.0) {
    return std::nullopt;
  }
  const Eigen::Vector2d sigma_m = axes.values.cwiseMax(0.0).cwiseSqrt();
  const Eigen::Vector2d axis = axes.directions.col(1);
  return Ellipse{2.0 * sigma_m(1), 2.0 * sigma_m(0), std::atan2(axis.y(), axis.x())};
}

UncertaintyMarks choose_marks(const std::vector<EstimatedPose>& estimates, double px_per_m,
                              double spacing_px) {
  UncertaintyMarks marks{.px_per_m = px_per_m,
                         .spacing_m = round_length_from(spacing_px / px_per_m)};
  marks.ellipses = thinned_out(ellipse_candidates(estimates, marks.spacing_m),
                               0.6 * spacing_px / px_per_m, major_m);
  marks.weak_axes =
      thinned_out(weak_axis_candidates(estimates, marks.spacing_m), 2.0 * kLongestBar_px / px_per_m,
                  [](const EstimatedPose& pose) { return rank_of(pose.weak_axis->source); });
  marks.magnification = magnification_of(marks.ellipses, px_per_m);
  return marks;
}

void draw_ellipses(cv::Mat& panel, const MapViewport& view, const UncertaintyMarks& marks) {
  constexpr double kOpacity = 0.16;
  std::vector<std::vector<cv::Point2d>> outlines;
  std::vector<std::vector<cv::Point2d>> to_fill;
  for (const EstimatedPose& pose : marks.ellipses) {
    const auto ellipse = two_sigma_ellipse(pose.covariance);
    if (!ellipse || !is_finite(pose)) continue;
    outlines.push_back(outline_of(*ellipse, pose, view, marks.magnification));
    // An ellipse larger than the panel would tint all of it.
    const double radius_px = marks.magnification * view.px_per_m * ellipse->major_m;
    if (radius_px < std::max(panel.cols, panel.rows)) to_fill.push_back(outlines.back());
  }
  tint_polygons(panel, to_fill, palette::kEllipse, kOpacity);
  for (const auto& outline : outlines)
    draw_polyline(panel, outline, {palette::kEllipse, 2});
}

void draw_weak_axis_bar(cv::Mat& image, cv::Point2d from_px, cv::Point2d to_px,
                        WeakAxisSource source, double scale) {
  const double cap_px = 10.0 * scale;
  const int width_px = bar_width_px(scale);
  const int rim_px = width_px + 2 * std::max(1, width_px / 3);
  const cv::Point2d span = to_px - from_px;
  const double length_px = cv::norm(span);
  if (!(length_px > 0.0)) return;
  const cv::Point2d cap = cap_px / length_px * cv::Point2d{-span.y, span.x};
  const std::array<std::pair<cv::Point2d, cv::Point2d>, 3> strokes{
      {{from_px, to_px}, {from_px - cap, from_px + cap}, {to_px - cap, to_px + cap}}};
  // A white rim separates the bar from the path below it.
  for (const auto& [from, to] : strokes)
    draw_line(image, from, to, {palette::kPage, rim_px});
  for (const auto& [from, to] : strokes)
    draw_line(image, from, to, {colour_of(source), width_px});
}

void draw_weak_axes(cv::Mat& panel, const MapViewport& view, const UncertaintyMarks& marks) {
  constexpr double kMostlyHeading = 0.7;  // theta component of the unit direction
  const double scale = mark_scale(view.px_per_m);
  const int width_px = bar_width_px(scale);
  for (const EstimatedPose& pose : marks.weak_axes) {
    if (!has_weak_axis(pose)) continue;
    const WeakAxis& axis = *pose.weak_axis;
    const cv::Point2d centre = view(pose.map_from_base.translation());
    if (std::abs(axis.direction.z()) > kMostlyHeading) {
      draw_circle(panel, centre, scale * kShortestBar_px, {palette::kPage, 2 * width_px});
      draw_circle(panel, centre, scale * kShortestBar_px, {colour_of(axis.source), width_px});
      continue;
    }
    const double two_sigma_m = axis.information > 0.0 ? 2.0 / std::sqrt(axis.information)
                                                      : std::numeric_limits<double>::infinity();
    const double half_px = std::clamp(marks.magnification * marks.px_per_m * two_sigma_m,
                                      scale * kShortestBar_px, scale * kLongestBar_px);
    const cv::Point2d along =
        half_px * view.direction(std::atan2(axis.direction.y(), axis.direction.x()));
    draw_weak_axis_bar(panel, centre - along, centre + along, axis.source, scale);
  }
}

void draw_health(cv::Mat& panel, const MapViewport& view,
                 const std::vector<EstimatedPose>& estimates, int width_px) {
  for (std::size_t begin = 0; begin < estimates.size();) {
    const Health health = estimates[begin].health;
    std::size_t end = begin;
    while (end < estimates.size() && estimates[end].health == health)
      ++end;
    if (health != Health::kTracking) {
      const std::span stretch{estimates.data() + begin, end - begin};
      std::vector<cv::Point2d> points = points_on_page(view, stretch);
      if (points.size() == 1) points.push_back(points.front());
      draw_polyline(panel, points, {colour_of(health), width_px});
    }
    begin = end;
  }
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

}  // namespace waymark::viewer
