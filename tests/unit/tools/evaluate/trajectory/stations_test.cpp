// SPDX-License-Identifier: BSD-3-Clause
// Errors along the trajectory, consistency over runs, and the behaviour after a kidnap.
#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "common/random/random.hpp"
#include "evaluate/trajectory/consistency.hpp"
#include "evaluate/trajectory/timeline.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::evaluate {
namespace {

using ::testing::ElementsAre;

/// A drive along x at 0.5 m/s with a pose every 0.2 s; the estimate is off by a pose of the base.
std::vector<PosePair> drive(int steps, const Se2& truth_from_estimate) {
  std::vector<PosePair> pairs;
  for (int i = 0; i <= steps; ++i) {
    const Se2 truth{0.1 * i, 0.0, 0.0};
    pairs.push_back({0.2 * i, truth * truth_from_estimate, truth});
  }
  return pairs;
}

std::vector<StampedCovariance> covariances(const std::vector<PosePair>& pairs, double variance) {
  std::vector<StampedCovariance> result;
  for (const PosePair& pair : pairs)
    result.push_back({pair.t_s, variance * Eigen::Matrix3d::Identity(), Health::kTracking});
  return result;
}

TEST(Stations, AreAMetreApartWithErrorsInTheTrueBaseFrame) {
  const auto pairs = drive(35, {0.02, -0.01, 0.1});
  const auto found = stations(pairs, covariances(pairs, 0.01), {});
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[2].travel_m, 3.0);
  EXPECT_NEAR(found[2].t_s, 6.0, 0.21);  // rounding may take the next pose
  EXPECT_NEAR(found[2].along_m, 0.02, 1e-12);
  EXPECT_NEAR(found[2].across_m, -0.01, 1e-12);
  EXPECT_NEAR(found[2].heading_rad, 0.1, 1e-12);
  EXPECT_NEAR(found[2].nees.value(), (0.0004 + 0.0001 + 0.01) / 0.01, 1e-9);
  EXPECT_NEAR(found[2].sigma_along_m.value(), 0.1, 1e-12);
  EXPECT_NEAR(found[2].sigma_across_m.value(), 0.1, 1e-12);
  EXPECT_NEAR(found[2].sigma_heading_rad.value(), 0.1, 1e-12);
  EXPECT_EQ(found[2].health, Health::kTracking);
}

TEST(Stations, TheJumpOfAKidnapIsNotCountedAsDistanceDriven) {
  auto pairs = drive(15, {});
  for (std::size_t i = 8; i < pairs.size(); ++i)
    pairs[i].world_from_truth = Se2{5.0, 0.0, 0.0} * pairs[i].world_from_truth;
  EXPECT_EQ(stations(pairs, {}, {}).size(), 1u);
}

TEST(Stations, DistancesAtWhichThereIsNoPoseGetNoStation) {
  auto pairs = drive(55, {});
  pairs.erase(pairs.begin() + 15, pairs.begin() + 45);  // no pose from 1.5 to 4.5 m
  std::vector<double> travel_m;
  for (const Station& station : stations(pairs, {}, {}))
    travel_m.push_back(station.travel_m);
  EXPECT_THAT(travel_m, ElementsAre(1.0, 4.0, 5.0));
  EXPECT_NEAR(driven_m(pairs), 5.5, 1e-9);
}

TEST(Stations, GrowthIsFromOneStationToAnother) {
  const std::vector<Station> at{{.travel_m = 1.0, .sigma_along_m = 0.1},
                                {.travel_m = 2.0, .sigma_along_m = 0.3},
                                {.travel_m = 3.0}};
  EXPECT_NEAR(sigma_growth(at, 1.0, 2.0).value(), 3.0, 1e-12);
  EXPECT_FALSE(sigma_growth(at, 1.0, 3.0));
  EXPECT_FALSE(sigma_growth(at, 0.0, 2.0));
}

TEST(Stations, TheFileReadsBack) {
  const TemporaryFolder folder;
  const auto pairs = drive(12, {0.02, 0.0, 0.0});
  SkippedLines skipped;
  const auto with = read_stations(
      folder.file("a.csv", stations_csv(stations(pairs, covariances(pairs, 0.01), {}))), skipped);
  const auto without =
      read_stations(folder.file("b.csv", stations_csv(stations(pairs, {}, {}))), skipped);
  ASSERT_EQ(with.size(), 1u);
  EXPECT_NEAR(with[0].nees.value(), 0.04, 1e-4);
  EXPECT_NEAR(with[0].along_m, 0.02, 1e-6);
  EXPECT_FALSE(without.at(0).nees || without.at(0).sigma_along_m);
  EXPECT_TRUE(skipped.empty());
}

