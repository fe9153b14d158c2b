// SPDX-License-Identifier: BSD-3-Clause
// What every estimator promises, whatever its method.
#include "estimator_run.hpp"
#include "slam/core/estimators/gmapping.hpp"
#include "slam/core/estimators/marker_matching.hpp"
#include "slam/core/estimators/odometry.hpp"
#include "slam/core/estimators/waymark.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>

namespace waymark {
namespace {

using test::estimator_setup_of;
using test::run;
using test::SensorLog;
using test::setup_of;
using test::Step;
using test::SyntheticCorridor;

struct Method {
  std::string name{};
  std::function<std::unique_ptr<Estimator>(const EstimatorSetup&)> make{};
};

const Method kMethods[] = {
    {"odometry",
     [](const EstimatorSetup& setup) {
       return std::make_unique<OdometryEstimator>(setup);
     }},
    {"gmapping",
     [](const EstimatorSetup& setup) {
       return std::make_unique<GmappingEstimator>(setup, GmappingConfig{});
     }},
    {"marker_matching",
     [](const EstimatorSetup& setup) {
       return std::make_unique<MarkerMatchingEstimator>(setup, MarkerMatchingConfig{});
     }},
    {"waymark",
     [](const EstimatorSetup& setup) {
       return std::make_unique<WaymarkEstimator>(setup, WaymarkConfig{});
     }},
};

class Contract : public testing::TestWithParam<Method> {
 protected:
  static SyntheticCorridor corridor() {
    SyntheticCorridor corridor = test::short_corridor(5);
    corridor.drive_m = 6.0;
    corridor.speed_m_s = 0.4;
    return corridor;
  }

  std::unique_ptr<Estimator> estimator(const ParallelFor& parallel_for = serial_for) const {
    EstimatorSetup setup = estimator_setup_of(corridor(), 3);
    setup.parallel_for = parallel_for;
    return GetParam().make(setup);
  }

  std::vector<Step> steps_of(const SensorLog& log,
                             const ParallelFor& parallel_for = serial_for) const {
    const auto method = estimator(parallel_for);
    return run(*method, log, setup_of(corridor()));
  }
};

void expect_equal_bits(const std::vector<Step>& one, const std::vector<Step>& other) {
  ASSERT_EQ(one.size(), other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    EXPECT_EQ(one[i].estimate.map_from_base.x(), other[i].estimate.map_from_base.x()) << i;
    EXPECT_EQ(one[i].estimate.map_from_base.y(), other[i].estimate.map_from_base.y()) << i;
    EXPECT_EQ(one[i].estimate.map_from_base.theta(), other[i].estimate.map_from_base.theta()) << i;
    EXPECT_EQ(one[i].estimate.covariance, other[i].estimate.covariance) << i;
  }
}

TEST_P(Contract, TheMapsFrameIsTheFirstPose) {
  const std::vector<Step> steps = steps_of(drive(corridor()));
  const Se2& first = steps.front().estimate.map_from_base;
  EXPECT_LT(first.translation().norm(), 1e-6);
  EXPECT_LT(std::abs(first.theta()), 1e-6);
}

TEST_P(Contract, EqualLogsGiveEqualResultsToTheLastBit) {
  const SensorLog log = drive(corridor());
  expect_equal_bits(steps_of(log), steps_of(log));
}

/// Threads finish in any order: here from the last to the first.
TEST_P(Contract, TheOrderOfParallelTasksDoesNotMatter) {
  const SensorLog log = drive(corridor());
  const ParallelFor backwards = [](std::size_t count,
                                   const std::function<void(std::size_t)>& body) {
    while (count > 0)
      body(--count);
  };
  expect_equal_bits(steps_of(log), steps_of(log, backwards));
}

TEST_P(Contract, BlankIdsLeaveNoMarkersInTheMap) {
  SensorSetup blank = setup_of(corridor());
  blank.blank_ids = true;
  const auto method = estimator();
  const std::vector<Step> steps = run(*method, drive(corridor()), blank);
  EXPECT_TRUE(method->landmarks().empty());
  EXPECT_EQ(steps.back().estimate.markers_in_view, 0);
}

TEST_P(Contract, AnObservationWithoutBeamsNeitherMovesThePoseNorMaps) {
  const auto method = estimator();
  const Se2 before =
      run(*method, drive(corridor()), setup_of(corridor())).back().estimate.map_from_base;
  const std::size_t tiles = method->map().occupancy.num_tiles();
  for (int i = 0; i < 3; ++i) {
    const Estimate after = method->update(Observation{});
    EXPECT_LT((after.map_from_base.translation() - before.translation()).norm(), 0.02);
    EXPECT_TRUE(after.covariance.allFinite());
  }
  EXPECT_EQ(method->map().occupancy.num_tiles(), tiles);
}

/// Particles are not mirrored, so that filters have their scatter.
TEST_P(Contract, AMirroredWorldGivesAMirroredResult) {
  const SensorLog log = drive(corridor());
  const std::vector<Step> left = steps_of(log);
  const std::vector<Step> right = steps_of(mirrored(log));
  ASSERT_EQ(left.size(), right.size());
  for (std::size_t i = 0; i < left.size(); ++i) {
    const Se2& a = left[i].estimate.map_from_base;
    const Se2& b = right[i].estimate.map_from_base;
    EXPECT_NEAR(a.y(), -b.y(), 0.1) << i;
    EXPECT_NEAR(a.theta(), -b.theta(), radians(2.0)) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(AllEstimators, Contract, testing::ValuesIn(kMethods),
                         [](const auto& parameter) { return parameter.param.name; });

}  // namespace
}  // namespace waymark
