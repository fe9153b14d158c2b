// SPDX-License-Identifier: BSD-3-Clause
// Loops: what is found in old submaps, and what is refused.
#include "slam/core/graph/loop_finder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>

namespace waymark {
namespace {

constexpr double kView_m = 4.0;

/// Walls of a corridor along x with a pillar wherever `has_pillar` says, seen from a pose.
template <class HasPillar>
Points view(const Se2& map_from_base, HasPillar has_pillar) {
  Points points;
  const auto add = [&](double x, double y) {
    const Eigen::Vector2d seen = map_from_base.inverse() * Eigen::Vector2d{x, y};
    if (seen.norm() < kView_m) points.push_back(seen);
  };
  for (int i = -100; i < 600; ++i) {
    const double x = 0.05 * i;
    const bool is_pillar = has_pillar(x);
    add(x, is_pillar ? 0.8 : 2.0);
    add(x, is_pillar ? -0.9 : -2.0);
  }
  for (int i = -100; i < 600; ++i) {
    const double x = 0.05 * i;
    if (has_pillar(x) == has_pillar(x + 0.05)) continue;
    for (double y = 0.8; y < 2.0; y += 0.04) {
      add(x, y);
      add(x, -y - 0.1);
    }
  }
  return points;
}

bool every_two_metres(double x) {
  return std::fmod(x + 100.0, 2.0) < 0.4;
}

/// No two distances between pillars are equal.
bool irregularly(double x) {
  for (const double pillar_m : {0.7, 1.9, 4.4, 5.3, 8.1, 9.0, 10.6, 13.5})
    if (x >= pillar_m && x < pillar_m + 0.4) return true;
  return false;
}

template <class HasPillar>
class Corridor {
 public:
  explicit Corridor(HasPillar has_pillar) : has_pillar_{has_pillar} {
    submaps_.emplace_back(0.25, 0);
    for (std::size_t k = 0; k < 40; ++k) {
      const Se2 pose{3.0 + 0.2 * static_cast<double>(k), 0.0, 0.0};
      state_.keyframes.push_back(pose);
      submaps_.back().insert(view(pose, has_pillar_), Se2{3.0, 0.0, 0.0}.inverse() * pose);
    }
  }

  /// The robot is at `truth`; its estimate is `estimated`.
  std::vector<LoopFinder::Found> look_around(const Se2& truth, const Se2& estimated) {
    LoopSearch search;
    search.map_from_base = estimated;
    search.driven_m = LoopConfig{}.every_m;
    search.covariance_against = [this](std::size_t) {
      return covariance_against_;
    };
    search.first_recent_keyframe = 1000;
    search.covariance_since = [this](std::size_t) {
      return covariance_since_;
    };
    Points points = view(truth, has_pillar_);
    const std::size_t num_walls = points.size();
    for (std::size_t i = 0; i < num_walls / 4 && has_clutter_; ++i)  // behind the walls
      points.emplace_back(0.01 * static_cast<double>(i), 3.0);
    return finder_.find(1000, points, search, submaps_, state_, RangeNoise{0.01});
  }

  /// A fifth of each view is nowhere in the map.
  void add_clutter() { has_clutter_ = true; }

  void set_drift_since_found(double sigma) {
    covariance_since_ = sigma * sigma * Eigen::Matrix3d::Identity();
  }

  /// Sigma of the pose relative to the submap.
  void set_drift(double sigma) {
    covariance_against_ = sigma * sigma * Eigen::Matrix3d::Identity();
  }

  /// The same along the corridor only.
  void set_drift_along(double sigma_m) { covariance_against_(0, 0) = sigma_m * sigma_m; }

  const LoopFinder& finder() const { return finder_; }

