// SPDX-License-Identifier: BSD-3-Clause
#include "common/geometry/squared.hpp"
#include "common/random/random.hpp"
#include "slam/core/mapping/insert_scan.hpp"
#include "slam/core/resampling/particle_set.hpp"
#include "slam/core/resampling/systematic.hpp"
#include "slam/core/scan/observability.hpp"
#include "slam/core/weighting/marker_score.hpp"
#include "slam/core/weighting/wall_score.hpp"
#include "support/synthetic_corridor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <vector>

namespace waymark {
namespace {

using test::SyntheticCorridor;

const SyntheticCorridor kCorridor{};
const MatchingRewards kRewards{};

/// A marker of 0.4 m centred on x_m of the wall y = 1, seen often.
GridMap map_with_marker(int id, double x_m) {
  GridMap map;
  for (double x = x_m - 0.295; x < x_m + 0.3; x += 0.01) {
    const int label = std::abs(x - x_m) < 0.2 ? id : kNoMarker;
    map.markers.edit(map.frame.cell_of({x, 1.0})).vote(label, 5.0F);
  }
  return map;
}

MarkerSighting sighting_at(int id, double x_m) {
  MarkerSighting sighting;
  sighting.id = id;
  sighting.size_m = 0.4;
  sighting.base_from_marker = {x_m, 1.0, -0.5 * std::numbers::pi};
  return sighting;
}

double face_score(const GridMap& map, int id, double x_m) {
  double sum = 0.0;
  for (const FacePoint& point : face_points(sighting_at(id, x_m), 0.02, 0.1))
    sum += marker_score(map, point.in_base, point.marker_id, kRewards);
  return sum;
}

TEST(MarkerScore, EqualIdsAreRewardedOtherIdsPunishedAndUnmappedPlacesScoreZero) {
  const GridMap map = map_with_marker(0, 3.0);
  EXPECT_NEAR(marker_score(map, {3.0, 1.0}, 0, kRewards), kRewards.strong_reward, 0.1);
  EXPECT_NEAR(marker_score(map, {3.0, 1.0}, 4, kRewards), -kRewards.penalty, 0.1);
  EXPECT_NEAR(marker_score(map, {3.0, 1.0}, kNoMarker, kRewards), -kRewards.penalty, 0.1);
  EXPECT_NEAR(marker_score(map, {3.26, 1.0}, 0, kRewards), -kRewards.penalty, 0.1);
  EXPECT_NEAR(marker_score(map, {3.27, 1.0}, kNoMarker, kRewards), 0.0, 1e-9);
  EXPECT_EQ(marker_score(map, {9.0, 1.0}, 0, kRewards), 0.0);
  EXPECT_EQ(marker_score(map, {9.0, 1.0}, kNoMarker, kRewards), 0.0);
}

TEST(MarkerScore, ResolvesDisplacementsSmallerThanACell) {
  // Wherever the marker's edges fall in their cells, the best match is within a quarter of a cell.
  for (double phase_m = 0.0; phase_m < 0.05; phase_m += 0.01) {
    const GridMap map = map_with_marker(7, 3.0 + phase_m);
    double best_m = 0.0;
    double best_score = -1e9;
    for (double shift_m = -0.06; shift_m <= 0.06; shift_m += 0.001) {
      const double score = face_score(map, 7, 3.0 + phase_m + shift_m);
      if (score > best_score) {
        best_score = score;
        best_m = shift_m;
      }
    }
    EXPECT_NEAR(best_m, 0.0, 0.0125) << phase_m;
    EXPECT_GT(best_score - face_score(map, 7, 3.0 + phase_m + 0.03), 1.0) << phase_m;
  }
}

TEST(MarkerScore, IsTheWeightedSumOverSpots) {
  const GridMap map = map_with_marker(2, 3.0);
  const std::vector<ObservedSpot> spots{{{0.0, 0.0}, 2, 0.5}, {{0.05, 0.0}, 2, 1.0}};
  const Se2 map_from_base{3.0, 1.0, 0.0};
  const double one = marker_score(map, {3.0, 1.0}, 2, kRewards);
  const double other = marker_score(map, {3.05, 1.0}, 2, kRewards);
  EXPECT_NEAR(marker_score(map, spots, map_from_base, kRewards), 0.5 * one + other, 1e-12);
}

TEST(MarkerScore, TheWeightOfASightingFollowsItsCovariance) {
  constexpr double kUsualSigma_m = 0.02;
  Observation observation;
  observation.sightings = {sighting_at(2, 3.0)};
  for (const double sigmas : {0.1, 1.0, 3.0}) {
    observation.sightings[0].covariance_in_base =
        squared(sigmas * kUsualSigma_m) * Eigen::Matrix3d::Identity();
    const auto spots = observed_spots(observation, 0.05, 0.1, kUsualSigma_m);
    ASSERT_FALSE(spots.empty());
    for (const ObservedSpot& spot : spots)
      EXPECT_NEAR(spot.weight, 1.0 / (1.0 + squared(sigmas)), 1e-9);
  }
}

/// Map of a noisy drive with true poses from x = 5 m to x_m, and the next scan.
struct Mapped {
  GridMap map{};
  std::vector<AnnotatedBeam> next{};
};

Mapped mapped_until(double x_m) {
  Mapped mapped;
  const LidarSetup lidar{Se2{kCorridor.lidar_x_m, 0.0, 0.0}, 0.12, 3.5};
  Random random{3};
  const auto noisy_beams = [&](const Se2& pose) {
    LidarScan scan = test::scan_from(kCorridor, pose, {});
    for (double& range_m : scan.ranges_m)
      range_m += random.normal(0.0, 0.01);
    return annotate(beams_of(scan, lidar, OdometryBuffer{}), {}, nullptr, 0.08);
  };
  for (double x = 5.0; x < x_m; x += 0.06)
    insert_beams(noisy_beams(Se2{x, 0.0, 0.0}), Se2{x, 0.0, 0.0}, mapped.map);
  mapped.next = noisy_beams(Se2{x_m, 0.0, 0.0});
  return mapped;
}

TEST(WallScore, ConstrainsHeadingAndLateralPosition) {
  const Mapped mapped = mapped_until(12.0);
  const auto agreement = [&](const Se2& pose) {
    const WallScore score = wall_score(mapped.map, mapped.next, pose);
    return score.agreement / score.mapped;
  };
  const double right = agreement(Se2{12.0, 0.0, 0.0});
  EXPECT_GT(right, 0.7);
  EXPECT_LT(agreement(Se2{12.0, 0.03, 0.0}), right - 0.05);
  EXPECT_LT(agreement(Se2{12.0, -0.03, 0.0}), right - 0.05);
  EXPECT_LT(agreement(Se2{12.0, 0.0, 0.02}), right - 0.02);
  EXPECT_LT(agreement(Se2{12.0, 0.0, -0.02}), right - 0.02);
}

TEST(WallScore, UnmappedEndsAddNothing) {
  const WallScore score = wall_score(GridMap{}, mapped_until(5.5).next, Se2{5.5, 0.0, 0.0});
  EXPECT_EQ(score.beyond(0.8), 0.0);
}

// In GMapping the newest beams end on walls that are not mapped yet, so a pose further back scores
// higher. Our score stays the same, but for the small error of the weak direction.
TEST(WallScore, MovingAScanBackAlongABareCorridorGainsNothing) {
  const Mapped mapped = mapped_until(12.0);
  const Se2 right{12.0, 0.0, 0.0};
  const Observability walls = observability_of(mapped.next, right, 0.01);
  const WallScore here = wall_score(mapped.map, mapped.next, right);
  const double expected = here.agreement / here.mapped;
  for (const double shift_m : {-0.5, -0.1, -0.02, 0.02, 0.1, 0.5}) {
    const Se2 shifted{12.0 + shift_m, 0.0, 0.0};
    const WallScore there =
        wall_score(mapped.map, mapped.next, walls.without_weak_part(shifted, right));
    // The weak direction is known to a milliradian or so.
    EXPECT_NEAR(there.beyond(expected), here.beyond(expected), 2.0 * std::abs(shift_m)) << shift_m;
  }
}

// A world mirrored about the axis of the corridor scores the same.
TEST(Scores, AreTheSameInAMirror) {
  Mapped mapped = mapped_until(8.0);
  GridMap mirrored_map;
  mapped.map.occupancy.for_each_tile([&](TileIndex tile, const auto& cells) {
    for (std::size_t i = 0; i < kTileCells; ++i) {
      const CellIndex cell = cell_at(tile, i);
      mirrored_map.occupancy.edit({cell.x, -cell.y}) = cells[i];
    }
  });
  std::vector<AnnotatedBeam> mirrored_beams = mapped.next;
  for (AnnotatedBeam& beam : mirrored_beams)
    beam.beam.end_in_base.y() *= -1.0;

  const WallScore score = wall_score(mapped.map, mapped.next, Se2{8.01, 0.012, 0.003});
  const WallScore mirrored = wall_score(mirrored_map, mirrored_beams, Se2{8.01, -0.012, -0.003});
  EXPECT_NEAR(score.agreement, mirrored.agreement, 1e-9);
  EXPECT_NEAR(score.mapped, mirrored.mapped, 1e-9);
}

TEST(InsertBeams, GrazingBeamsDoNotEraseTheWall) {
  const Mapped mapped = mapped_until(15.0);
  for (double x_m = 7.0; x_m < 14.0; x_m += 0.05) {
    const OccupancyCell& wall = mapped.map.occupancy[mapped.map.frame.cell_of({x_m, 1.0})];
    const OccupancyCell& free = mapped.map.occupancy[mapped.map.frame.cell_of({x_m, 0.9})];
    EXPECT_GT(wall.occupancy(), 0.8);
    EXPECT_LT(free.occupancy(), 0.05);
  }
}

TEST(Resampling, EveryParticleGetsItsShareOnAverage) {
  const std::vector<double> weights{0.05, 0.4, 0.0, 0.25, 0.3};
  std::vector<double> counts(weights.size(), 0.0);
  constexpr int kOffsets = 10000;
  for (int i = 0; i < kOffsets; ++i) {
    for (const std::size_t survivor : resample_systematically(weights, (i + 0.5) / kOffsets))
      counts[survivor] += 1.0 / kOffsets;
  }
  for (std::size_t i = 0; i < weights.size(); ++i)
    EXPECT_NEAR(counts[i], 5.0 * weights[i], 1e-3);
}

TEST(Resampling, CountsAreTheRoundedShares) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random{seed};
    std::vector<double> weights(1 + random() % 40);
    for (double& weight : weights)
      weight = random.uniform();
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    for (double& weight : weights)
      weight /= sum;
    std::vector<int> counts(weights.size(), 0);
    const auto survivors = resample_systematically(weights, random.uniform());
    ASSERT_EQ(survivors.size(), weights.size());
    for (const std::size_t survivor : survivors)
      ++counts[survivor];
    for (std::size_t i = 0; i < weights.size(); ++i) {
      const double share = weights[i] * static_cast<double>(weights.size());
      EXPECT_GE(counts[i], std::floor(share - 1e-9));
      EXPECT_LE(counts[i], std::ceil(share + 1e-9));
    }
  }
}

