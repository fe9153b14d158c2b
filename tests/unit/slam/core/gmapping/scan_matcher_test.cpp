// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/gmapping/scan_matcher.hpp"

#include "common/random/random.hpp"
#include "support/plain_hit_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using testing::PlainHitMap;

const GridFrame kFrame = GridFrame::centred_on_map_origin(0.05);

/// Float rounding of one beam's score, see HitCell.
constexpr double kRounding = 1e-6;

std::vector<Beam> beams_to(const std::vector<Eigen::Vector2d>& ends) {
  std::vector<Beam> beams;
  for (const Eigen::Vector2d& end : ends) {
    beams.push_back({static_cast<int>(beams.size()), Eigen::Vector2d::Zero(), end, end.norm()});
  }
  return beams;
}

/// Walls of a room with a pillar, seen from `map_from_base`, every 3 degrees, with noise.
std::vector<Eigen::Vector2d> room_as_seen(const Se2& map_from_base, Random& random) {
  constexpr double kHalfLength_m = 2.1;
  constexpr double kHalfWidth_m = 1.3;
  std::vector<Eigen::Vector2d> ends_in_base;
  for (int degree = 0; degree < 360; degree += 3) {
    const double angle_rad = radians(degree);
    const Eigen::Vector2d ray =
        map_from_base.rotation() * Eigen::Vector2d{std::cos(angle_rad), std::sin(angle_rad)};
    const double to_x_m = (std::copysign(kHalfLength_m, ray.x()) - map_from_base.x()) / ray.x();
    const double to_y_m = (std::copysign(kHalfWidth_m, ray.y()) - map_from_base.y()) / ray.y();
    const double range_m = std::min(to_x_m, to_y_m) + random.normal(0.0, 0.01);
    ends_in_base.push_back({range_m * std::cos(angle_rad), range_m * std::sin(angle_rad)});
  }
  return ends_in_base;
}

/// The same hits in the map and in its oracle.
struct MappedRoom {
  HitMap map{};
  PlainHitMap plain{kFrame};

  explicit MappedRoom(std::uint64_t seed) {
    Random random{seed};
    for (int scan = 0; scan < 4; ++scan) {
      const Se2 pose{random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5), random.uniform(-3, 3)};
      for (const Eigen::Vector2d& end : room_as_seen(pose, random)) {
        add_hit(kFrame, pose * end, map);
        plain.add(pose * end);
      }
    }
  }
};

double score_here(const MatcherConfig& config, const HitMap& map, const std::vector<Beam>& beams) {
  const MatcherSetting setting{config, kFrame};
  return ScanMatcher{setting, map, beams}.score(Se2{});
}

TEST(ScanMatcher, ABeamScoresByItsDistanceToTheNearestMeanOfHits) {
  const MatcherConfig config;
  HitMap map;
  add_hit(kFrame, {1.00, 0.0}, map);
  add_hit(kFrame, {1.02, 0.0}, map);
  const std::vector<Beam> beams = beams_to({{1.0, 0.0}});
  const MatcherSetting setting{config, kFrame};
  ScanMatcher matcher{setting, map, beams};

  EXPECT_NEAR(matcher.score(Se2{}), std::exp(-0.01 * 0.01 / 0.05), kRounding);
  EXPECT_NEAR(matcher.log_likelihood(Se2{}), -0.01 * 0.01 / 0.075, kRounding);
  // One cell off the kernel still reaches it, two cells off it does not.
  EXPECT_NEAR(matcher.score({0.06, 0.0, 0.0}), std::exp(-0.05 * 0.05 / 0.05), kRounding);
  EXPECT_EQ(matcher.score({0.1, 0.0, 0.0}), 0.0);
  EXPECT_NEAR(matcher.log_likelihood({0.1, 0.0, 0.0}), -0.5 / 0.075, kRounding);
}

TEST(ScanMatcher, AgreesWithThePlainMatcherAtRandomPoses) {
  for (const auto free_cells : {FreeCells::kAsReleased, FreeCells::kIntended}) {
    for (const int kernel_size : {0, 1, 2}) {
      MatcherConfig config;
      config.free_cells = free_cells;
      config.kernel_size = kernel_size;
      const MappedRoom room{1};
      Random random{2, static_cast<std::uint64_t>(kernel_size)};
      const std::vector<Beam> beams = beams_to(room_as_seen({0.2, 0.1, 0.3}, random));
      const MatcherSetting setting{config, kFrame};
      ScanMatcher matcher{setting, room.map, beams};
      for (int i = 0; i < 40; ++i) {
        const double spread = i % 2 == 0 ? 0.03 : 0.5;
        const Se2 pose{random.normal(0.2, spread), random.normal(0.1, spread),
                       random.normal(0.3, spread)};
        EXPECT_NEAR(matcher.score(pose), room.plain.score(config, beams, pose),
                    kRounding * static_cast<double>(beams.size()));
        EXPECT_NEAR(matcher.log_likelihood(pose), room.plain.log_likelihood(config, beams, pose),
                    kRounding * static_cast<double>(beams.size()));
      }
    }
  }
}

