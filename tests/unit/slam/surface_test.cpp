// SPDX-License-Identifier: BSD-3-Clause
// Walls as lines, and scans matched against them.
#include "slam/core/matching/surface_matching.hpp"
#include "slam/core/proposal/pose_proposal.hpp"
#include "support/small_world.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

namespace waymark {
namespace {

using test::corridor_beams;
using test::diagonal;

TEST(SurfaceMatching, FindsThePoseAcrossABareCorridorAndNothingAlongIt) {
  Random random{5};
  SurfaceMap map{GridFrame::centred_on_map_origin(0.05)};
  for (int scan = 0; scan < 20; ++scan) {
    for (const AnnotatedBeam& beam : corridor_beams(0.01, random))
      map.add(beam.beam.end_in_base);
  }
  const auto beams = corridor_beams(0.01, random);
  SurfaceFinder finder{map, beams.size()};
  const Se2 start{0.3, 0.03, 0.02};
  const PoseProposal matched = propose(
      start, diagonal(0.1, 0.1, 0.1), [&](const Se2& pose, const Eigen::Matrix3d& uncertainty) {
        return match_surfaces(beams, finder, pose, uncertainty, {}).pose;
      });
  EXPECT_NEAR(matched.mean.y(), 0.0, 0.003);
  EXPECT_NEAR(matched.mean.theta(), 0.0, 0.003);
  EXPECT_NEAR(matched.mean.x(), 0.3, 0.002);  // nothing pulls
  EXPECT_NEAR(matched.covariance(0, 0), 0.01, 0.001);
}

TEST(NoiseOfWalls, IsThatOfTheScansBestFit) {
  Random random{8};
  constexpr double kNoise_m = 0.01;
  constexpr int kScans = 300;
  SurfaceMatchingConfig config;
  config.surface_sigma_m = 1e-6;
  double squares = 0.0;
  Eigen::Matrix3d told = Eigen::Matrix3d::Zero();
  for (int scan = 0; scan < kScans; ++scan) {
    const auto beams = corridor_beams(kNoise_m, random);
    told += noise_of_walls(beams, config) / kScans;
    // Least squares of the heading, which symmetry makes independent of all else.
    double weights = 0.0;
    double sum = 0.0;
    for (const AnnotatedBeam& annotated : beams) {
      const Eigen::Vector2d& end = annotated.beam.end_in_base;
      const double across_m = end.y() > 0.0 ? end.y() - 1.0 : end.y() + 1.0;
      const double weight = end.squaredNorm();  // the noise across the wall falls with the range
      weights += weight * end.x() * end.x();
      sum += weight * end.x() * across_m;
    }
    squares += std::pow(sum / weights, 2) / kScans;
  }
  EXPECT_NEAR(std::sqrt(told(2, 2) / squares), 1.0, 0.15);
  EXPECT_NEAR(told(0, 0), 0.0, 1e-12) << "a bare corridor tells nothing along it";
}

TEST(SurfaceMap, FitsALineToThePointsInTheSquare) {
  Random random{4};
  const GridFrame frame = GridFrame::centred_on_map_origin(0.05);
  SurfaceMap map{frame};
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < 3000; ++i) {
    const double along_m = random.uniform(-1.0, 1.0);
    points.emplace_back(along_m, 0.4 * along_m + 0.005 * random.normal());
    map.add(points.back());
  }
  const Eigen::Vector2d place{0.31, 0.12};
  const CellIndex middle = frame.cell_of(place);
  std::vector<Eigen::Vector2d> inside;
  std::copy_if(points.begin(), points.end(), std::back_inserter(inside), [&](const auto& point) {
    const CellIndex cell = frame.cell_of(point);
    return std::abs(cell.x - middle.x) <= 1 && std::abs(cell.y - middle.y) <= 1;
  });
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& point : inside)
    mean += point / static_cast<double>(inside.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& point : inside)
    scatter += (point - mean) * (point - mean).transpose() / static_cast<double>(inside.size());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes{scatter};