TEST(Resampling, TheEffectiveNumberIsOneIfOneParticleHasAllWeightAndNForEqualWeights) {
  EXPECT_NEAR(effective_number(std::vector{0.25, 0.25, 0.25, 0.25}), 4.0, 1e-12);
  EXPECT_NEAR(effective_number(std::vector{1.0, 0.0, 0.0, 0.0}), 1.0, 1e-12);
}

std::vector<double> weights_after(const std::vector<double>& log_weights) {
  ParticleSet<int> particles{log_weights.size(), 0};
  for (std::size_t i = 0; i < log_weights.size(); ++i)
    particles.add_log_weight(i, log_weights[i]);
  particles.normalise();
  return particles.weights();
}

TEST(ParticleSet, WeightsThatUnderflowKeepTheirShares) {
  const std::vector<double> weights = weights_after({-1e5, -1e5 + std::log(3.0)});
  EXPECT_NEAR(weights[0], 0.25, 1e-9);
  EXPECT_NEAR(weights[1], 0.75, 1e-9);
}

TEST(ParticleSet, IfAllLikelihoodsAreZeroWeightsAreUniform) {
  constexpr double kImpossible = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(weights_after({kImpossible, kImpossible}), (std::vector{0.5, 0.5}));
  EXPECT_EQ(weights_after({kImpossible, -3.0}), (std::vector{0.0, 1.0}));
}

}  // namespace
}  // namespace waymark
