// SPDX-License-Identifier: BSD-3-Clause
// A scenario's expectations, checked with hand-written results.
#include "evaluate/run/expectation.hpp"

#include "evaluate/run/run_evaluation.hpp"

#include <gtest/gtest.h>

namespace waymark::evaluate {
namespace {

EstimatorResult result_of(const std::string& row) {
  EstimatorResult result{};
  result.name = row;
  result.true_length_m = 50.0;
  result.length = corridor::CorridorLength{};
  result.length->length_m = 50.2;  // 0.4 %
  result.trajectory = TrajectoryError{};
  result.trajectory->ate_origin_m = 0.1;
  result.markers = MarkerError{};
  result.trajectory->along_m = Spread{.rms = 0.08};
  result.trajectory->across_m = Spread{.rms = 0.01};
  result.trajectory->heading_deg = {.rms = 0.1};
  result.markers->right_share = 0.98;
  result.markers->mean_position_m = 0.025;
  result.markers->moved_named_share = 0.5;
  result.health_summary = HealthSummary{.max_jump_m = 0.05};
  result.health_summary->kidnap = Kidnap{.confident_wrong_s = 0.3};
  result.memory_mb_per_m = 0.4;
  result.sigma_growth = 2.0;
  result.wall_cells = 2;
  return result;
}

bool hits(const ExpectConfig& expect, const EstimatorResult& result) {
  const auto figures = check_expectations(expect, result);
  EXPECT_EQ(figures.size(), 1u);
  return figures.front().is_hit;
}

TEST(Expectation, NothingIsExpectedByDefault) {
  EXPECT_TRUE(check_expectations({}, result_of("waymark")).empty());
}

TEST(Expectation, EachMetricHasAnUpperOrALowerLimit) {
  const EstimatorResult result = result_of("waymark");
  EXPECT_TRUE(hits({.length_error_percent = 0.41}, result));
  EXPECT_FALSE(hits({.length_error_percent = 0.39}, result));
  EXPECT_TRUE(hits({.ate_origin_m = 0.1}, result));
  EXPECT_FALSE(hits({.ate_origin_m = 0.099}, result));
  EXPECT_TRUE(hits({.marker_map_share = 0.98}, result));
  EXPECT_FALSE(hits({.marker_map_share = 0.99}, result));
  EXPECT_TRUE(hits({.max_jump_m = 0.05}, result));
  EXPECT_FALSE(hits({.max_jump_m = 0.04}, result));
  EXPECT_TRUE(hits({.marker_error_mean_m = 0.03}, result));
  EXPECT_FALSE(hits({.marker_error_mean_m = 0.02}, result));
  EXPECT_TRUE(hits({.along_rmse_m = 0.09}, result));
  EXPECT_FALSE(hits({.along_rmse_m = 0.07}, result));
  EXPECT_TRUE(hits({.across_rmse_m = 0.02}, result));
  EXPECT_FALSE(hits({.across_rmse_m = 0.005}, result));
  EXPECT_TRUE(hits({.heading_rmse_deg = 0.2}, result));
  EXPECT_FALSE(hits({.heading_rmse_deg = 0.05}, result));
  EXPECT_TRUE(hits({.moved_named_share = 0.5}, result));
  EXPECT_FALSE(hits({.moved_named_share = 0.6}, result));
  EXPECT_TRUE(hits({.confident_wrong_s = 0.4}, result));
  EXPECT_FALSE(hits({.confident_wrong_s = 0.2}, result));
  EXPECT_TRUE(hits({.memory_mb_per_m = 0.5}, result));
  EXPECT_FALSE(hits({.memory_mb_per_m = 0.3}, result));
  EXPECT_TRUE(hits({.sigma_growth = 1.5}, result));
  EXPECT_FALSE(hits({.sigma_growth = 2.5}, result));
  EXPECT_TRUE(hits({.max_wall_cells = 2}, result));
  EXPECT_FALSE(hits({.max_wall_cells = 1}, result));
}

TEST(Expectation, RoundingDoesNotFailAnExpectation) {
  EstimatorResult result = result_of("waymark");
  result.length->length_m = 49.9;  // 100 - 99.8 > 0.2 in binary fractions
  EXPECT_TRUE(hits({.length_error_percent = 0.2}, result));
}

TEST(Expectation, ExpectationsOfAllSeedsAreNotAppliedToARun) {
  const ExpectConfig expect{.nees_in_band_share = 0.9, .seeds_share = 0.95};
  EXPECT_TRUE(check_expectations(expect, result_of("waymark")).empty());
  EXPECT_TRUE(is_expected_of(expect, "waymark"));
  EXPECT_FALSE(is_expected_of(expect, "odometry"));
}

TEST(Expectation, AppliesToItsEstimatorOnly) {
  const ExpectConfig expect{.estimator = "waymark", .ate_origin_m = 0.01};
  EXPECT_TRUE(check_expectations(expect, result_of("odometry")).empty());
  EXPECT_EQ(check_expectations(expect, result_of("waymark")).size(), 1u);
  const ExpectConfig of_all{.estimator = "", .ate_origin_m = 0.01};
  EXPECT_EQ(check_expectations(of_all, result_of("odometry")).size(), 1u);
}

TEST(Expectation, AMissingFigureFails) {
  EstimatorResult result{};
  result.name = "waymark";
  const auto figures = check_expectations({.ate_origin_m = 0.1, .found_again_s = 3.0}, result);
  ASSERT_EQ(figures.size(), 2u);
  EXPECT_FALSE(figures[0].is_hit || figures[1].is_hit);
  EXPECT_FALSE(figures[0].got || figures[1].got);
}

TEST(Expectation, ARelocalisedRobotNeedNotReportLost) {
  EstimatorResult result = result_of("waymark");
  result.health_summary->kidnap = Kidnap{.says_lost_s = std::nullopt, .found_again_s = 1.5};
  EXPECT_TRUE(hits({.says_lost_s = 2.0}, result));
  EXPECT_TRUE(hits({.found_again_s = 3.0}, result));
  result.health_summary->kidnap = Kidnap{.says_lost_s = 0.5, .found_again_s = 9.0};
  EXPECT_TRUE(hits({.says_lost_s = 2.0}, result));
  EXPECT_FALSE(hits({.found_again_s = 3.0}, result));
  result.health_summary->kidnap = Kidnap{};
  EXPECT_FALSE(hits({.says_lost_s = 2.0}, result));
}

}  // namespace
}  // namespace waymark::evaluate
