// SPDX-License-Identifier: BSD-3-Clause
// Laws of a particle's belief and of what it is told, over random cases: derivatives against
// differences, shared memory against copies, fusion against integration.
#include "common/random/random.hpp"
#include "slam/core/belief/belief.hpp"
#include "slam/core/proposal/pose_proposal.hpp"
#include "support/small_world.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <vector>

namespace waymark {
namespace {

using test::diagonal;
using test::measurement_of;

constexpr int kCases = 20;
constexpr double kGate = 16.3;  // chi^2, 3 degrees of freedom: 99.9 %

Se2 random_pose(Random& random) {
  return {random.uniform(-3.0, 3.0), random.uniform(-3.0, 3.0), random.uniform(-3.1, 3.1)};
}

/// What a robot at a pose finds of a marker that it has first seen from the map's origin.
Innovation innovation_of(const Se2& map_from_base, const Se2& map_from_marker,
                         const MarkerMeasurement& measurement) {
  Belief belief{{OdometryNoise{}, Eigen::Vector3d::Zero()}};
  belief.add(measurement_of(map_from_marker));
  belief.move({map_from_base, map_from_base.translation().norm(), std::abs(map_from_base.theta())},
              {});
  return *belief.nearest(measurement);
}

TEST(MarkerInnovation, DerivativesAgreeWithDifferences) {
  constexpr double kStep = 1e-5;
  constexpr double kTolerance = 1e-6;
  Random random{11};
  for (int i = 0; i < kCases; ++i) {
    const Se2 pose = random_pose(random);
    const Se2 marker = random_pose(random);
    const MarkerMeasurement measured = measurement_of(
        deviated(pose.inverse() * marker, {random.normal(0.0, 0.1), random.normal(0.0, 0.1), 0.1}));
    const Innovation at = innovation_of(pose, marker, measured);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      // The residual is measured minus expected.
      const Eigen::Vector3d by_pose =
          (innovation_of(deviated(pose, -step), marker, measured).residual -
           innovation_of(deviated(pose, step), marker, measured).residual) /
          (2.0 * kStep);
      const Eigen::Vector3d by_marker =
          (innovation_of(pose, deviated(marker, -step), measured).residual -
           innovation_of(pose, deviated(marker, step), measured).residual) /
          (2.0 * kStep);
      EXPECT_LT((at.by_pose.col(axis) - by_pose).norm(), kTolerance) << i << " axis " << axis;
      EXPECT_LT((at.by_marker.col(axis) - by_marker).norm(), kTolerance) << i << " axis " << axis;
    }
  }
}

/// A robot beside a straight wall, and a marker on it as a camera with errors sees it.
struct WallScene {
  Se2 base_from_camera{0.076, 0.0, 0.05};
  Eigen::Vector2d normal{0.0, -1.0};
  double wall_m{1.0};
  double marker_x_m{2.5};

  Observation seen_by_camera_with(double yaw_error_rad, double focal_error) const {
    Observation observation;
    for (int i = 0; i < 360; ++i) {
      const double range_m = wall_m / std::sin(radians(i));
      if (!(range_m > 0.0 && range_m < 3.5)) continue;
      const Eigen::Vector2d end =
          range_m * Eigen::Vector2d{std::cos(radians(i)), std::sin(radians(i))};
      observation.beams.push_back({Beam{i, Eigen::Vector2d::Zero(), end, range_m}});
    }
    const Se2 base_from_marker{marker_x_m, wall_m, radians(-90.0)};
    // Everything seems to lie further right of a camera that looks further left than it is told,
    // and nearer in an image that is larger.
    Se2 camera_from_marker =
        Se2{0.0, 0.0, -yaw_error_rad} * (base_from_camera.inverse() * base_from_marker);
    camera_from_marker = {(1.0 - focal_error) * camera_from_marker.x(), camera_from_marker.y(),
                          camera_from_marker.theta()};
    MarkerSighting sighting;
    sighting.id = 2;
    sighting.base_from_marker = base_from_camera * camera_from_marker;
    sighting.covariance_in_base = diagonal(0.02, 0.01, 0.03);
    sighting.covariance_in_base(0, 1) = sighting.covariance_in_base(1, 0) = 1e-4;
    sighting.size_m = 0.4;
    observation.sightings = {sighting};
    return observation;
  }

