// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/corner_refinement.hpp"

#include "common/geometry/median.hpp"
#include "detector/core/sampled_square.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace waymark {
namespace {

// The first pass starts from sides about half a pixel off the edge, the second from fitted ones;
// blurred images and small markers need more.
constexpr int kMinPasses = 2;
constexpr int kMaxPasses = 6;
constexpr double kConvergedPx = 0.1;  // a pass that moves every corner by less is the last one
// Neighbouring profiles share pixels, so that N of them carry the information of N / 2.2
// independent ones (measured on rendered markers: with 2.2, squared errors agree with the
// covariance).
constexpr double kSharedNoise = 2.2;
constexpr double kOutlierSigmas = 2.5;
// Lower bound of the residuals: smaller ones are only rounding of grey levels.
constexpr double kSmallestResidualPx = 0.01;
// Standard deviation of the correction for blur: root sum of squares of these shares of the bias
// and of the blur.
constexpr double kBiasSigmaShare = 0.5;
constexpr double kBlurSigmaShare = 0.02;

using Sides = std::array<Side, 4>;

/// Outward offset [px] of the fitted edge from a side, `at_start_px + slope * along_px`, with the
/// covariance [px^2] of its offsets at the side's two corners.
struct EdgeLine {
  double at_start_px{0.0};
  double slope{0.0};
  double residual_px{0.0};
  Eigen::Matrix2d covariance_at_corners{Eigen::Matrix2d::Zero()};
};

struct EdgePoint {
  double along_px{0.0};
  double offset_px{0.0};
};

Sides sides_of(const Corners& corners) {
  return {Side{corners[0], corners[1]}, Side{corners[1], corners[2]}, Side{corners[2], corners[3]},
          Side{corners[3], corners[0]}};
}

/// @param margin_px  see SampledSquare::corner_margin_px().
std::vector<EdgePoint> edge_points(const SampledSide& sampled, double black, double margin_px,
                                   double min_contrast) {
  std::vector<EdgePoint> points;
  for (const EdgeProfile& profile : sampled.profiles) {
    if (sampled.levels(profile, black).white - black < min_contrast) continue;
    if (std::min(profile.along_px, sampled.side.length_px() - profile.along_px) < margin_px)
      continue;
    const auto offset_px = sampled.edge_px(profile, black);
    if (offset_px) points.push_back({profile.along_px, *offset_px});
  }
  return points;
}

/// Ordinary least squares in the frame of the side, in which the slope of the edge is tiny.
EdgeLine fit_once(const std::vector<EdgePoint>& points, double length_px) {
  const double n = static_cast<double>(points.size());
  double mean_along = 0.0;
  double mean_offset = 0.0;
  for (const EdgePoint& p : points) {
    mean_along += p.along_px / n;
    mean_offset += p.offset_px / n;
  }
  double spread = 0.0;
  double joint = 0.0;
  for (const EdgePoint& p : points) {
    spread += (p.along_px - mean_along) * (p.along_px - mean_along);
    joint += (p.along_px - mean_along) * (p.offset_px - mean_offset);
  }
  EdgeLine line;
  line.slope = joint / spread;
  line.at_start_px = mean_offset - line.slope * mean_along;
  double squares = 0.0;
  for (const EdgePoint& p : points) {
    const double residual = p.offset_px - line.at_start_px - line.slope * p.along_px;
    squares += residual * residual;
  }
  line.residual_px = std::max(kSmallestResidualPx, std::sqrt(squares / (n - 2.0)));

  const Eigen::Vector2d from_mean{-mean_along, length_px - mean_along};
  const double variance = kSharedNoise * line.residual_px * line.residual_px;
  line.covariance_at_corners =
      variance * (Eigen::Matrix2d::Constant(1.0 / n) + from_mean * from_mean.transpose() / spread);
  return line;
}

/// Fits up to three times, each time without the outliers of the fit before.
std::optional<EdgeLine> fit_line(std::vector<EdgePoint> points, double length_px, int min_points) {
  constexpr int kRounds = 3;
  if (std::ssize(points) < min_points) return std::nullopt;
  std::optional<EdgeLine> line;
  for (int round = 0; round < kRounds; ++round) {
    line = fit_once(points, length_px);
    std::vector<double> distances;
    const auto distance_px = [&line](const EdgePoint& p) {
      return std::abs(p.offset_px - line->at_start_px - line->slope * p.along_px);
    };
    for (const EdgePoint& p : points)
      distances.push_back(distance_px(p));
    const double limit_px =
        kOutlierSigmas *
        std::max(kSmallestResidualPx, kSigmaOfMad * upper_median(std::move(distances)));
    const auto is_far = [&](const EdgePoint& p) {
      return distance_px(p) > limit_px;
    };
    const auto far = std::ranges::count_if(points, is_far);
    if (far == 0 || std::ssize(points) - far < min_points) break;
    std::erase_if(points, is_far);
  }
  return line;
}

/// Maps outward shifts of two neighbouring sides (the one that ends here, the one that starts here)
/// to the shift of the corner between them.
Eigen::Matrix2d corner_from_side_shifts(const Side& ends_here, const Side& starts_here) {
  Eigen::Matrix2d normals;
  normals << ends_here.outward().transpose(), starts_here.outward().transpose();
  return normals.inverse();
}

Side shifted(const Side& side, const EdgeLine& line) {
  return {side.start_px + line.at_start_px * side.outward(),
          side.end_px + (line.at_start_px + line.slope * side.length_px()) * side.outward()};
}

Eigen::Vector2d intersection(const Side& a, const Side& b) {
  const Eigen::Vector2d distances{a.outward().dot(a.start_px), b.outward().dot(b.start_px)};
  return corner_from_side_shifts(a, b) * distances;
}

struct FittedQuad {
  Corners corners{};
  Eigen::Matrix<double, 8, 8> covariance{};