TEST(Stations, SigmasAreAlongAndAcrossTheRobotsHeading) {
  std::vector<PosePair> pairs = drive(12, {});
  const Se2 turned{0.0, 0.0, std::numbers::pi / 2.0};
  for (PosePair& pair : pairs) {
    pair.map_from_estimate = turned * pair.map_from_estimate;
    pair.world_from_truth = turned * pair.world_from_truth;
  }
  auto along_y = covariances(pairs, 0.0);
  for (StampedCovariance& stamped : along_y)
    stamped.covariance = Eigen::Vector3d{0.04, 0.09, 0.0001}.asDiagonal();
  const Station station = stations(pairs, along_y, {}).at(0);
  EXPECT_NEAR(station.sigma_along_m.value(), 0.3, 1e-9);
  EXPECT_NEAR(station.sigma_across_m.value(), 0.2, 1e-9);
  EXPECT_NEAR(station.sigma_heading_rad.value(), 0.01, 1e-9);
}

TEST(Consistency, SquaredErrorsAreComparedAxisByAxis) {
  const auto run = [](double heading_rad) {
    const auto pairs = drive(35, {0.02, -0.01, heading_rad});
    return stations(pairs, covariances(pairs, 1e-4), {});
  };
  const NeesPerAxis nees = nees_per_axis({run(0.0), run(0.02)});
  EXPECT_NEAR(nees.along, 4.0, 0.01);
  EXPECT_NEAR(nees.across, 1.0, 0.01);
  EXPECT_NEAR(nees.heading, 2.0, 0.01);
}

TEST(Consistency, QuantilesAreThoseOfTheTables) {
  constexpr double k975 = 1.95996;
  EXPECT_NEAR(chi_square_quantile(15, -k975), 6.262, 0.03);
  EXPECT_NEAR(chi_square_quantile(15, k975), 27.488, 0.03);
  EXPECT_NEAR(chi_square_quantile(60, -k975), 40.482, 0.01);
  EXPECT_NEAR(chi_square_quantile(60, k975), 83.298, 0.01);
}

/// Share of stations in the band for 20 runs with normal errors of sigma 0.1 m and reported
/// sigma_m.
double share_for(double sigma_m) {
  std::vector<std::vector<Station>> runs;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::vector<Station> run;
    for (int i = 1; i <= 200; ++i) {
      Random random{seed, static_cast<std::uint64_t>(i)};
      double nees = 0.0;
      for (int axis = 0; axis < 3; ++axis)
        nees += std::pow(random.normal(0.0, 0.1) / sigma_m, 2);
      run.push_back({.travel_m = 1.0 * i, .nees = nees});
    }
    runs.push_back(run);
  }
  const auto stations = consistency(runs);
  EXPECT_EQ(stations.size(), 200u);
  EXPECT_EQ(stations.front().runs, 20u);
  return share_in_band(stations);
}

TEST(Consistency, ConsistentCovariancesAreInTheBandAndOthersAreNot) {
  EXPECT_NEAR(share_for(0.1), 0.95, 0.04);
  EXPECT_LT(share_for(0.07), 0.1);  // overconfident
  EXPECT_LT(share_for(0.15), 0.1);  // underconfident
}

TEST(Consistency, StationsWithoutACovarianceDoNotCount) {
  EXPECT_TRUE(consistency({{{.travel_m = 1.0}}, {}}).empty());
  EXPECT_TRUE(std::isnan(share_in_band({})));
}

TEST(Consistency, StationsWithoutAUsableCovarianceAreCounted) {
  const Station without{.travel_m = 1.0};
  Station with_nees_only = without;
  with_nees_only.nees = 3.0;
  Station with = with_nees_only;
  with.sigma_along_m = with.sigma_across_m = with.sigma_heading_rad = 0.1;
  EXPECT_EQ(count_without_covariance({{without, with}, {with_nees_only}}), 2u);
  EXPECT_TRUE(std::isnan(nees_per_axis({{with_nees_only}}).along));
}

// --------------------------------------------------------------------------- health_summary

/// The robot is displaced by 3 m at t = 4 s. The estimate ignores this at first, has the health
/// `lost` from t = 5 s on, and is right again from t = 6 s on.
struct Kidnapped {
  std::vector<PosePair> pairs = drive(50, {});
  std::vector<StampedCovariance> stamped{};

  Kidnapped() {
    for (PosePair& pair : pairs) {
      if (pair.t_s > 3.9) pair.world_from_truth = Se2{3.0, 0, 0} * pair.world_from_truth;
      if (pair.t_s > 5.9) pair.map_from_estimate = pair.world_from_truth;
      const bool is_lost = pair.t_s > 4.9 && pair.t_s < 5.9;
      stamped.push_back({pair.t_s, 0.01 * Eigen::Matrix3d::Identity(),
                         is_lost ? Health::kLost : Health::kTracking});
    }
  }
};