  MarkerMeasurement measured_with(const Eigen::Vector2d& camera_errors) const {
    const auto measurements =
        measure_markers(seen_by_camera_with(camera_errors.x(), camera_errors.y()),
                        {0.01, base_from_camera, {}}, {}, {});
    EXPECT_EQ(measurements.size(), 1U);
    return measurements.at(0);
  }
};

TEST(MarkerMeasurement, DerivativesByTheCamerasErrorsAgreeWithDifferences) {
  // What a held measurement's covariance changes with the errors is of second order.
  constexpr double kStep = 1e-4;
  constexpr double kTolerance = 0.01;
  for (const double marker_x_m : {1.8, 2.2, 2.6, 3.0}) {
    WallScene scene;
    scene.marker_x_m = marker_x_m;
    const MarkerMeasurement at = scene.measured_with({0.0, 0.0});
    ASSERT_TRUE(at.wall);
    for (int error = 0; error < 2; ++error) {
      const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(error);
      const MarkerMeasurement more = scene.measured_with(step);
      const MarkerMeasurement less = scene.measured_with(-step);
      const Eigen::Vector3d by_error =
          deviation(less.base_from_marker, more.base_from_marker) / (2.0 * kStep);
      EXPECT_LT((at.by_camera.col(error) - by_error).norm(), kTolerance)
          << marker_x_m << " error " << error << "\n"
          << at.by_camera.col(error).transpose() << "\n"
          << by_error.transpose();
      const Eigen::Vector2d wall_by_error =
          (more.wall->residual - less.wall->residual) / (2.0 * kStep);
      EXPECT_LT((at.wall->by_camera.col(error) - wall_by_error).norm(), kTolerance)
          << marker_x_m << " error " << error;
    }
  }
}

TEST(MarkerMeasurement, DerivativesWhereItWasMeasuredAreThoseOfTheMeasurement) {
  const MarkerMeasurement measured = WallScene{}.measured_with({0.0, 0.0});
  ASSERT_TRUE(measured.wall);
  const Eigen::Matrix3d there = measured.by_errors_at(measured.base_from_marker.translation());
  EXPECT_LT((there - measured.by_errors()).norm(), 0.01);
}

// With derivatives at the measured places, which are as far off as the residuals, the mean of the
// focal length over many such drives is five standard errors below zero.
TEST(Belief, TheNoiseOfSightingsPushesNothingToOneSide) {
  constexpr int kDrives = 400;
  constexpr int kSightings = 400;
  constexpr double kNoise_m = 0.05;
  const Se2 place{3.0, 1.0, radians(-90.0)};
  double sum = 0.0;
  double squares = 0.0;
  for (std::uint64_t drive = 0; drive < kDrives; ++drive) {
    Belief belief{{OdometryNoise{}, {0.0, 0.001, 0.0}}};
    MarkerMeasurement sighting = measurement_of(place);
    sighting.covariance = 1e-12 * Eigen::Matrix3d::Identity();
    belief.add(sighting);
    sighting.held.setIdentity();
    sighting.covariance = diagonal(kNoise_m, 1e-3, 1e-3);
    Random random{9, drive};
    for (int i = 0; i < kSightings; ++i) {
      sighting.base_from_marker = deviated(place, {random.normal(0.0, kNoise_m), 0.0, 0.0});
      belief.correct(0, sighting, kGate);
    }
    const double focal = belief.sighting_errors().y();
    sum += focal;
    squares += focal * focal;
  }
  const double standard_error = std::sqrt(squares) / kDrives;
  EXPECT_LT(std::abs(sum / kDrives), 3.0 * standard_error);
}

/// The n-th thing that happens to a belief; the same for every belief.
void happen(int n, Belief& belief) {
  Random random{5, static_cast<std::uint64_t>(n)};
  belief.move({Se2{0.2, 0.0, random.normal(0.0, 0.01)}, 0.2, 0.01}, {});
  MarkerMeasurement measurement =
      measurement_of({random.uniform(1.0, 3.0), 1.0, radians(-90.0)}, n % 7);
  measurement.time = Timestamp{std::chrono::seconds{n}};
  const auto nearest = belief.nearest(measurement);
  if (nearest && nearest->distance_m() < 1.5) {
    belief.correct(nearest->marker, measurement, kGate);  // revives what has been settled
  } else {
    belief.add(measurement);
  }
  belief.settle_oldest(3);
}

void expect_equal(const Belief& one, const Belief& other) {
  EXPECT_EQ(one.map_from_base().translation(), other.map_from_base().translation());
  EXPECT_EQ(one.pose_covariance(), other.pose_covariance());
  const auto markers = one.markers();
  const auto others = other.markers();
  ASSERT_EQ(markers.size(), others.size());
  for (std::size_t i = 0; i < markers.size(); ++i) {
    EXPECT_EQ(markers[i].id, others[i].id);
    EXPECT_EQ(markers[i].map_from_marker.translation(), others[i].map_from_marker.translation());
    EXPECT_EQ(markers[i].covariance, others[i].covariance);
    EXPECT_EQ(markers[i].sightings, others[i].sightings);
  }
}

// Particles share their settled markers until one of them changes hers: nobody may notice.
TEST(SettledMarkers, SharedAreAsGoodAsCopied) {
  constexpr int kEvents = 40;
  const Belief fresh{{OdometryNoise{}, {0.005, 0.002, 0.0}}};
  std::vector<Belief> family{fresh};  // each is a copy of the one before, and one event further
  for (int n = 0; n < kEvents; ++n) {
    family.push_back(family.back());
    happen(n, family.back());
  }
  for (int age = 0; age <= kEvents; ++age) {
    Belief alone = fresh;
    for (int n = 0; n < age; ++n)
      happen(n, alone);
    expect_equal(alone, family[static_cast<std::size_t>(age)]);
  }
  EXPECT_GT(family.back().markers().size(), 5U);
}

// All three axes, correlated: the sum over a fine grid is the truth.
TEST(PoseProposal, AgreesWithBruteForceIntegrationInThreeDimensions) {
  const Eigen::Matrix3d root =
      (Eigen::Matrix3d{} << 0.04, 0, 0, 0.01, 0.02, 0, 0.005, -0.01, 0.03).finished();
  const Eigen::Matrix3d prior_covariance = root * root.transpose();
  const Eigen::Matrix3d prior_information = prior_covariance.inverse();
  Eigen::Matrix3d measured_information;
  measured_information << 900, 300, 0, 300, 2500, 400, 0, 400, 1600;
  const Se2 prior{1.0, -2.0, 0.3};
  const Eigen::Vector3d measured{0.03, -0.01, 0.02};  // from the prior
  const PoseProposal proposal =
      propose(prior, prior_covariance, [&](const Se2& pose, const Eigen::Matrix3d&) {
        const Eigen::Vector3d residual = deviation(prior, pose) - measured;
        return PoseInformation{measured_information, measured_information * residual,
                               0.5 * residual.dot(measured_information * residual)};
      });

  constexpr int kHalf = 40;
  constexpr double kStep = 0.005;
  double mass = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (int i = -kHalf; i <= kHalf; ++i) {
    for (int j = -kHalf; j <= kHalf; ++j) {
      for (int k = -kHalf; k <= kHalf; ++k) {
        const Eigen::Vector3d at = kStep * Eigen::Vector3d{1.0 * i, 1.0 * j, 1.0 * k};
        const Eigen::Vector3d residual = at - measured;
        const double density = std::exp(-0.5 * at.dot(prior_information * at) -
                                        0.5 * residual.dot(measured_information * residual));
        mass += density;
        mean += density * at;
        squares += density * at * at.transpose();
      }
    }
  }
  mean /= mass;
  const double volume = std::pow(kStep, 3) / std::sqrt(prior_covariance.determinant() *
                                                       std::pow(2.0 * std::numbers::pi, 3));
  EXPECT_LT((deviation(prior, proposal.mean) - mean).norm(), 1e-5);
  EXPECT_LT((proposal.covariance - (squares / mass - mean * mean.transpose())).norm(), 1e-6);
  EXPECT_NEAR(proposal.log_evidence, std::log(mass * volume), 1e-4);
}

}  // namespace
}  // namespace waymark
