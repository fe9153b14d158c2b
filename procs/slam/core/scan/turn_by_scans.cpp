// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/scan/turn_by_scans.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace waymark {
namespace {

constexpr int kBins = 360;
constexpr int kMaxTurn = 50;             // [bin] largest deviation from odometry
constexpr int kSameTurn = 3;             // [bin] a smaller deviation is no contradiction
constexpr float kFar_m = 0.3F;           // differences are clamped to this: other objects
constexpr double kMinCommon = 0.6;       // share of the later scan's bins
constexpr double kMinMismatch_m = 0.05;  // less is due to noise, clutter and the translation
constexpr double kClearly = 0.6;         // of the odometry's mismatch

/// Range by direction, in bins of a degree around the LiDAR; 0 = nothing was hit.
using RangeProfile = std::vector<float>;

int bin_of(const Eigen::Vector2d& direction) {
  const double turns = std::atan2(direction.y(), direction.x()) / (2.0 * std::numbers::pi);
  return (static_cast<int>(std::floor(turns * kBins)) + kBins) % kBins;
}

/// Profile as seen from a pose in the beams' base frame.
RangeProfile profile_of(std::span<const AnnotatedBeam> beams, const Se2& base_from_viewer) {
  const Se2 viewer_from_base = base_from_viewer.inverse();
  RangeProfile profile(kBins, 0.0F);
  for (const AnnotatedBeam& annotated : beams) {
    const Eigen::Vector2d end = viewer_from_base * annotated.beam.end_in_base;
    float& range_m = profile[static_cast<std::size_t>(bin_of(end))];
    const auto seen_m = static_cast<float>(end.norm());
    if (range_m == 0.0F || seen_m < range_m) range_m = seen_m;
  }
  return profile;
}

struct Comparison {
  double mismatch_m{std::numeric_limits<double>::infinity()};
  int common{0};
};

Comparison compare(const RangeProfile& earlier, const RangeProfile& later, int turn) {
  Comparison comparison;
  double sum_m = 0.0;
  for (int bin = 0; bin < kBins; ++bin) {
    const float now_m = later[static_cast<std::size_t>(bin)];
    const float then_m = earlier[static_cast<std::size_t>((bin + turn + kBins) % kBins)];
    if (now_m == 0.0F || then_m == 0.0F) continue;
    sum_m += std::min(std::abs(now_m - then_m), kFar_m);
    ++comparison.common;
  }
  if (comparison.common > 0) comparison.mismatch_m = sum_m / comparison.common;
  return comparison;
}

}  // namespace

std::optional<TurnByScans> turn_between(std::span<const AnnotatedBeam> earlier,
                                        std::span<const AnnotatedBeam> later,
                                        const Motion& motion) {
  if (earlier.empty() || later.empty()) return std::nullopt;
  // Both profiles from the LiDAR's later position by odometry, so that only the turn is unknown.
  const Se2 base_from_lidar{later.front().beam.start_in_base, 0.0};
  const RangeProfile now = profile_of(later, base_from_lidar);
  const RangeProfile then = profile_of(earlier, motion.start_from_end * base_from_lidar);
  const auto filled = std::count_if(now.begin(), now.end(), [](float r) { return r > 0.0F; });
  TurnByScans result;
  result.mismatch_m = std::numeric_limits<double>::infinity();
  result.odometry_mismatch_m = std::numeric_limits<double>::infinity();
  int best = 0;
  const auto look_at = [&](int turn) {
    const Comparison comparison = compare(then, now, turn);
    if (comparison.common < kMinCommon * static_cast<double>(filled)) return;
    if (std::abs(turn) <= kSameTurn)
      result.odometry_mismatch_m = std::min(result.odometry_mismatch_m, comparison.mismatch_m);
    if (comparison.mismatch_m < result.mismatch_m) {
      result.mismatch_m = comparison.mismatch_m;
      best = turn;
    }
  };
  for (int turn = -kSameTurn; turn <= kSameTurn; ++turn)
    look_at(turn);
  if (result.odometry_mismatch_m > kMinMismatch_m) {
    for (int more = kSameTurn + 1; more <= kMaxTurn; ++more) {
      look_at(-more);
      look_at(more);
    }
  }
  if (!std::isfinite(result.odometry_mismatch_m)) return std::nullopt;
  const double extra_rad = best * 2.0 * std::numbers::pi / kBins;
  result.turn_rad = motion.start_from_end.theta() + extra_rad;
  result.contradicts_odometry =
      std::abs(best) > kSameTurn && result.mismatch_m < kClearly * result.odometry_mismatch_m;
  return result;
}

}  // namespace waymark
