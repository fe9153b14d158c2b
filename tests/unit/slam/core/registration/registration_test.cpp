// SPDX-License-Identifier: BSD-3-Clause
// Submaps of normal distributions, and where scans fit into them.
#include "common/random/random.hpp"
#include "slam/core/registration/points_in_map.hpp"
#include "slam/core/registration/scan_match.hpp"
#include "slam/core/registration/submap.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace waymark {
namespace {

constexpr double kSigma_m = 0.01;

Eigen::Matrix3d sigmas(double m, double rad) {
  return Eigen::Vector3d{m * m, m * m, rad * rad}.asDiagonal();
}

/// Points on both walls of a bare corridor of 2 m, as seen from `map_from_base`.
Points corridor_from(const Se2& map_from_base, std::uint64_t seed, double sigma_m) {
  Random random{{seed}};
  Points points;
  for (double x = -3.0; x <= 3.0; x += 0.05) {
    for (const double y : {-1.0, 1.0}) {
      const Eigen::Vector2d place{map_from_base.x() + x, y + sigma_m * random.normal()};
      points.push_back(map_from_base.inverse() * place);
    }
  }
  return points;
}

Points corridor_from(const Se2& map_from_base, std::uint64_t seed) {
  return corridor_from(map_from_base, seed, kSigma_m);
}

/// Points of the map as seen from a pose, with noise.
struct NoisyView {
  Se2 map_from_base;
  Random random;
  Points points{};

  NoisyView(const Se2& from, std::uint64_t seed) : map_from_base{from}, random{{seed}} {}