  const auto surface = map.near(place, 0.05);
  ASSERT_TRUE(surface && surface->is_line);
  EXPECT_EQ(surface->count, inside.size());
  EXPECT_LT((surface->point_in_map - mean).norm(), 1e-6);
  EXPECT_NEAR(std::abs(surface->normal_in_map.dot(axes.eigenvectors().col(0))), 1.0, 1e-6);
  const double never_better_m2 = 1e-3 * 0.05 * 0.05;
  EXPECT_NEAR(surface->across_m2, axes.eigenvalues()[0] + never_better_m2, 1e-8);
  EXPECT_NEAR(surface->along_m2, axes.eigenvalues()[1] + never_better_m2, 1e-8);
}

TEST(SurfaceMap, ALineFurtherAwayIsFoundWithinTheReachOnly) {
  SurfaceMap map{GridFrame::centred_on_map_origin(0.05)};
  for (int i = -100; i <= 100; ++i)
    map.add({0.01 * i, 0.025});
  const Eigen::Vector2d fourth_cell_off{0.3, 0.225};
  EXPECT_FALSE(map.near(fourth_cell_off, 0.05));
  const auto line = map.near(fourth_cell_off, 0.3);
  ASSERT_TRUE(line && line->is_line);
  EXPECT_NEAR(line->point_in_map.y(), 0.025, 1e-6);
}

/// What is kept from call to call, and shared by neighbours, must never show.
TEST(SurfaceFinder, FindsWhatTheMapHas) {
  Random random{9};
  SurfaceMap map{GridFrame::centred_on_map_origin(0.05)};
  for (const AnnotatedBeam& beam : corridor_beams(0.01, random))
    map.add(beam.beam.end_in_base);
  for (int i = 0; i < 100; ++i)  // legs of chairs
    map.add({0.3 * (i % 5) + 0.01 * random.normal(), 0.6 + 0.01 * random.normal()});
  constexpr std::size_t kPoints = 4;
  SurfaceFinder finder{map, kPoints};
  Eigen::Vector2d first{0.5, 0.75};
  int lines = 0;
  int clumps = 0;
  for (int i = 0; i < 2000; ++i) {
    first += 0.01 * Eigen::Vector2d{random.normal(), 0.3 * random.normal()};
    const double reach_m = random.uniform() < 0.5 ? 0.05 : 0.3;
    for (std::size_t k = 0; k < kPoints; ++k) {
      const Eigen::Vector2d point =
          first + 0.03 * static_cast<double>(k) * Eigen::Vector2d{random.uniform(), 1.0};
      const auto expected = map.near(point, reach_m);
      const auto found = finder.near(k, point, reach_m);
      ASSERT_EQ(found.has_value(), expected.has_value());
      if (!found) continue;
      ASSERT_EQ(found->point_in_map, expected->point_in_map);
      ASSERT_EQ(found->is_line, expected->is_line);
      ++(found->is_line ? lines : clumps);
    }
  }
  EXPECT_GT(lines, 500);
  EXPECT_GT(clumps, 50);
}

TEST(SurfaceMatching, AClumpTellsThePlaceAndALineOnlyTheDistance) {
  const GridFrame frame = GridFrame::centred_on_map_origin(0.05);
  Random random{5};
  const auto match_of = [&](double length_m, double uncertainty_m = 0.1) {
    SurfaceMap map{frame};
    for (int i = 0; i < 400; ++i)
      map.add({2.0 + 0.01 * random.normal(), length_m * (random.uniform() - 0.5)});
    std::vector<AnnotatedBeam> beams(1);
    beams[0].beam.end_in_base = {2.0, 0.02};
    beams[0].beam.range_m = 2.0;
    SurfaceMatchingConfig config;
    config.weak_share = 0.0;
    SurfaceFinder finder{map, beams.size()};
    const double variance_m2 = uncertainty_m * uncertainty_m;
    return match_surfaces(beams, finder, {}, diagonal(variance_m2, variance_m2, 0.0), config)
        .pose.information;
  };
  const Eigen::Matrix3d line = match_of(2.0);
  const Eigen::Matrix3d clump = match_of(0.04);
  EXPECT_LT(line(1, 1), 0.01 * line(0, 0));
  EXPECT_GT(clump(1, 1), 0.1 * clump(0, 0));
  EXPECT_LT(match_of(0.04, 0.001)(1, 1), 0.2 * clump(1, 1)) << "the place is known better already";
}

}  // namespace
}  // namespace waymark
