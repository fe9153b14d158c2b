// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/correlative_search.hpp"

#include "common/random/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

namespace waymark {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr double kResolution_m = 0.05;

/// Sums of bytes, divided in two places.
constexpr double kRounding = 1e-12;

/// Points every 2 cm, so that no cell of a wall is left out.
void draw_wall(Eigen::Vector2d from, Eigen::Vector2d to, Points& points) {
  const int count = static_cast<int>(std::ceil((to - from).norm() / 0.02));
  for (int i = 0; i <= count; ++i)
    points.push_back(from + (to - from) * i / count);
}

/// The walls of a rectangle about the origin.
Points rectangle(double half_length_m, double half_width_m) {
  const Eigen::Vector2d corner{half_length_m, half_width_m};
  const Eigen::Vector2d other{half_length_m, -half_width_m};
  Points walls;
  draw_wall(corner, other, walls);
  draw_wall(other, -corner, walls);
  draw_wall(-corner, -other, walls);
  draw_wall(-other, corner, walls);
  return walls;
}

/// 8 m x 6 m with a partition and a pillar: half a turn maps it on itself but for these two.
Points room() {
  Points walls = rectangle(4.0, 3.0);
  draw_wall({1.0, 3.0}, {1.0, 1.2}, walls);
  draw_wall({-2.3, -0.9}, {-1.9, -0.9}, walls);
  draw_wall({-1.9, -0.9}, {-1.9, -1.3}, walls);
  return walls;
}

/// `count` points of the submap as the base has them, drawn evenly, with noise.
Points seen_from(const Se2& submap_from_base, const Points& submap, int count, double noise_m,
                 Random& random) {
  Points seen;
  for (int i = 0; i < count; ++i) {
    const auto index =
        static_cast<std::size_t>(random.uniform() * static_cast<double>(submap.size()));
    const Eigen::Vector2d noise{random.normal(0.0, noise_m), random.normal(0.0, noise_m)};
    seen.push_back(submap_from_base.inverse() * (submap[index] + noise));
  }
  return seen;
}

double farthest(const Points& points) {
  double norm_m = 0.0;
  for (const Eigen::Vector2d& point : points)
    norm_m = std::max(norm_m, point.norm());
  return norm_m;
}

/// The oracle: asks the field at every candidate, nearest first among equals.
template <class Counts>
std::optional<SearchMatch> brute_force(const CorrelativeField& field, const Points& points,
                                       const Se2& guess, const SearchWindow& window,
                                       double min_score, Counts counts) {
  const int half_width = static_cast<int>(std::floor(window.half_width_m / kResolution_m));
  const double step_rad = kResolution_m / farthest(points);
  const int steps = static_cast<int>(std::floor(window.half_turn_rad / step_rad));
  std::optional<SearchMatch> best;
  int best_cost = 0;
  for (int turn = -steps; turn <= steps; ++turn) {
    for (int y = -half_width; y <= half_width; ++y) {
      for (int x = -half_width; x <= half_width; ++x) {
        const Se2 pose{guess.x() + x * kResolution_m, guess.y() + y * kResolution_m,
                       guess.theta() + turn * step_rad};
        const double score = field.score(points, pose);
        const int cost = x * x + y * y + turn * turn;
        if (score < min_score || score <= 0.0 || !counts(pose)) continue;
        if (best && (score < best->score || (score == best->score && cost >= best_cost))) continue;
        best = SearchMatch{pose, score};
        best_cost = cost;
      }
    }
  }
  return best;
}

/// Squared cells and steps from the guess: what decides between equal scores.
double cost(const Se2& pose, const Se2& guess, const Points& points) {
  const double turn = angle_difference(pose.theta(), guess.theta()) * farthest(points);
  const double squared = (pose.translation() - guess.translation()).squaredNorm() + turn * turn;
  return squared / (kResolution_m * kResolution_m);
}

TEST(CorrelativeField, IsOneAtAPointAndFallsOffLikeAGaussian) {
  const Points wall{{0.0, 0.0}};
  const CorrelativeField field{wall, 0.05, 0.1};
  const auto value_at = [&](double x_m) {
    return field.score(wall, {x_m, 0.0, 0.0});
  };
  constexpr double kHalfAByte = 0.5 / 255.0;
  EXPECT_EQ(value_at(0.0), 1.0);
  EXPECT_EQ(value_at(0.02), 1.0) << "the same cell";
  EXPECT_NEAR(value_at(0.1), std::exp(-0.5), kHalfAByte);
  EXPECT_NEAR(value_at(-0.2), std::exp(-2.0), kHalfAByte);
  EXPECT_EQ(value_at(0.4), 0.0);
  EXPECT_EQ(value_at(1e9), 0.0);
}

TEST(CorrelativeField, ScoreIsTheMeanOverAllPoints) {
  const CorrelativeField field{Points{{0.0, 0.0}}};
  EXPECT_EQ(field.score(Points{{0.0, 0.0}, {5.0, 0.0}, {-7.0, 2.0}, {0.01, 0.01}}, {}), 0.5);
}

TEST(CorrelativeSearch, RecoversTheTransformWithinOneCell) {
  const Points walls = room();
  const CorrelativeField field{walls};
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Random random{seed};
    const Se2 truth{random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-3, 3)};
    const Points seen = seen_from(truth, walls, 150, 0.01, random);
    const Se2 guess = truth * Se2{random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6),
                                  random.uniform(-0.5, 0.5)};
    const auto match = field.best(seen, guess, {1.0, 0.6}, 0.5);
    ASSERT_TRUE(match) << seed;
    EXPECT_LT((match->submap_from_base.translation() - truth.translation()).norm(), kResolution_m)
        << seed;
    EXPECT_NEAR(angle_difference(match->submap_from_base.theta(), truth.theta()), 0.0,
                kResolution_m / farthest(seen))
        << seed;
    EXPECT_NEAR(match->score, field.score(seen, match->submap_from_base), kRounding);
  }
}

