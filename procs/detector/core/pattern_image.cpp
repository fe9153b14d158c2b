// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/pattern_image.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr double kLeastDepth = 0.05;  // of the marker's centre: nearer to the camera's plane
constexpr double kPixelVariance = 1.0 / 12.0;  // of a box one pixel wide [px^2]

/// The standard normal distribution, from a table: a fit asks for it some hundred thousand times.
class NormalTable {
 public:
  struct Values {
    double cumulative{0.0};
    double density{0.0};
  };

  NormalTable() {
    for (std::size_t i = 0; i < table_.size(); ++i) {
      const double z = static_cast<double>(i) / kPerUnit - kReach;
      table_[i] = {0.5 * std::erfc(-z / std::numbers::sqrt2),
                   std::exp(-0.5 * z * z) / std::sqrt(2.0 * std::numbers::pi)};
    }
  }

  /// Linear between entries: to 1e-5.
  Values at(double z) const {
    const double place = std::clamp((z + kReach) * kPerUnit, 0.0, kLast);
    const auto before = std::min(static_cast<std::size_t>(place), table_.size() - 2);
    const double share = place - static_cast<double>(before);
    const Values& low = table_[before];
    const Values& high = table_[before + 1];
    return {low.cumulative + share * (high.cumulative - low.cumulative),
            low.density + share * (high.density - low.density)};
  }

 private:
  static constexpr int kPerUnit = 64;
  static constexpr int kReach = 6;
  static constexpr double kLast = 2.0 * kReach * kPerUnit;
  std::array<Values, 2 * kReach * kPerUnit + 1> table_{};
};

/// Blur of a pixel along one of the marker's axes [modules]: a box, convolved with a Gaussian.
struct AxisBlur {
  double half_box{0.0};
  double sigma{0.0};
};

/// Shares of the rows or columns of modules in a pixel, with derivatives by its place and by sigma.
/// Module -1 is the quiet zone, -2 what lies beyond it; the same at the other end.
struct Shares {
  static constexpr std::size_t kMost = 12;  // more are cut off at the pixel's far side
  int first{0};
  std::size_t count{0};
  std::array<double, kMost> share{};
  std::array<double, kMost> by_place{};
  std::array<double, kMost> by_sigma{};
};

Shares shares_at(double place, const AxisBlur& blur, int modules) {
  static const NormalTable normal;
  constexpr double kReachSigmas = 4.0;
  const double reach = blur.half_box + kReachSigmas * blur.sigma;
  const auto module_at = [modules](double at) {
    return static_cast<int>(std::floor(std::clamp(at, -2.0, modules + 1.0)));
  };
  Shares result;
  result.first = module_at(place - reach);
  result.count = std::min(Shares::kMost,
                          static_cast<std::size_t>(module_at(place + reach) - result.first + 1));
  double share = 0.0;  // of all modules up to a boundary
  double by_place = 0.0;
  double by_sigma = 0.0;
  for (std::size_t k = 0; k < result.count; ++k) {
    const double share_before = share;
    const double by_place_before = by_place;
    const double by_sigma_before = by_sigma;
    if (k + 1 == result.count) {
      share = 1.0;
      by_place = 0.0;
      by_sigma = 0.0;
    } else {
      const double boundary = result.first + static_cast<double>(k) + 1.0 - place;
      const double low = (boundary - blur.half_box) / blur.sigma;
      const double high = (boundary + blur.half_box) / blur.sigma;
      const auto at_low = normal.at(low);
      const auto at_high = normal.at(high);
      const double box = 2.0 * blur.half_box;
      share =
          blur.sigma / box *
          (high * at_high.cumulative + at_high.density - low * at_low.cumulative - at_low.density);
      by_place = (at_low.cumulative - at_high.cumulative) / box;
      by_sigma = (at_high.density - at_low.density) / box;
    }
    result.share[k] = share - share_before;
    result.by_place[k] = by_place - by_place_before;
    result.by_sigma[k] = by_sigma - by_sigma_before;
  }
  return result;
}

/// The pixel's box along an axis is taken along that image axis which it follows most; the rest of
/// its area counts as Gaussian.
AxisBlur axis_blur(const Eigen::RowVector2d& modules_per_px, const Eigen::Vector2d& variance_px2) {
  const Eigen::RowVector2d squares = modules_per_px.cwiseAbs2();
  const double narrow = squares.minCoeff() * kPixelVariance;
  return {0.5 * std::sqrt(squares.maxCoeff()), std::sqrt(squares.dot(variance_px2) + narrow)};
}