  void add(double x, double y) {
    points.push_back(map_from_base.inverse() * Eigen::Vector2d{x + kSigma_m * random.normal(),
                                                               y + kSigma_m * random.normal()});
  }
};

/// The walls of a room of 6 m x 4 m about the map's origin.
Points room_from(const Se2& map_from_base, std::uint64_t seed) {
  NoisyView view{map_from_base, seed};
  for (double x = -3.0; x <= 3.0; x += 0.08) {
    view.add(x, -2.0);
    view.add(x, 2.0);
  }
  for (double y = -2.0; y <= 2.0; y += 0.08) {
    view.add(-3.0, y);
    view.add(3.0, y);
  }
  return view.points;
}

template <class ViewFrom>
Submap submap_of(ViewFrom view, double step_m = 0.1) {
  Submap submap{0.25, 0};
  for (std::uint64_t k = 0; k < 20; ++k) {
    const Se2 pose{step_m * static_cast<double>(k), 0.0, 0.0};
    submap.insert(view(pose, k + 1), pose);
  }
  return submap;
}

TEST(ScanMatch, FindsThePoseInARoom) {
  const Submap room = submap_of(room_from);
  const Se2 truth{1.2, 0.3, 0.2};
  const Se2 guess{1.28, 0.22, 0.26};
  const ScanMatch match = match_scan(room_from(truth, 99), room.ndt(), guess, sigmas(0.1, 0.05),
                                     RangeNoise{kSigma_m}, {});
  EXPECT_NEAR(match.map_from_base.x(), truth.x(), 0.005);
  EXPECT_NEAR(match.map_from_base.y(), truth.y(), 0.005);
  EXPECT_NEAR(match.map_from_base.theta(), truth.theta(), 0.002);
  EXPECT_FALSE(match.observed.is_degenerate);
  EXPECT_GT(match.inlier_share, 0.9);
}

TEST(ScanMatch, CoarseCellsConvergeFromAGuessOutsideTheBasinOfTheFinestOnes) {
  const Submap room = submap_of(room_from);
  const Se2 truth{1.2, 0.3, 0.2};
  const Se2 guess{0.5, 0.8, -0.05};
  const Points points = room_from(truth, 99);
  const auto off_m = [&](std::span<const NdtMap> coarse) {
    const ScanMatch match =
        match_scan(points, room.ndt(), guess, sigmas(0.5, 0.2), RangeNoise{kSigma_m}, {}, coarse);
    return pose_difference(match.map_from_base, truth).norm();
  };
  EXPECT_LT(off_m(room.coarse_ndt()), 0.01);
  EXPECT_GT(off_m({}), 0.3);
}

TEST(ScanMatch, ABareCorridorHasNoInformationAlongItsAxis) {
  const Submap corridor =
      submap_of([](const Se2& pose, std::uint64_t seed) { return corridor_from(pose, seed); });
  const Se2 truth{1.0, 0.1, 0.05};
  const Se2 guess{1.4, 0.05, 0.03};
  const ScanMatch match = match_scan(corridor_from(truth, 99), corridor.ndt(), guess,
                                     sigmas(0.1, 0.05), RangeNoise{kSigma_m}, {});
  ASSERT_TRUE(match.observed.is_degenerate);
  const Eigen::Vector3d weak{match.observed.weak_direction.x(), match.observed.weak_direction.y(),
                             0.0};
  EXPECT_GT(std::abs(weak.x()), 0.999);
  const Eigen::Matrix3d& information = match.observed.information;
  EXPECT_LT((information * weak).norm(), 1e-9 * information.norm());
  EXPECT_NEAR(match.map_from_base.x(), guess.x(), 0.01);  // stays at the guess
  EXPECT_NEAR(match.map_from_base.y(), truth.y(), 0.005);
  EXPECT_NEAR(match.map_from_base.theta(), truth.theta(), 0.002);
}

TEST(ScanMatch, ABareCorridorStaysDegenerateWithNoisyRanges) {
  constexpr double kScatter_m = 0.08;
  const Submap corridor = submap_of(
      [](const Se2& pose, std::uint64_t seed) { return corridor_from(pose, seed, kScatter_m); });
  const Se2 truth{1.0, 0.1, 0.05};
  const ScanMatch match = match_scan(corridor_from(truth, 99, kScatter_m), corridor.ndt(), truth,
                                     sigmas(0.1, 0.05), RangeNoise{kScatter_m}, {});
  EXPECT_TRUE(match.observed.is_degenerate);
}

/// A corridor with pillars of 40 cm on one side, 3 m apart.
Points pillars_from(const Se2& map_from_base, std::uint64_t seed) {
  Points points = corridor_from(map_from_base, seed);
  for (const double x : {0.0, 3.0})
    for (double y = 0.6; y <= 1.0; y += 0.05)
      points.push_back(map_from_base.inverse() * Eigen::Vector2d{x, y});
  return points;
}

TEST(ScanMatch, AFewPillarsObserveTheAxisOfACorridor) {
  const Submap corridor = submap_of(pillars_from);
  const Se2 truth{1.0, 0.1, 0.05};
  const Se2 guess{1.04, 0.05, 0.03};
  const ScanMatch match = match_scan(pillars_from(truth, 99), corridor.ndt(), guess,
                                     sigmas(0.1, 0.05), RangeNoise{kSigma_m}, {});
  EXPECT_FALSE(match.observed.is_degenerate);
  EXPECT_NEAR(match.map_from_base.x(), truth.x(), 0.01);
}

/// A corridor with a door that stands back by 0.2 m on one side.
Points door_from(const Se2& map_from_base, std::uint64_t seed) {
  NoisyView view{map_from_base, seed};
  for (double x = -2.0; x <= 4.0; x += 0.05) {
    view.add(x, -1.0);
    view.add(x, x > 2.0 && x < 3.0 ? 1.2 : 1.0);
  }
  for (double y = 1.02; y < 1.2; y += 0.02)
    view.add(3.0, y);
  return view.points;
}

TEST(ScanMatch, AShallowDoorObservesTheAxisOfACorridor) {
  const Submap corridor = submap_of(door_from);
  const Se2 truth{1.0, 0.1, 0.05};
  const Se2 guess{1.03, 0.1, 0.05};
  const ScanMatch match = match_scan(door_from(truth, 99), corridor.ndt(), guess, sigmas(0.1, 0.05),
                                     RangeNoise{kSigma_m}, {});
  EXPECT_FALSE(match.observed.is_degenerate);
  EXPECT_NEAR(match.map_from_base.x(), truth.x(), 0.015);
}

/// Somebody who walks ahead of the robot.
Points companion_from(const Se2& map_from_base, std::uint64_t seed) {
  Points points = corridor_from(map_from_base, seed);
  for (double y = -0.1; y < 0.12; y += 0.05)
    points.push_back(map_from_base.inverse() * Eigen::Vector2d{map_from_base.x() + 1.0, y});
  return points;
}

TEST(ScanMatch, APersonWalkingAheadDoesNotMakeTheAxisObservable) {
  const Submap corridor = submap_of(companion_from, 0.3);
  const Se2 truth{5.8, 0.0, 0.0};
  const ScanMatch match = match_scan(companion_from(truth, 99), corridor.ndt(), truth,
                                     sigmas(0.1, 0.05), RangeNoise{kSigma_m}, {});
  EXPECT_TRUE(match.observed.is_degenerate);
}

/// A corridor with a door frame that stands out from one wall by 6 cm.
Points frame_from(const Se2& map_from_base, std::uint64_t seed) {
  NoisyView view{map_from_base, seed};
  view.points = corridor_from(map_from_base, seed);
  for (double y = 0.94; y < 1.0; y += 0.02)
    view.add(2.5, y);
  return view.points;
}

using View = Points (*)(const Se2& map_from_base, std::uint64_t seed);

/// Of a scan 2 cm behind its guess.
ScanMatch with_settled_walls_of(const Submap& corridor, View view) {
  const Points scan = view({1.0, 0.0, 0.0}, 99);
  const Eigen::Matrix3d covariance = sigmas(0.02, 0.01);
  const ScanMatch plain =
      match_scan(scan, corridor.ndt(), {1.02, 0.0, 0.0}, covariance, RangeNoise{kSigma_m}, {});
  EXPECT_TRUE(plain.observed.is_degenerate);
  EXPECT_NEAR(plain.map_from_base.x(), 1.02, 0.001);
  return with_settled_walls(plain, scan, corridor.ndt(), covariance, RangeNoise{kSigma_m}, {});
}

/// Its information along its weak direction, relative to that across.
double share_along_weak(const ScanMatch& match) {
  const Eigen::Matrix2d information = match.observed.information.topLeftCorner<2, 2>();
  const Eigen::Vector2d& weak = match.observed.weak_direction;
  return weak.dot(information * weak) / information.trace();
}

TEST(SettledWalls, MoveADegenerateMatchAlongTheAxisWithLittleInformation) {
  const ScanMatch match = with_settled_walls_of(submap_of(frame_from), frame_from);
  EXPECT_TRUE(match.observed.is_degenerate);
  EXPECT_NEAR(match.map_from_base.x(), 1.0, 0.012);
  EXPECT_GT(share_along_weak(match), 1e-5);
  EXPECT_LT(share_along_weak(match), 1e-3);
}

TEST(SettledWalls, CellsThatFewKeyframesHaveSeenTellNothingAlongTheAxis) {
  Submap corridor{0.25, 0};
  for (std::uint64_t k = 0; k < 9; ++k)
    corridor.insert(frame_from({0.1 * static_cast<double>(k), 0.0, 0.0}, k + 1),
                    {0.1 * static_cast<double>(k), 0.0, 0.0});
  const ScanMatch match = with_settled_walls_of(corridor, frame_from);
  EXPECT_NEAR(match.map_from_base.x(), 1.02, 0.001);
  EXPECT_LT(share_along_weak(match), 1e-12);
}

TEST(SettledWalls, ABareCorridorTellsNothingAlongItsAxis) {
  const View bare = corridor_from;
  const ScanMatch match = with_settled_walls_of(submap_of(bare), bare);
  EXPECT_LT(share_along_weak(match), 1e-12);
}

constexpr double kManyScatter_m = 0.05;

constexpr int kKeyframes = 20;

/// A piece of wall of 1 m, at a right angle to the beam in its middle.
Points wall_ahead() {
  Points points;
  for (double y = -0.5; y <= 0.5; y += 0.02)
    points.emplace_back(3.0, y);
  return points;
}

/// Match of a scan whose points lie exactly on the mapped ones, with a noisy LiDAR.
ScanMatch match_without_a_deviation(const Points& points, int keyframes = kKeyframes,
                                    std::size_t first_keyframe = 0) {
  Submap wall{0.25, first_keyframe};
  for (int i = 0; i < keyframes; ++i)
    wall.insert(points, {});
  return match_scan(points, wall.ndt(), {}, sigmas(0.02, 0.01), RangeNoise{kManyScatter_m}, {});
}

/// Factor on the information of beams that end on a wall observed from so many keyframes.
double known_share(int keyframes) {
  return keyframes / (keyframes + 3.0);
}

/// Information of so many beams that meet a wall at a right angle, if they were independent.
double information_of(std::size_t beams) {
  return known_share(kKeyframes) * static_cast<double>(beams) / (kManyScatter_m * kManyScatter_m);
}

TEST(ScanMatch, WallsObservedFromFewKeyframesAddLessInformation) {
  const Points points = wall_ahead();
  const double few = match_without_a_deviation(points, 1).observed.information(0, 0);
  const double many = match_without_a_deviation(points).observed.information(0, 0);
  EXPECT_NEAR(few / many, known_share(1) / known_share(kKeyframes), 0.01);
}

TEST(ScanMatch, AWallThatOnlyTheFirstKeyframeObservedIsNoBetterKnownThanOneOfALaterKeyframe) {
  const Points points = wall_ahead();
  EXPECT_EQ(match_without_a_deviation(points, 1, 0).observed.information(0, 0),
            match_without_a_deviation(points, 1, 7).observed.information(0, 0));
}

TEST(ScanMatch, CellsThatLookThinByChanceAddNoInformationBeyondTheRangeNoise) {
  const Points points = wall_ahead();
  const ScanMatch match = match_without_a_deviation(points);
  EXPECT_LE(match.observed.information(0, 0), information_of(points.size()) * 1.03);
  EXPECT_EQ(match.inlier_share, 1.0);
}

TEST(ScanMatch, RangeNoiseAcrossAWallShrinksAtGrazingIncidence) {
  Points points;
  for (double x = 4.0; x <= 5.0; x += 0.02)
    points.emplace_back(x, 1.0);
  const ScanMatch match = match_without_a_deviation(points);
  EXPECT_GT(match.observed.information(1, 1), 4.0 * information_of(points.size()));
}

TEST(ScanMatch, ManyBeamsInOneCellHaveTheInformationOfAFew) {
  EXPECT_EQ(independent_share(1), 1.0);
  EXPECT_EQ(20 * independent_share(20), 10 * independent_share(10));
  Points points;
  for (int i = 0; i < 40; ++i)
    points.emplace_back(3.0, 0.05 * i / 40.0);
  const ScanMatch match = match_without_a_deviation(points);
  EXPECT_LT(match.observed.information(0, 0), 0.15 * information_of(points.size()));
}

TEST(ScanMatch, AGuessThatCountsAsCertainDoesNotHoldTheMatch) {
  const Submap submap = submap_of(room_from);
  const Se2 truth{0.7, 0.1, 0.0};
  const auto matched_x_m = [&](double guess_off_m) {
    return match_scan(room_from(truth, 77), submap.ndt(), truth * Se2{guess_off_m, 0.0, 0.0},
                      sigmas(0.001, 0.001), RangeNoise{kSigma_m}, {})
        .map_from_base.x();
  };
  EXPECT_NEAR(matched_x_m(0.05), matched_x_m(-0.05), 0.002);
}

/// The turn about the pole is unobserved, and so is the sideways motion that goes with it.
TEST(ScanMatch, ASinglePoleFarAwayLeavesTheHeadingAsGuessed) {
  const auto pole_from = [](const Se2& map_from_base, std::uint64_t seed) {
    Random random{{seed}};
    Points points;
    for (int i = 0; i < 10; ++i)
      points.push_back(map_from_base.inverse() *
                       Eigen::Vector2d{10.0 + kSigma_m * random.normal(),
                                       0.1 + 0.002 * i + kSigma_m * random.normal()});
    return points;
  };
  const Submap submap = submap_of(pole_from);
  for (std::uint64_t seed = 100; seed < 130; ++seed) {
    const Se2 truth{1.0, 0.0, 0.0};
    const Se2 guess{1.0, 0.0, 0.01};
    const ScanMatch match = match_scan(pole_from(truth, seed), submap.ndt(), guess,
                                       sigmas(0.01, 0.01), RangeNoise{kSigma_m}, {});
    EXPECT_LT(std::abs(match.map_from_base.y()), 0.15) << seed;
    EXPECT_LT(std::abs(match.map_from_base.theta()), 0.02) << seed;
  }
}

TEST(ScanMatch, SharesOfKeyframesSumToOne) {
  const Submap room = submap_of(room_from);
  const ScanMatch match = match_scan(room_from({1.0, 0.0, 0.0}, 99), room.ndt(), {1.0, 0.0, 0.0},
                                     sigmas(0.02, 0.01), RangeNoise{kSigma_m}, {});
  double sum = 0.0;
  for (const double share : match.keyframe_shares)
    sum += share;
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

TEST(ScanMatch, AnEmptyScanIsNotUsable) {
  const Submap room = submap_of(room_from);
  const ScanMatch match =
      match_scan({}, room.ndt(), {}, sigmas(0.1, 0.05), RangeNoise{kSigma_m}, {});
  EXPECT_FALSE(match.is_usable({}));
}

TEST(ScanMatch, FewInliersOrNoHeadingAreNotUsable) {
  ScanMatch match;
  match.inliers = ScanMatchConfig{}.min_inliers;
  EXPECT_FALSE(match.is_usable({}));
  match.observed.information(2, 2) = 1.0;
  EXPECT_TRUE(match.is_usable({}));
  --match.inliers;
  EXPECT_FALSE(match.is_usable({}));
}

/// The information is about x + heading: without information about x, none about the heading is
/// left.
TEST(ObservedAxes, DroppingADirectionKeepsTheMarginalInformationOfTheOthers) {
  const Eigen::Vector3d sum{1.0, 0.0, 1.0};  // of x and the heading
  ObservedAxes observed;
  observed.information = 100.0 * sum * sum.transpose();
  observed.information.diagonal() += Eigen::Vector3d{1.0, 4.0, 9.0};
  const Eigen::Matrix3d covariance = observed.information.inverse();
  observed.drop_information_along(Eigen::Vector2d::UnitX());
  EXPECT_LT(observed.information.col(0).norm(), 1e-9);
  EXPECT_NEAR(observed.information(1, 1), 1.0 / covariance(1, 1), 1e-9);
  EXPECT_NEAR(observed.information(2, 2), 1.0 / covariance(2, 2), 1e-9);
  EXPECT_TRUE(observed.is_along_weak({-0.7, 0.01}));
  EXPECT_FALSE(observed.is_along_weak({0.5, 0.5}));
  EXPECT_FALSE(ObservedAxes{}.is_along_weak({1.0, 0.0}));
}

TEST(ObservedAxes, ADirectionWithTooSmallAShareOfTheInformationIsNotObserved) {
  Eigen::Matrix3d information = Eigen::Vector3d{100.0, 4.0, 300.0}.asDiagonal();
  EXPECT_FALSE(observed_axes(information, 0.03).is_degenerate);
  information(1, 1) = 2.0;
  const ObservedAxes observed = observed_axes(information, 0.03);
  EXPECT_TRUE(observed.is_degenerate);
  EXPECT_EQ(observed.information(1, 1), 0.0);
  EXPECT_EQ(observed.information(0, 0), 100.0);
}

}  // namespace
}  // namespace waymark