TEST(CorrelativeSearch, FindsTheOnlyPlaceInTheFullCircleFromAnywhereInTheRoom) {
  const Points walls = room();
  const CorrelativeField field{walls};
  Random random{7};
  const Se2 truth{-2.9, 1.4, 2.6};
  const Points seen = seen_from(truth, walls, 150, 0.01, random);
  const auto match = field.best(seen, {2.0, -1.0, -1.0}, {6.0, 4.0}, 0.5);
  ASSERT_TRUE(match);
  EXPECT_LT((match->submap_from_base.translation() - truth.translation()).norm(), kResolution_m);
  EXPECT_NEAR(match->submap_from_base.theta(), truth.theta(), kResolution_m / farthest(seen));
}

/// Clutter, not rooms: many maxima of nearly the same height, some of them equal.
TEST(CorrelativeSearch, EqualsBruteForce) {
  int found = 0;
  int runner_ups = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random{seed};
    const auto draw_point = [&] {
      return Eigen::Vector2d{random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2)};
    };
    Points submap;
    Points scan;
    for (int i = 0; i < 40; ++i)
      submap.push_back(draw_point());
    const int count = 3 + static_cast<int>(seed % 10);
    for (int i = 0; i < count; ++i)
      scan.push_back(draw_point());
    const CorrelativeField field{submap, kResolution_m, random.uniform(0.02, 0.1)};
    const Se2 guess{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-3, 3)};
    const SearchWindow window{random.uniform(0.0, 0.6), random.uniform(0.0, 0.4)};
    const double min_score = random.uniform(0.0, 0.7);

    const auto everything = [](const Se2&) {
      return true;
    };
    const auto expected = brute_force(field, scan, guess, window, min_score, everything);
    const auto match = field.best(scan, guess, window, min_score);
    ASSERT_EQ(match.has_value(), expected.has_value()) << seed;
    if (!match) continue;
    ++found;
    EXPECT_NEAR(match->score, expected->score, kRounding) << seed;
    EXPECT_NEAR(cost(match->submap_from_base, guess, scan),
                cost(expected->submap_from_base, guess, scan), 1e-6)
        << seed;

    const Se2 other = match->submap_from_base;
    const auto apart = [&](const Se2& pose) {
      return (pose.translation() - other.translation()).norm() >= 0.17 ||
             std::abs(angle_difference(pose.theta(), other.theta())) >= 0.11;
    };
    const auto expected_next = brute_force(field, scan, guess, window, min_score, apart);
    const auto next = field.best_apart_from(other, 0.17, 0.11, scan, guess, window, min_score);
    ASSERT_EQ(next.has_value(), expected_next.has_value()) << seed;
    if (!next) continue;
    ++runner_ups;
    EXPECT_TRUE(apart(next->submap_from_base)) << seed;
    EXPECT_NEAR(next->score, expected_next->score, kRounding) << seed;
    EXPECT_NEAR(cost(next->submap_from_base, guess, scan),
                cost(expected_next->submap_from_base, guess, scan), 1e-6)
        << seed;
  }
  EXPECT_GT(found, 20);
  EXPECT_GT(runner_ups, 10);
}

TEST(CorrelativeSearch, BareCorridorIsFlatAlongItsAxisAndKeepsTheGuessThere) {
  Points walls;
  draw_wall({-10.0, 1.0}, {10.0, 1.0}, walls);
  draw_wall({-10.0, -1.0}, {10.0, -1.0}, walls);
  Points seen;
  draw_wall({-3.0, 1.0}, {3.0, 1.0}, seen);
  draw_wall({-3.0, -1.0}, {3.0, -1.0}, seen);
  const CorrelativeField field{walls};
  for (double x_m = -6.0; x_m <= 6.0; x_m += 0.37) {
    EXPECT_EQ(field.score(seen, {x_m, 0.0, 0.0}), 1.0) << x_m;
    EXPECT_LT(field.score(seen, {x_m, 0.2, 0.0}), 0.1) << x_m;
  }
  const auto match = field.best(seen, {1.23, 0.3, 0.04}, {2.0, 0.3}, 0.5);
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->submap_from_base.x(), 1.23, kRounding);
  EXPECT_NEAR(match->submap_from_base.y(), 0.0, 0.5 * kResolution_m + kRounding);
}