std::array<Eigen::Vector2d, 4> square_corners() {
  return {Eigen::Vector2d{-1, -1}, Eigen::Vector2d{1, -1}, Eigen::Vector2d{1, 1},
          Eigen::Vector2d{-1, 1}};
}

/// Depth at a point of the marker's plane, as a multiple of that at its centre.
double depth_at(const PatternView& view, const Eigen::Vector2d& in_plane) {
  return 1.0 + view.values[6] * in_plane.x() + view.values[7] * in_plane.y();
}

Eigen::Vector2d unit_from_plane(const PatternView& view, const Eigen::Vector2d& in_plane) {
  const auto& h = view.values;
  return Eigen::Vector2d{h[0] * in_plane.x() + h[1] * in_plane.y() + h[2],
                         h[3] * in_plane.x() + h[4] * in_plane.y() + h[5]} /
         depth_at(view, in_plane);
}

/// Derivative of unit_from_plane() by the homography.
Eigen::Matrix<double, 2, 8> homography_jacobian(const PatternView& view,
                                                const Eigen::Vector2d& in_plane) {
  const double x = in_plane.x();
  const double y = in_plane.y();
  const Eigen::Vector2d unit = unit_from_plane(view, in_plane);
  Eigen::Matrix<double, 2, 8> jacobian;
  jacobian << x, y, 1, 0, 0, 0, -x * unit.x(), -y * unit.x(),  //
      0, 0, 0, x, y, 1, -x * unit.y(), -y * unit.y();
  return jacobian / depth_at(view, in_plane);
}

}  // namespace

PatternImage::PatternImage(const MarkerPattern& pattern, const Corners& corners_px)
    : pattern_{pattern},
      half_modules_{0.5 * pattern.modules()},
      centre_px_{0.25 * (corners_px[0] + corners_px[1] + corners_px[2] + corners_px[3])} {
  for (const Eigen::Vector2d& corner_px : corners_px)
    unit_px_ = std::max(unit_px_, (corner_px - centre_px_).norm());
}

std::optional<PatternView> PatternImage::view_of(const Corners& corners_px) const {
  // Each corner gives two equations that are linear in the homography.
  Eigen::Matrix<double, 8, 8> equations;
  Eigen::Matrix<double, 8, 1> units;
  const auto square = square_corners();
  for (std::size_t k = 0; k < 4; ++k) {
    const auto [x, y] = std::array{square[k].x(), square[k].y()};
    const Eigen::Vector2d unit = (corners_px[k] - centre_px_) / unit_px_;
    const auto row = static_cast<Eigen::Index>(2 * k);
    equations.row(row) << x, y, 1, 0, 0, 0, -x * unit.x(), -y * unit.x();
    equations.row(row + 1) << 0, 0, 0, x, y, 1, -x * unit.y(), -y * unit.y();
    units.segment<2>(row) = unit;
  }
  PatternView view;
  view.values.head<8>() = equations.partialPivLu().solve(units);
  const bool in_front = std::ranges::all_of(square, [&view](const Eigen::Vector2d& corner) {
    return depth_at(view, corner) > kLeastDepth;
  });
  if (!view.values.allFinite() || !in_front) return std::nullopt;
  return view;
}

Corners PatternImage::corners_px(const PatternView& view) const {
  Corners corners;
  std::ranges::transform(square_corners(), corners.begin(),
                         [&](const Eigen::Vector2d& corner) -> Eigen::Vector2d {
                           return centre_px_ + unit_px_ * unit_from_plane(view, corner);
                         });
  return corners;
}

Eigen::Matrix<double, 8, 8> PatternImage::corner_jacobian(const PatternView& view) const {
  Eigen::Matrix<double, 8, 8> jacobian;
  const auto square = square_corners();
  for (std::size_t k = 0; k < 4; ++k) {
    jacobian.middleRows<2>(static_cast<Eigen::Index>(2 * k)) =
        unit_px_ * homography_jacobian(view, square[k]);
  }
  return jacobian;
}

std::optional<PatternImage::Place> PatternImage::place(const PatternView& view,
                                                       const Eigen::Vector2d& ideal_px) const {
  const Eigen::Vector2d unit = (ideal_px - centre_px_) / unit_px_;
  const auto& h = view.values;
  Eigen::Matrix2d equations;
  equations << h[0] - unit.x() * h[6], h[1] - unit.x() * h[7],  //
      h[3] - unit.y() * h[6], h[4] - unit.y() * h[7];
  const Eigen::Matrix2d inverse = equations.inverse();
  const Eigen::Vector2d in_plane = inverse * Eigen::Vector2d{unit.x() - h[2], unit.y() - h[5]};
  const double depth = depth_at(view, in_plane);
  if (!(depth > kLeastDepth)) return std::nullopt;
  const Place place{half_modules_ * (in_plane + Eigen::Vector2d::Ones()),
                    half_modules_ / unit_px_ * depth * inverse};
  if (!place.modules.allFinite() || !place.modules_per_px.allFinite()) return std::nullopt;
  return place;
}

