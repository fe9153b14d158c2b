// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/sampled_square.hpp"

#include "common/geometry/median.hpp"
#include "detector/core/blurred_side.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kBlurredPx = 0.95;   // a side with more blur bends the ends of its neighbours
constexpr double kMinBorderPx = 2.0;  // of a thinner border no blur can be measured
constexpr double kCornerBlurs = 3.0;  // a corner bends the edge over so many sigmas of the blur
constexpr double kHalfWhite = 0.5;    // assumed share of white bits; has little effect here
constexpr std::size_t kMinLevels = 4;
constexpr double kNearEnd = 0.3;      // of a side's length
constexpr double kMuchThicker = 1.5;  // by perspective, seen from the side

double triangle_area(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  const Eigen::Vector2d ab = b - a;
  const Eigen::Vector2d ac = c - a;
  return 0.5 * std::abs(ab.x() * ac.y() - ab.y() * ac.x());
}

/// Thickness of the black border in the image at the middle of each side; by perspective the far
/// side of an oblique marker has a thinner one than the near side.
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

/// True when even the thicker borders are so thin that blur lets white bits brighten them.
bool is_thin_everywhere(const SampledSquare& square) {
  const SampledSide& thick = square.sides[square.thick_side()];
  return thick.border_px < kThickBorder * thick.reach_px;
}

/// Median black level of the two opposite sides with the thicker borders; of the profiles in front
/// of black bits only, if all borders are thin.
double black_level(const SampledSquare& square) {
  const std::size_t first = square.thick_side();
  std::vector<double> levels;
  std::vector<double> before_black_bits;
  for (const std::size_t side : {first, first + 2}) {
    for (const EdgeProfile& profile : square.sides[side].profiles) {
      levels.push_back(profile.black);
      if (!profile.is_white_behind) before_black_bits.push_back(profile.black);
    }
  }
  if (levels.empty()) return 0.0;
  return upper_median(is_thin_everywhere(square) && before_black_bits.size() >= kMinLevels
                          ? std::move(before_black_bits)
                          : std::move(levels));
}

double blur_of(const SampledSide& side, double black) {
  std::vector<double> blurs;
  for (const EdgeProfile& profile : side.profiles) {
    if (const auto blur_px = profile.blur_px(side.levels(profile, black)))
      blurs.push_back(*blur_px);
  }
  return blurs.empty() ? 0.0 : upper_median(std::move(blurs));
}

/// Mean white level of the profiles that are at most so far from the start and from the end of a
/// side, as shares of its length.
std::optional<double> mean_white(const SampledSide& side, double from_start = 1.0,
                                 double from_end = 1.0) {
  double sum = 0.0;
  int count = 0;
  for (const EdgeProfile& profile : side.profiles) {
    const double share = profile.along_px / side.side.length_px();
    if (share > from_start || 1.0 - share > from_end) continue;
    sum += profile.white;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / count;
}

/// See SampledSide::white_beside.
std::optional<double> white_beside(const SampledSquare& square, std::size_t side) {
  const SampledSide& before = square.sides[(side + 3) % 4];
  const SampledSide& after = square.sides[(side + 1) % 4];
  if (std::min(before.border_px, after.border_px) < kMuchThicker * square.sides[side].border_px)
    return std::nullopt;
  const auto white_before = mean_white(before, 1.0, kNearEnd);
  const auto white_after = mean_white(after, kNearEnd);
  if (!white_before || !white_after) return std::nullopt;
  return 0.5 * (*white_before + *white_after);
}

}  // namespace

bool SampledSide::is_blurred() const {
  return blur_px > kBlurredPx && border_px > kMinBorderPx;
}

double SampledSide::half_window_px() const {
  constexpr double kInnerBlurPx = 1.1;
  return std::clamp(border_px - kInnerBlurPx, 0.4, 2.0);
}

double SampledSquare::corner_margin_px(std::size_t side) const {
  const auto blur_beside = [](const SampledSide& neighbour) {
    return neighbour.is_blurred() ? neighbour.blur_px : 0.0;
  };
  return kCornerBlurs *
         std::max(blur_beside(sides[(side + 1) % 4]), blur_beside(sides[(side + 3) % 4]));
}

std::size_t SampledSquare::thick_side() const {
  return sides[0].border_px + sides[2].border_px >= sides[1].border_px + sides[3].border_px ? 0 : 1;
}

SampledSquare sample_square(const cv::Mat& gray, const CameraModel& camera,
                            const std::array<Side, 4>& sides, int modules_per_side,
                            double reach_px) {
  constexpr double kShortestReachPx = 1.5;
  const std::array<double, 4> border_px = border_thickness_px(sides, modules_per_side);
  SampledSquare square;
  for (std::size_t k = 0; k < 4; ++k) {
    const double side_reach_px = std::min(reach_px, std::max(kShortestReachPx, border_px[k]));
    square.sides[k] = {sides[k], border_px[k], side_reach_px,
                       sample_profiles(gray, camera, sides[k], side_reach_px, border_px[k])};
  }
  square.black = black_level(square);
  for (std::size_t k = 0; k < 4; ++k) {
    SampledSide& side = square.sides[k];
    side.white_beside = white_beside(square, k);
    side.blur_px = blur_of(side, square.black);
  }
  return square;
}

std::optional<double> blur_bias_px(const cv::Mat& gray, const CameraModel& camera,
                                   const SampledSquare& square, std::size_t side) {
  const SampledSide& sampled = square.sides[side];
  const SampledSide& thick = square.sides[square.thick_side()];
  const auto white_level = mean_white(thick.profiles.empty() ? sampled : thick);
  if (!white_level) return std::nullopt;
  // Share of white in the row of modules whose centres are that far inside.
  const auto white_share = [&](double modules, double unknown) {
    const auto level = mean_brightness_inside(
        gray, camera, sampled.side, modules * sampled.border_px, square.corner_margin_px(side));
    if (!level) return unknown;
    return std::clamp((*level - square.black) / (*white_level - square.black), 0.0, 1.0);
  };
  // Where the border is thin, the bits behind it change the blur that is measured.
  const double own_blur_px = sampled.border_px > kMinBorderPx ? sampled.blur_px : 0.0;
  const double blur_px = std::max({kSharpPx, thick.blur_px, own_blur_px});
  const BlurredSide model{blur_px, sampled.border_px, white_share(kInnerBits, kHalfWhite),
                          white_share(-kInnerBits, 1.0)};
  const EdgeProfile profile = model.profile(sampled.reach_px);
  const BlurredSide of_thick{std::max(kSharpPx, thick.blur_px), thick.border_px,
                             is_thin_everywhere(square) ? 0.0 : kHalfWhite, model.outer_white};
  const EdgeProfile thick_profile = of_thick.profile(thick.reach_px);
  const double white = sampled.white_beside ? thick_profile.white : profile.white;
  return profile.edge_px({thick_profile.black, white}, sampled.half_window_px());
}

}  // namespace waymark