 private:
  HasPillar has_pillar_;
  bool has_clutter_{false};
  Eigen::Matrix3d covariance_against_{Eigen::Vector3d{1.0, 0.04, 0.04}.asDiagonal()};
  Eigen::Matrix3d covariance_since_{Eigen::Matrix3d::Identity()};
  LoopFinder finder_{LoopConfig{}, ScanMatchConfig{}};
  std::deque<Submap> submaps_{};
  State state_{};
};

TEST(LoopFinder, TwoScansThatAgreeCloseALoop) {
  Corridor corridor{irregularly};
  const Se2 drift{1.2, 0.1, 0.3};
  const Se2 first{6.0, 0.0, 0.0};
  const Se2 second{6.5, 0.0, 0.0};
  EXPECT_TRUE(corridor.look_around(first, drift * first).empty());
  const auto found = corridor.look_around(second, drift * second);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NEAR((Se2{3.0, 0.0, 0.0} * found[1].loop.match.map_from_base).x(), second.x(), 0.05);
}

/// The drift since the submap is underestimated: by good luck, or because fewer walls fit by
/// chance, the first search reached the right place all the same.
TEST(LoopFinder, TheSecondScanIsSearchedForAtThePoseCorrectedByTheFirstMatch) {
  const Se2 drift{1.2, 0.1, 0.1};
  const Se2 first{6.0, 0.0, 0.0};
  for (const bool has_candidate : {false, true}) {
    for (const double moved_by_m : {0.5, 1.0}) {
      Corridor corridor{irregularly};
      corridor.set_drift_since_found(0.01);
      if (has_candidate) {
        EXPECT_TRUE(corridor.look_around(first, drift * first).empty());
      }
      corridor.set_drift(0.02);
      const Se2 second{6.0 + moved_by_m, 0.0, 0.0};
      const auto found = corridor.look_around(second, drift * second);
      EXPECT_EQ(found.size(), has_candidate ? 2U : 0U) << moved_by_m;
    }
  }
}

/// The second scan does not fit where the candidate would have the robot.
TEST(LoopFinder, AWrongCandidateIsNotConfirmed) {
  Corridor corridor{irregularly};
  corridor.set_drift_since_found(0.01);
  const Se2 drift{1.2, 0.1, 0.1};
  const Se2 first{6.0, 0.0, 0.0};
  EXPECT_TRUE(corridor.look_around(first, drift * first).empty());
  corridor.set_drift(0.02);
  const Se2 second{7.5, 0.0, 0.0};
  EXPECT_TRUE(corridor.look_around(second, drift * Se2{6.5, 0.0, 0.0}).empty());
}

/// The candidate's keyframe may have been removed meanwhile.
TEST(LoopFinder, ACandidateExpiresWithTheDistance) {
  Corridor corridor{irregularly};
  const Se2 drift{1.2, 0.1, 0.3};
  const Se2 place{6.0, 0.0, 0.0};
  EXPECT_TRUE(corridor.look_around(place, drift * place).empty());
  const Se2 far_from_any_submap{500.0, 0.0, 0.0};
  for (double driven_m = 0.0; driven_m < 6.0; driven_m += LoopConfig{}.every_m)
    EXPECT_TRUE(corridor.look_around(far_from_any_submap, far_from_any_submap).empty());
  EXPECT_TRUE(corridor.look_around(place, drift * place).empty());
}

/// A place beyond the possible drift is not searched, even if it looks alike.
TEST(LoopFinder, TheSearchIsBoundedByTheDriftSinceTheSubmap) {
  const Se2 first{6.0, 0.0, 0.0};
  const Se2 second{6.5, 0.0, 0.0};
  const Se2 drift{12.0, 0.0, 0.0};
  for (const double drift_m : {0.1, 4.0}) {
    Corridor corridor{irregularly};
    corridor.set_drift_along(drift_m);
    EXPECT_TRUE(corridor.look_around(first, drift * first).empty());
    EXPECT_EQ(corridor.look_around(second, drift * second).size(), drift_m < 1.0 ? 0U : 2U);
  }
}

TEST(LoopFinder, AMatchThatContradictsARecentLoopNeedsABetterFit) {
  const Se2 drift{0.7, 0.0, 0.0};
  const Se2 first{6.0, 0.0, 0.0};
  const Se2 second{6.5, 0.0, 0.0};
  for (const double drift_since_found : {0.01, 1.0}) {
    Corridor corridor{irregularly};
    corridor.add_clutter();
    corridor.set_drift_since_found(drift_since_found);
    const Se2 before{5.5, 0.0, 0.0};
    EXPECT_EQ(corridor.look_around(before, before).size(), 1U);
    EXPECT_TRUE(corridor.look_around(first, drift * first).empty());
    EXPECT_EQ(corridor.look_around(second, drift * second).size(),
              drift_since_found < 0.1 ? 0U : 2U);
  }
}

/// All walls look alike: one of them does not refute the covariance of the pose.
TEST(LoopFinder, ADegenerateMatchBeyondTheGateIsRejected) {
  const Se2 drift{0.0, 1.1, 0.0};
  const auto found_in = [&](auto has_pillar) {
    Corridor corridor{has_pillar};
    const Se2 first{6.0, 0.0, 0.0};
    const Se2 second{6.5, 0.0, 0.0};
    EXPECT_TRUE(corridor.look_around(first, drift * first).empty());
    return corridor.look_around(second, drift * second).size();
  };
  EXPECT_EQ(found_in(irregularly), 2U);
  EXPECT_EQ(found_in([](double) { return false; }), 0U);
}

/// At the end of the mapped part of a bare corridor, more of a scan is mapped further back.
TEST(LoopFinder, AMatchDoesNotCorrectThePoseAlongAWall) {
  Corridor corridor{[](double) {
    return false;
  }};
  for (const double x : {16.0, 16.5, 17.0}) {
    const Se2 beyond{x, 0.0, 0.0};
    EXPECT_TRUE(corridor.look_around(beyond, beyond).empty()) << x;
  }
}

/// Half a period, a whole one, and none: the scan fits in all three places.
TEST(LoopFinder, SimilarPlacesStayAmbiguous) {
  Corridor corridor{every_two_metres};
  int looks = 0;
  for (const double drift_m : {1.0, 2.0, 0.0}) {
    const Se2 drift{drift_m, 0.1, 0.1};
    for (const double x : {6.0, 6.5, 7.0}) {
      const Se2 truth{x, 0.0, 0.0};
      EXPECT_TRUE(corridor.look_around(truth, drift * truth).empty()) << drift_m << " " << x;
      ++looks;
    }
  }
  EXPECT_EQ(corridor.finder().num_ambiguous(), looks);
}

}  // namespace
}  // namespace waymark