std::optional<ModelledPixel> PatternImage::pixel(const PatternView& view,
                                                 const Eigen::Vector2d& ideal_px) const {
  const auto at = place(view, ideal_px);
  if (!at) return std::nullopt;
  const auto& p = view.values;
  const Eigen::Matrix2d& scale = at->modules_per_px;
  const Eigen::Vector2d lens_px2 = p.segment<2>(PatternView::kBlur).cwiseAbs2();
  const AxisBlur blur_x = axis_blur(scale.row(0), lens_px2);
  const AxisBlur blur_y = axis_blur(scale.row(1), lens_px2);
  const double covariance = scale.row(0)
                                .cwiseProduct(scale.row(1))
                                .dot((lens_px2.array() + kPixelVariance).matrix().transpose());
  const Shares x = shares_at(at->modules.x(), blur_x, pattern_.modules());
  const Shares y = shares_at(at->modules.y(), blur_y, pattern_.modules());

  const Eigen::Vector2d in_plane = at->modules / half_modules_ - Eigen::Vector2d::Ones();
  const Eigen::Vector3d light{1.0, in_plane.x(), in_plane.y()};
  const double white = light.dot(p.segment<3>(PatternView::kWhite));
  const double black = light.dot(p.segment<3>(PatternView::kBlack));

  ModelledPixel result;
  double white_share = 0.0;
  double black_share = 0.0;
  Eigen::Vector2d by_place = Eigen::Vector2d::Zero();
  Eigen::Vector2d by_sigma = Eigen::Vector2d::Zero();
  double by_covariance = 0.0;
  for (std::size_t j = 0; j < y.count; ++j) {
    const int row = y.first + static_cast<int>(j);
    for (std::size_t i = 0; i < x.count; ++i) {
      const int column = x.first + static_cast<int>(i);
      const double share = x.share[i] * y.share[j] + covariance * x.by_place[i] * y.by_place[j];
      double grey = 0.0;
      const bool beyond_x = column < -1 || column > pattern_.modules();
      const bool beyond_y = row < -1 || row > pattern_.modules();
      if (beyond_x || beyond_y) {
        const int side = PatternView::kBeyond + (beyond_x ? (column < 0 ? 0 : 1) : row < 0 ? 2 : 3);
        grey = p[side];
        result.gradient[side] += share;
      } else {
        const bool is_white = pattern_.is_white(column, row);
        grey = is_white ? white : black;
        (is_white ? white_share : black_share) += share;
      }
      result.grey += grey * share;
      // A Gaussian's second derivative by place is its derivative by sigma, divided by sigma.
      const double by_xx = x.by_sigma[i] / blur_x.sigma;
      const double by_yy = y.by_sigma[j] / blur_y.sigma;
      by_place +=
          grey * Eigen::Vector2d{x.by_place[i] * y.share[j] + covariance * by_xx * y.by_place[j],
                                 x.share[i] * y.by_place[j] + covariance * x.by_place[i] * by_yy};
      by_sigma += grey * Eigen::Vector2d{x.by_sigma[i] * y.share[j], x.share[i] * y.by_sigma[j]};
      by_covariance += grey * x.by_place[i] * y.by_place[j];
    }
  }
  // At a fixed pixel, the place in the plane moves against the homography.
  const Eigen::RowVector2d by_unit = -by_place.transpose() * scale * unit_px_;
  result.gradient.head<8>() = (by_unit * homography_jacobian(view, in_plane)).transpose();
  const Eigen::Vector2d sigmas{blur_x.sigma, blur_y.sigma};
  const Eigen::Vector2d by_variance =
      0.5 * scale.cwiseAbs2().transpose() * by_sigma.cwiseQuotient(sigmas) +
      by_covariance * scale.row(0).cwiseProduct(scale.row(1)).transpose();
  result.gradient.segment<2>(PatternView::kBlur) =
      2.0 * by_variance.cwiseProduct(p.segment<2>(PatternView::kBlur));
  result.gradient.segment<3>(PatternView::kWhite) = white_share * light;
  result.gradient.segment<3>(PatternView::kBlack) = black_share * light;
  return result;
}

}  // namespace waymark
