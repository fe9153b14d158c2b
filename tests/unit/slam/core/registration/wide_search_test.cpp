// SPDX-License-Identifier: BSD-3-Clause
// A scan that fits badly, searched for in a room of 6 m x 4 m.
#include "slam/core/registration/wide_search.hpp"

#include "common/geometry/squared.hpp"
#include "fits.hpp"
#include "slam/core/registration/submap.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr double kSpacing_m = 0.05;
const Se2 kTruth{3.0, 0.3, 0.0};
const Se2 kPlain{2.0, 0.0, 0.3};

Points walls(double from_x, double to_x) {
  Points points;
  for (double x = from_x; x <= to_x; x += kSpacing_m) {
    points.emplace_back(x, -2.0);
    points.emplace_back(x, 2.0);
  }
  return points;
}

Points end_wall(double x, double from_y) {
  Points points;
  for (double y = from_y; y <= 2.0; y += kSpacing_m)
    points.emplace_back(x, y);
  return points;
}

Points together(Points a, const Points& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

Points seen_from(const Se2& map_from_base, Points points) {
  for (Eigen::Vector2d& point : points)
    point = map_from_base.inverse() * point;
  return points;
}

Points whole_room() {
  return together(walls(0.0, 6.0), together(end_wall(0.0, -2.0), end_wall(6.0, -2.0)));
}

Submap mapped_room() {
  Submap submap{0.25, 0};
  for (int i = 0; i < 5; ++i)
    submap.insert(whole_room(), {});
  return submap;
}

/// Of a map that contradicts all beams at `wrong`, and fewer with the distance from it.
double misfit_near(const Se2& wrong, const Se2& map_from_base) {
  return std::exp(-pose_difference(map_from_base, wrong).norm());
}

WideSearch around(const Se2& guess, double since_last_s = 0.0) {
  WideSearch search;
  search.by_odometry = guess;
  search.since_last_s = since_last_s;
  search.min_score = 0.1;
  search.misfit = [guess](const Se2& map_from_base) {
    return misfit_near(guess, map_from_base);
  };
  return search;
}

struct Searched {
  ScanMatch plain{};
  ScanMatch best{};
};

Searched look_for(const Submap& submap, const Points& points, const Se2& guess,
                  const WideSearch& search) {
  const Eigen::Matrix3d sigmas = Eigen::Vector3d{1e-4, 1e-4, 1e-4}.asDiagonal();
  const RangeNoise noise{0.01};
  const ScanMatchConfig config;
  Searched searched;
  searched.plain = match_scan(points, submap.ndt(), guess, sigmas, noise, config);
  searched.best = searched_widely(searched.plain, points, submap.ndt(), submap.points(), search,
                                  after_good_scans(), noise, config);
  return searched;
}

TEST(WideSearch, FindsAPoseThatIsFarFromItsGuess) {
  const Se2 truth{3.0, 0.3, 0.0};
  const Points scan = seen_from(truth, whole_room());
  const Se2 guess{2.6, 0.1, 0.4};
  const Searched found = look_for(mapped_room(), scan, guess, around(guess));
  EXPECT_LT(pose_difference(found.best.map_from_base, truth).norm(), 0.02);
  EXPECT_GT(found.best.inliers, found.plain.inliers);
}

TEST(WideSearch, TheWindowOfTurnsGrowsWithTheTimeSinceTheLastScan) {
  const Se2 truth{3.0, 0.3, 0.0};
  const Points scan = seen_from(truth, whole_room());
  const Se2 guess{3.0, 0.3, 1.4};
  const auto off = [&](double since_last_s) {
    const Searched found = look_for(mapped_room(), scan, guess, around(guess, since_last_s));
    return pose_difference(found.best.map_from_base, truth).norm();
  };
  EXPECT_GT(off(0.2), 0.5);
  EXPECT_LT(off(3.0), 0.02);
}

/// Odometry that turned wrongly before a way of 1.5 m is off by as much.
TEST(WideSearch, TheWindowOfPositionsGrowsWithTheDistanceDriven) {
  const Se2 truth{3.0, 0.3, 0.0};
  const Points scan = seen_from(truth, whole_room());
  const Se2 guess{2.0, -0.6, 0.5};
  const auto off = [&](double driven_m) {
    WideSearch search = around(guess);
    search.driven_m = driven_m;
    const Searched found = look_for(mapped_room(), scan, guess, search);
    return pose_difference(found.best.map_from_base, truth).norm();
  };
  EXPECT_GT(off(0.2), 0.5);
  EXPECT_LT(off(1.5), 0.02);
}

/// The room looks almost the same after a turn of 180 degrees.
TEST(WideSearch, OfTwoPlacesTheOneWithMoreInliersIsTakenWhateverTheirOrder) {
  Submap submap = mapped_room();
  Points crate;
  for (double x = 4.0; x < 4.4; x += kSpacing_m)
    crate.emplace_back(x, 1.0);
  for (int i = 0; i < 5; ++i)
    submap.insert(crate, {});
  const Se2 truth{3.0, 0.3, 0.0};
  const Points scan = seen_from(truth, together(whole_room(), crate));
  const Se2 turned_round{3.0, -0.3, std::numbers::pi};
  WideSearch search = around(truth);
  search.without_odometry = {turned_round};
  const Searched found = look_for(submap, scan, {3.0, 0.0, 1.5}, search);
  EXPECT_LT(pose_difference(found.best.map_from_base, truth).norm(), 0.05);
}

/// A part of the scan is nowhere in the map; of the rest, so much lies on walls where plain
/// matching ended.
ScanMatch searched_from_plain(double share_of_plain, double odometry_sigma_m,
                              const Se2& by_odometry = {2.5, 0.0, 0.3},
                              std::size_t nowhere_one_in = 6, double since_last_s = 0.0) {
  const Submap submap = mapped_room();
  Points room = whole_room();
  const std::size_t all = room.size();
  for (std::size_t i = 0; i < all / nowhere_one_in; ++i)
    room.emplace_back(kSpacing_m * static_cast<double>(i), 7.0);
  ScanMatch plain;
  plain.map_from_base = kPlain;
  plain.inliers = static_cast<int>(share_of_plain * static_cast<double>(all));
  plain.inlier_share = 1.0;
  plain.mapped_share = share_of_plain;
  WideSearch search = around(by_odometry, since_last_s);
  search.without_odometry = {kTruth};
  search.odometry_covariance = squared(odometry_sigma_m) * Eigen::Matrix3d::Identity();
  return searched_widely(plain, seen_from(kTruth, room), submap.ndt(), submap.points(), search,
                         after_good_scans(), RangeNoise{0.01}, ScanMatchConfig{});
}

TEST(WideSearch, APlaceWhereTheScanFitsNearlyAsUsualNeedsTwiceTheInliers) {
  for (const double share_of_plain : {0.4, 0.6}) {
    const ScanMatch best = searched_from_plain(share_of_plain, 0.5);
    const Se2& expected = share_of_plain < 0.5 ? kTruth : kPlain;
    EXPECT_LT(pose_difference(best.map_from_base, expected).norm(), 0.02) << share_of_plain;
  }
}

TEST(WideSearch, OfTwoPlacesThatOdometryContradictsTheOneWithMoreInliersIsTaken) {
  const ScanMatch best = searched_from_plain(0.6, 0.05);
  EXPECT_LT(pose_difference(best.map_from_base, kTruth).norm(), 0.02);
}

TEST(WideSearch, APlaceThatOdometryContradictsHasToExplainMostOutliers) {
  for (const double share_of_plain : {0.7, 0.85}) {
    const ScanMatch best = searched_from_plain(share_of_plain, 0.05, kPlain, 10);
    const Se2& expected = share_of_plain < 0.8 ? kTruth : kPlain;
    EXPECT_LT(pose_difference(best.map_from_base, expected).norm(), 0.02) << share_of_plain;
  }
}

/// The room looks the same after a turn of 180 degrees; only some time after the last scan are the
/// search windows wide enough for that turn.
TEST(WideSearch, AMatchFarFromOdometryIsTakenOnlyIfNoOtherPoseFits) {
  for (const double since_last_s : {0.0, 5.0}) {
    const ScanMatch best = searched_from_plain(0.7, 0.05, kPlain, 10, since_last_s);
    const Se2& expected = since_last_s < 1.0 ? kTruth : kPlain;
    EXPECT_LT(pose_difference(best.map_from_base, expected).norm(), 0.02) << since_last_s;
  }
}

/// The whole scan fits at the true pose and also after a turn of 180 degrees. That second fit makes
/// the true pose ambiguous, unless the plain match (half of the scan) is itself at the second fit.
TEST(WideSearch, OnlyAPoseAwayFromThePlainMatchCountsAsAnotherPlace) {
  const Submap submap = mapped_room();
  const Points seen = seen_from(kTruth, whole_room());
  const Se2 turned_round{3.0, -0.3, std::numbers::pi};
  ScanMatch plain;
  plain.inliers = static_cast<int>(seen.size()) / 2;
  plain.num_mapped = static_cast<int>(seen.size());
  plain.inlier_share = 0.5;
  plain.mapped_share = 1.0;
  for (const Se2& pose : {kPlain, turned_round}) {
    plain.map_from_base = pose;
    WideSearch search = around(pose, 5.0);
    search.without_odometry = {kTruth};
    search.odometry_covariance = squared(0.02) * Eigen::Matrix3d::Identity();
    const ScanMatch best = searched_widely(plain, seen, submap.ndt(), submap.points(), search,
                                           after_good_scans(), RangeNoise{0.01}, ScanMatchConfig{});
    const Se2& expected = pose.x() < kTruth.x() ? kPlain : kTruth;
    EXPECT_LT(pose_difference(best.map_from_base, expected).norm(), 0.02) << pose.x();
  }
}

/// Two partitions of a corridor, 2 m apart, are in view. With a third one, the scan fits also 2 m
/// further on.
TEST(WideSearch, ASecondFitWithTheSameHeadingMakesTheLineBetweenBothUnobserved) {
  for (const bool has_third : {false, true}) {
    const auto corridor = [&](double from_x, double to_x) {
      Points points = walls(from_x, to_x);
      for (const double x : {5.0, 7.0, 9.0})
        if (x < 8.0 || has_third) points = together(points, end_wall(x, -1.5));
      return points;
    };
    Submap submap{0.25, 0};
    for (int i = 0; i < 5; ++i)
      submap.insert(corridor(0.0, 14.0), {});
    const Se2 truth{6.0, 0.3, 0.0};
    Points seen;
    for (const Eigen::Vector2d& point : seen_from(truth, corridor(0.0, 14.0)))
      if (std::abs(point.x()) < 2.0) seen.push_back(point);
    const Se2 guess{6.0, 0.3, 0.5};
    WideSearch search = around(guess);
    search.driven_m = 1.5;
    search.odometry_covariance = squared(0.02) * Eigen::Matrix3d::Identity();
    const ScanMatch best = look_for(submap, seen, guess, search).best;
    EXPECT_LT(pose_difference(best.map_from_base, truth).norm(), 0.02) << has_third;
    EXPECT_EQ(best.observed.is_degenerate, has_third);
    if (!has_third) continue;
    EXPECT_GT(std::abs(best.observed.weak_direction.x()), 0.99);
    EXPECT_LT(best.observed.information(0, 0), 1.0);
    EXPECT_GT(best.observed.information(1, 1), 1e4);
  }
}

/// A third of the scan fits into the map at a pose far from odometry, as by chance after a gap in a
/// log.
TEST(WideSearch, AMatchFarFromOdometryThatContradictsTheMapNoLessIsRejected) {
  const Submap submap = mapped_room();
  Points room = whole_room();
  const std::size_t all = room.size();
  for (std::size_t i = 0; i < 2 * all; ++i)
    room.emplace_back(kSpacing_m * static_cast<double>(i), 7.0);
  ScanMatch plain;
  plain.map_from_base = kPlain;
  plain.inliers = static_cast<int>(0.3 * static_cast<double>(all));
  plain.num_mapped = static_cast<int>(all);
  plain.inlier_share = 0.3;
  plain.mapped_share = 0.3;
  for (const double misfit : {0.2, 0.4}) {
    WideSearch search = around(kPlain);
    search.without_odometry = {kTruth};
    search.odometry_covariance = squared(0.02) * Eigen::Matrix3d::Identity();
    search.misfit = [misfit](const Se2& map_from_base) {
      return map_from_base.x() > kPlain.x() + 0.5 ? misfit : 0.4;
    };
    const ScanMatch best =
        searched_widely(plain, seen_from(kTruth, room), submap.ndt(), submap.points(), search,
                        after_good_scans(), RangeNoise{0.01}, ScanMatchConfig{});
    const Se2& expected = misfit < 0.4 ? kTruth : kPlain;
    EXPECT_LT(pose_difference(best.map_from_base, expected).norm(), 0.02) << misfit;
  }
}

/// A scan in a corridor fits completely 0.4 m further on, where something stood for all keyframes,
/// or somebody for a few.
TEST(WideSearch, AlongACorridorOnlyWallsThatManyKeyframesHaveSeenRefuteOdometry) {
  const Points cabinet = together(end_wall(7.0, 1.0), end_wall(7.2, 1.0));
  for (const int keyframes_with_it : {20, 5}) {
    Submap submap{0.25, 0};
    for (int i = 0; i < 20; ++i)
      submap.insert(i < keyframes_with_it ? together(walls(0.0, 14.0), cabinet) : walls(0.0, 14.0),
                    {});
    const Se2 truth{6.4, 0.3, 0.0};
    const Points seen = seen_from(truth, together(walls(4.4, 8.4), cabinet));
    const Se2 guess{6.0, 0.3, 0.0};
    WideSearch search = around(guess);
    search.odometry_covariance = squared(0.02) * Eigen::Matrix3d::Identity();
    const Searched found = look_for(submap, seen, guess, search);
    EXPECT_TRUE(found.plain.observed.is_degenerate);
    const Se2& expected = keyframes_with_it == 20 ? truth : guess;
    EXPECT_LT(pose_difference(found.best.map_from_base, expected).norm(), 0.02)
        << keyframes_with_it;
  }
}

TEST(WideSearch, AViewOfANewPlaceKeepsThePlainMatch) {
  // Half of the scan lies behind what is mapped. Nearer to the middle more of it would lie on
  // walls, but the new end of the room would still be nowhere.
  const Se2 truth{5.8, 0.0, 0.0};
  const Points scan = seen_from(truth, together(walls(4.0, 10.0), end_wall(10.0, -2.0)));
  const Searched found = look_for(mapped_room(), scan, truth, around({5.4, 0.0, 0.0}));
  EXPECT_LT(found.plain.mapped_share, 0.6);
  EXPECT_LT(pose_difference(found.best.map_from_base, truth).norm(), 0.05);
}

}  // namespace
}  // namespace waymark