TEST(ScanMatcher, EarlyTerminationGivesTheSameDecisionAsTheFullScore) {
  const MappedRoom room{3};
  Random random{4};
  const std::vector<Beam> beams = beams_to(room_as_seen({0.2, 0.1, 0.3}, random));
  const MatcherSetting setting{MatcherConfig{}, kFrame};
  ScanMatcher matcher{setting, room.map, beams};
  for (int i = 0; i < 200; ++i) {
    const Se2 pose{random.normal(0.2, 0.05), random.normal(0.1, 0.05), random.normal(0.3, 0.05)};
    const double whole = matcher.score(pose);
    const double to_beat = whole + random.normal(0.0, 5.0);
    const double early = matcher.score(pose, to_beat);
    if (whole > to_beat) {
      EXPECT_EQ(early, whole);
    } else {
      EXPECT_LE(early, to_beat);
    }
  }
}

TEST(ScanMatcher, AWallBeforeTheHitRejectsItOnlyIfFreeCellsIsIntended) {
  // Two walls, one sqrt(2) cells behind the other: the far one's free cell is the near one.
  HitMap map;
  add_hit(kFrame, {1.0, 0.0}, map);
  add_hit(kFrame, {1.0 + 0.05 * std::sqrt(2.0), 0.0}, map);
  const std::vector<Beam> beams = beams_to({{1.0 + 0.05 * std::sqrt(2.0), 0.0}});
  MatcherConfig config;
  config.kernel_size = 0;
  EXPECT_NEAR(score_here(config, map, beams), 1.0, kRounding);
  config.free_cells = FreeCells::kIntended;
  EXPECT_EQ(score_here(config, map, beams), 0.0);
}

TEST(ScanMatcher, SkipsBeamsByTheirIndexInTheScan) {
  HitMap map;
  add_hit(kFrame, {1.0, 0.0}, map);
  std::vector<Beam> beams = beams_to({{1.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}, {1.0, 0.0}});
  beams.erase(beams.begin() + 2);  // no return: the others keep their places
  MatcherConfig config;
  config.skip_beams = 1;
  EXPECT_NEAR(score_here(config, map, beams), 2.0, kRounding);
}

TEST(ScanMatcher, HillClimbFindsTheOptimumOfExhaustiveSearch) {
  const MatcherConfig config;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const MappedRoom room{seed};
    Random random{seed, 7};
    const Se2 truth{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-3, 3)};
    const std::vector<Beam> beams = beams_to(room_as_seen(truth, random));
    const MatcherSetting setting{config, kFrame};
    ScanMatcher matcher{setting, room.map, beams};
    const Se2 start{truth.x() + random.uniform(-0.06, 0.06),
                    truth.y() + random.uniform(-0.06, 0.06),
                    truth.theta() + random.uniform(-0.04, 0.04)};
    const ScanMatcher::Match match = matcher.climb(start);
    EXPECT_EQ(match.score, matcher.score(match.map_from_base));

    double best = 0.0;
    for (double x = -0.1; x <= 0.1; x += 0.01) {
      for (double y = -0.1; y <= 0.1; y += 0.01) {
        for (double turn = -0.06; turn <= 0.06; turn += 0.01) {
          const Se2 pose{truth.x() + x, truth.y() + y, truth.theta() + turn};
          best = std::max(best, matcher.score(pose));
        }
      }
    }
    // A hill climb may end a little beside the highest of several close peaks.
    EXPECT_GT(match.score, best - 0.01 * static_cast<double>(beams.size()));
    EXPECT_NEAR(match.map_from_base.x(), truth.x(), 0.02);
    EXPECT_NEAR(match.map_from_base.y(), truth.y(), 0.02);
    EXPECT_NEAR(angle_difference(match.map_from_base.theta(), truth.theta()), 0.0, 0.015);
  }
}

}  // namespace
}  // namespace waymark