TEST(HealthSummary, TimesUntilLostAndFoundCountFromTheFirstSightingAfterTheKidnap) {
  const Kidnapped run;
  const HealthSummary result = health_summary(run.pairs, run.stamped, {}, 4.0, {1.0, 4.6, 4.7});
  ASSERT_TRUE(result.kidnap);
  EXPECT_NEAR(result.kidnap->sighting_t_s, 4.6, 1e-9);
  EXPECT_NEAR(result.kidnap->says_lost_s.value(), 0.4, 1e-6);
  EXPECT_NEAR(result.kidnap->found_again_s.value(), 1.4, 1e-6);
  EXPECT_NEAR(result.kidnap->confident_wrong_s, 0.2, 1e-6);  // between 4.6 and 5.0 s
  EXPECT_NEAR(result.max_jump_m, 0.0, 1e-9);                 // relocalising is no jump
}

TEST(HealthSummary, AConfidentWrongPoseThatNeverEndsIsCounted) {
  Kidnapped run;
  for (std::size_t i = 0; i < run.pairs.size(); ++i) {
    run.pairs[i].map_from_estimate = Se2{0.1 * static_cast<double>(i), 0.0, 0.0};
    run.stamped[i].health = Health::kTracking;
  }
  const HealthSummary result = health_summary(run.pairs, run.stamped, {}, 4.0, {});
  EXPECT_FALSE(result.kidnap->says_lost_s || result.kidnap->found_again_s);
  EXPECT_NEAR(result.kidnap->confident_wrong_s, 6.0, 0.25);
  EXPECT_EQ(result.share_tracking, 1.0);
}

TEST(HealthSummary, AWideCovarianceIsNotConfident) {
  Kidnapped run;
  for (StampedCovariance& stamped : run.stamped)
    stamped.covariance *= 1000.0;
  EXPECT_EQ(health_summary(run.pairs, run.stamped, {}, 4.0, {}).kidnap->confident_wrong_s, 0.0);
}

TEST(HealthSummary, AJumpIsAStepOfTheEstimateThatDiffersFromTheTrueMotion) {
  auto pairs = drive(20, {});
  for (std::size_t i = 10; i < pairs.size(); ++i)
    pairs[i].map_from_estimate = Se2{0.0, 0.25, 0.0} * pairs[i].map_from_estimate;
  EXPECT_NEAR(health_summary(pairs, {}, {}, std::nullopt, {}).max_jump_m, 0.25, 1e-9);
}

/// 30 poses of a robot that drives at 0.5 m/s.
Trajectory true_drive(double step_s) {
  Trajectory truth;
  for (int i = 0; i < 30; ++i)
    truth.push_back({step_s * i, Se2{0.5 * step_s * i, 0.0, 0.0}});
  return truth;
}

TEST(HealthSummary, KidnapsAreJumpsOfTheTruth) {
  Trajectory truth = true_drive(0.1);
  EXPECT_FALSE(lifted_t_s(truth));
  truth[20].parent_from_base = Se2{8.0, 0.0, 0.0};
  EXPECT_NEAR(lifted_t_s(truth).value(), 2.0, 1e-9);
}

TEST(HealthSummary, LongStepsOfARarelySampledTruthAreNotTakenForAKidnap) {
  Trajectory truth = true_drive(1.0);
  EXPECT_FALSE(lifted_t_s(truth));
  truth[20].parent_from_base = Se2{12.0, 0.0, 0.0};
  EXPECT_NEAR(lifted_t_s(truth).value(), 20.0, 1e-9);
}

TEST(HealthSummary, APoseThatIsRightForLessThanASecondIsNotFoundAgain) {
  Kidnapped run;
  std::erase_if(run.pairs, [](const PosePair& pair) { return pair.t_s > 6.9; });
  EXPECT_FALSE(health_summary(run.pairs, run.stamped, {}, 4.0, {}).kidnap->found_again_s);
  run = {};
  std::erase_if(run.pairs, [](const PosePair& pair) { return pair.t_s > 7.1; });
  EXPECT_TRUE(health_summary(run.pairs, run.stamped, {}, 4.0, {}).kidnap->found_again_s);
}

TEST(HealthSummary, SightingsAreFramesThatShowAMarker) {
  const TemporaryFolder folder;
  const auto log = folder.path() / "run.lcm";
  LogWriter writer{log};
  for (const int count : {0, 1, 0, 2}) {
    marker_detections_t message{};
    message.utime += 1'000'000 * count;
    message.num_detections = count;
    message.image_width = 640;
    message.image_height = 480;
    marker_detection_t detection{};
    detection.orientation[0] = detection.other_orientation[0] = 1.0;
    message.detections.assign(static_cast<std::size_t>(count), detection);
    writer.write(encode(channels::kMarkers, message));
  }
  writer.close();
  EXPECT_THAT(sighting_times(log), ElementsAre(1.0, 2.0));
  EXPECT_THROW(sighting_times(folder.path() / "none"), SetupError);
}

}  // namespace
}  // namespace waymark::evaluate
