// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/seen_square.hpp"

#include "common/geometry/upper_median.hpp"
#include "detector/core/blurred_side.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// Standard deviation of a point spread that leaves edges in place. Sharp pictures have 0.5 to 0.75:
// the pixels' own area, and the interpolation between them.
constexpr double kSharpPx = 0.95;
constexpr double kMinBorderPx = 2.0;
constexpr double kCornerBlurs = 3.0;  // a corner reaches that far, in standard deviations of it
constexpr double kHalfWhite = 0.5;    // of the bits, where it hardly matters
constexpr std::size_t kFewLevels = 4;

double triangle_area(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d ab = b - a;
  const Eigen::Vector2d ac = c - a;
  return 0.5 * std::abs(ab.x() * ac.y() - ab.y() * ac.x());
}

/// How thick the black border looks along each side. A module of the far side of an oblique marker
/// looks thinner than one of the near side.
std::array<double, 4> border_thickness_px(const std::array<Side, 4>& sides, int modules_per_side) {
  const std::array<Eigen::Vector2d, 4> corners{sides[0].start_px, sides[1].start_px,
                                               sides[2].start_px, sides[3].start_px};
  // Homogeneous corners of a square: w0 c0 - w1 c1 + w2 c2 - w3 c3 = 0.
  std::array<double, 4> weights{};
  for (std::size_t k = 0; k < 4; ++k) {
    weights[k] = triangle_area(corners[(k + 1) % 4], corners[(k + 2) % 4], corners[(k + 3) % 4]);
  }
  const double share = 1.0 / modules_per_side;
  const auto one_module_from = [&](std::size_t from, std::size_t to) -> Eigen::Vector2d {
    const double from_weight = (1.0 - share) * weights[from];
    const double to_weight = share * weights[to];
    return (from_weight * corners[from] + to_weight * corners[to]) / (from_weight + to_weight);
  };
  std::array<double, 4> thickness_px{};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t end = (k + 1) % 4;
    const Eigen::Vector2d inner_px =
        0.5 * (one_module_from(k, (k + 3) % 4) + one_module_from(end, (k + 2) % 4));
    thickness_px[k] = std::abs(sides[k].outward().dot(inner_px - sides[k].start_px));
  }
  return thickness_px;
}

/// Where the border looks thin, blur mixes white in, from the bits behind it, too. (The darkest
/// side would be the one whose noise is darkest.)
double black_level(const SeenSquare& square) {
  const std::size_t first = square.thick_side();
  std::vector<double> levels;
  std::vector<double> before_black;
  for (const std::size_t side : {first, first + 2}) {
    for (const EdgeProfile& profile : square.sides[side].profiles) {
      levels.push_back(profile.black);
      if (!profile.is_white_behind) before_black.push_back(profile.black);
    }
  }
  if (levels.empty()) return 0.0;
  const bool is_thin = square.sides[first].border_px < kThickBorder * square.sides[first].reach_px;
  return upper_median(is_thin && before_black.size() >= kFewLevels ? std::move(before_black)
                                                                   : std::move(levels));
}

double blur_of(const std::vector<EdgeProfile>& profiles, double black) {
  std::vector<double> blurs;
  for (const EdgeProfile& profile : profiles)
    if (const auto blur_px = profile.blur_px(black)) blurs.push_back(*blur_px);
  return blurs.empty() ? 0.0 : upper_median(std::move(blurs));
}

double mean_white(const std::vector<EdgeProfile>& profiles) {
  double sum = 0.0;
  for (const EdgeProfile& profile : profiles)
    sum += profile.white;
  return sum / static_cast<double>(profiles.size());
}

}  // namespace

bool SeenSide::is_blurred() const {
  return blur_px > kSharpPx && border_px > kMinBorderPx;
}

double SeenSide::half_window_px() const {
  constexpr double kInnerBlurPx = 1.1;
  return std::clamp(border_px - kInnerBlurPx, 0.4, 2.0);
}

bool SeenSquare::is_blurred() const {
  return std::ranges::any_of(sides, [](const SeenSide& side) { return side.is_blurred(); });
}

double SeenSquare::corner_px(std::size_t side) const {
  const auto blur_beside = [](const SeenSide& seen) {
    return seen.is_blurred() ? seen.blur_px : 0.0;
  };
  return kCornerBlurs *
         std::max(blur_beside(sides[(side + 1) % 4]), blur_beside(sides[(side + 3) % 4]));
}

std::size_t SeenSquare::thick_side() const {
  return sides[0].border_px + sides[2].border_px >= sides[1].border_px + sides[3].border_px ? 0 : 1;
}

SeenSquare look_at_square(const cv::Mat& gray, const CameraModel& camera,
                          const std::array<Side, 4>& sides, int modules_per_side, double reach_px) {
  constexpr double kShortestReachPx = 1.5;
  const std::array<double, 4> border_px = border_thickness_px(sides, modules_per_side);
  SeenSquare square;
  for (std::size_t k = 0; k < 4; ++k) {
    const double side_reach_px = std::min(reach_px, std::max(kShortestReachPx, border_px[k]));
    square.sides[k] = {sides[k], border_px[k], side_reach_px,
                       sample_profiles(gray, camera, sides[k], side_reach_px, border_px[k])};
  }
  square.black = black_level(square);
  for (SeenSide& side : square.sides)
    side.blur_px = blur_of(side.profiles, square.black);
  return square;
}

double blur_bias_px(const cv::Mat& gray, const CameraModel& camera, const SeenSquare& square,
                    std::size_t side) {
  const SeenSide& seen = square.sides[side];
  if (seen.profiles.empty()) return 0.0;
  const auto inner = mean_brightness_inside(gray, camera, seen.side, kInnerBits * seen.border_px);
  if (!inner) return 0.0;
  const double inner_white =
      std::clamp((*inner - square.black) / (mean_white(seen.profiles) - square.black), 0.0, 1.0);
  const SeenSide& thick = square.sides[square.thick_side()];
  const double blurred_black =
      BlurredSide{std::max(kSharpPx, thick.blur_px), thick.border_px, kHalfWhite}
          .profile(thick.reach_px)
          .black;
  return BlurredSide{seen.blur_px, seen.border_px, inner_white}.bias_px(
      seen.reach_px, blurred_black, seen.half_window_px());
}

}  // namespace waymark