  /// False where neighbouring sides are parallel.
  bool is_finite() const {
    return covariance.allFinite() &&
           std::ranges::all_of(corners, [](const auto& corner) { return corner.allFinite(); });
  }
};

FittedQuad intersect(const Sides& sides, const std::array<EdgeLine, 4>& lines) {
  FittedQuad quad;
  Eigen::Matrix<double, 8, 8> corners_from_sides = Eigen::Matrix<double, 8, 8>::Zero();
  Eigen::Matrix<double, 8, 8> side_covariance = Eigen::Matrix<double, 8, 8>::Zero();
  for (int k = 0; k < 4; ++k) {
    const int before = (k + 3) % 4;
    const Side ends_here = shifted(sides[before], lines[before]);
    const Side starts_here = shifted(sides[k], lines[k]);
    quad.corners[k] = intersection(ends_here, starts_here);
    const Eigen::Matrix2d solve = corner_from_side_shifts(ends_here, starts_here);
    corners_from_sides.block<2, 1>(2 * k, 2 * before + 1) = solve.col(0);
    corners_from_sides.block<2, 1>(2 * k, 2 * k) = solve.col(1);
    side_covariance.block<2, 2>(2 * k, 2 * k) = lines[k].covariance_at_corners;
  }
  quad.covariance = corners_from_sides * side_covariance * corners_from_sides.transpose();
  return quad;
}

/// Standard deviation [px] of the error that all edge points of a side share: from sampling, and
/// from the bits behind a thin border.
double common_sigma_px(double border_px, const RefinementConfig& config) {
  constexpr double kThinnestBorderPx = 1.0;
  const double thickness = std::max(kThinnestBorderPx, border_px);
  return std::hypot(config.side_sigma_px, config.thin_border_sigma_px / std::pow(thickness, 4));
}

std::optional<FittedQuad> fit_quad(const cv::Mat& gray, const CameraModel& camera,
                                   const Corners& corners, int modules_per_side,
                                   const RefinementConfig& config) {
  const SampledSquare square =
      sample_square(gray, camera, sides_of(corners), modules_per_side, config.reach_px);
  std::array<EdgeLine, 4> lines;
  for (std::size_t k = 0; k < 4; ++k) {
    const SampledSide& side = square.sides[k];
    const auto line =
        fit_line(edge_points(side, square.black, square.corner_margin_px(k), config.min_contrast),
                 side.side.length_px(), config.min_points);
    if (!line || line->residual_px > config.max_residual_px) return std::nullopt;
    lines[k] = *line;
    // Where the model has no edge, the border is so thin that its sigma covers the bias.
    const double bias_px = blur_bias_px(gray, camera, square, k).value_or(0.0);
    lines[k].at_start_px -= bias_px;
    double sigma_px =
        std::hypot(common_sigma_px(side.border_px, config), kBiasSigmaShare * bias_px);
    if (side.is_blurred()) sigma_px = std::hypot(sigma_px, kBlurSigmaShare * side.blur_px);
    lines[k].covariance_at_corners.array() += sigma_px * sigma_px;
  }
  const FittedQuad quad = intersect(sides_of(corners), lines);
  if (!quad.is_finite()) return std::nullopt;
  return quad;
}

double largest_move_px(const Corners& from, const Corners& to) {
  double largest = 0.0;
  for (std::size_t k = 0; k < 4; ++k)
    largest = std::max(largest, (to[k] - from[k]).norm());
  return largest;
}

}  // namespace

void RefinementConfig::describe(Fields& fields) {
  fields.field("reach_px", reach_px, {1.5, 20.0},
               "how far from a side its edge is looked for; at most the border's thickness");
  fields.field("min_contrast", min_contrast, {1.0, 255.0},
               "grey levels between border and quiet zone that an edge point needs");
  fields.field("min_points", min_points, {3, 1000}, "edge points that a side needs");
  fields.field("max_residual_px", max_residual_px, kPositive,
               "scatter of the edge points about their line that is still an edge");
  fields.field("max_move_px", max_move_px, kPositive,
               "a corner that would move further stays where it was");
  fields.field("side_sigma_px", side_sigma_px, kNotNegative,
               "standard deviation of a side's offset beyond what the scatter of its points says");
  fields.field(
      "thin_border_sigma_px", thin_border_sigma_px, kNotNegative,
      "the same, added where the black border looks one pixel thick; falls with the fourth "
      "power of the thickness");
  fields.field("unrefined_sigma_px", unrefined_sigma_px, kPositive,
               "standard deviation of a corner that could not be refined");
}

MeasuredCorners refine_corners(const cv::Mat& gray, const CameraModel& camera,
                               const Corners& raw_corners_px, int modules_per_side,
                               const RefinementConfig& config) {
  MeasuredCorners unrefined;
  for (std::size_t k = 0; k < 4; ++k)
    unrefined.ideal_px[k] = camera.ideal_from_raw(raw_corners_px[k]);
  unrefined.covariance *= config.unrefined_sigma_px * config.unrefined_sigma_px;

  MeasuredCorners measured = unrefined;
  for (int pass = 1; pass <= kMaxPasses; ++pass) {
    const auto quad = fit_quad(gray, camera, measured.ideal_px, modules_per_side, config);
    if (!quad) return unrefined;
    const double moved_px = largest_move_px(measured.ideal_px, quad->corners);
    measured = {quad->corners, quad->covariance, true};
    if (!(largest_move_px(unrefined.ideal_px, measured.ideal_px) <= config.max_move_px)) {
      return unrefined;
    }
    if (pass >= kMinPasses && moved_px <= kConvergedPx) break;
  }
  return measured;
}

}  // namespace waymark