TEST(CorrelativeSearch, TheSecondBestPoseScoresAsWellOnlyInASymmetricRoom) {
  constexpr double kApart_m = 0.5;
  constexpr double kApart_rad = 0.5;
  constexpr SearchWindow kEverywhere{1.0, std::numbers::pi};
  Random random{3};
  const Se2 truth{0.4, -0.3, 0.2};

  const Points square = rectangle(2.0, 2.0);
  const CorrelativeField square_field{square};
  const Points in_square = seen_from(truth, square, 120, 0.01, random);
  const auto best = square_field.best(in_square, truth, kEverywhere, 0.3);
  ASSERT_TRUE(best);
  const auto next = square_field.best_apart_from(best->submap_from_base, kApart_m, kApart_rad,
                                                 in_square, truth, kEverywhere, 0.3);
  ASSERT_TRUE(next);
  EXPECT_LE(next->score, best->score);
  EXPECT_GT(next->score, 0.95 * best->score);
  const double turn_rad =
      std::abs(angle_difference(next->submap_from_base.theta(), best->submap_from_base.theta()));
  const double quarters = turn_rad / (0.5 * std::numbers::pi);
  EXPECT_GE(std::round(quarters), 1.0);
  EXPECT_NEAR(quarters, std::round(quarters), 0.02);

  const Points walls = room();
  const CorrelativeField field{walls};
  const Points seen = seen_from(truth, walls, 120, 0.01, random);
  const auto here = field.best(seen, truth, kEverywhere, 0.3);
  ASSERT_TRUE(here);
  const auto elsewhere = field.best_apart_from(here->submap_from_base, kApart_m, kApart_rad, seen,
                                               truth, kEverywhere, 0.0);
  ASSERT_TRUE(elsewhere);
  EXPECT_LT(elsewhere->score, 0.92 * here->score);
}

TEST(CorrelativeSearch, EmptyInputGivesNoMatch) {
  const Points walls = room();
  const Points none;
  const CorrelativeField empty{none};
  const CorrelativeField field{walls};
  EXPECT_EQ(empty.score(walls, {}), 0.0);
  EXPECT_EQ(field.score(none, {}), 0.0);
  EXPECT_FALSE(empty.best(walls, {}, {}, 0.0));
  EXPECT_FALSE(field.best(none, {}, {}, 0.0));
  EXPECT_FALSE(field.best(walls, {}, {}, 1.01)) << "no score is above 1";
  EXPECT_FALSE(field.best(walls, {1e9, 0.0, 0.0}, {}, 0.0)) << "nothing near";
  EXPECT_FALSE(field.best_apart_from({}, 9.0, 4.0, walls, {}, {}, 0.0)) << "all too near";
}

TEST(CorrelativeSearch, OutliersInSubmapAndScanAreIgnored) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const Points outliers{{1e12, 0.0}, {0.0, -5e3}, {kInf, 0.0}, {0.0, kNan}, {-kInf, kNan}};
  Points walls = room();
  const CorrelativeField clean{walls};
  Points seen = walls;
  const double share =
      static_cast<double>(walls.size()) / static_cast<double>(walls.size() + outliers.size());
  walls.insert(walls.end(), outliers.begin(), outliers.end());
  seen.insert(seen.begin(), outliers.begin(), outliers.end());
  const CorrelativeField field{walls};

  EXPECT_EQ(field.score(seen, {0.1, 0.2, 0.3}), clean.score(seen, {0.1, 0.2, 0.3}));
  const auto match = field.best(seen, {0.2, -0.1, 0.0}, {0.5, 0.2}, 0.5);
  ASSERT_TRUE(match);
  EXPECT_NEAR(match->score, share, kRounding) << "outliers count as misses";
  EXPECT_NEAR(match->submap_from_base.translation().norm(), 0.0, kRounding);
}

TEST(CorrelativeSearch, InfiniteWindowsTerminate) {
  const Points walls = rectangle(1.0, 0.6);
  const CorrelativeField field{walls};
  const auto match = field.best(walls, {0.3, 0.0, 0.0}, {1e300, 1e300}, 0.5);
  ASSERT_TRUE(match);
  EXPECT_GT(match->score, 0.9);
}

TEST(CorrelativeField, AFieldOfAMapContainsEveryWall) {
  Points walls;
  draw_wall({0.0, 0.0}, {300.0, 0.0}, walls);
  draw_wall({298.0, 0.0}, {298.0, 4.0}, walls);
  const Points seen{{0.0, 1.0}, {0.0, 2.0}, {0.0, 3.0}};  // of the short one, from its foot
  const Se2 foot{298.0, 0.0, 0.0};
  EXPECT_EQ(CorrelativeField{walls}.score(seen, foot), 0.0);
  EXPECT_GT(CorrelativeField::of_map(walls).score(seen, foot), 0.8);
}

}  // namespace
}  // namespace waymark
