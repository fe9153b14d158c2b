// SPDX-License-Identifier: BSD-3-Clause
#include "common/random/random.hpp"
#include "slam/core/motion/motion_model.hpp"
#include "slam/core/motion/odometry_buffer.hpp"
#include "slam/core/motion/odometry_errors.hpp"

#include <gtest/gtest.h>

#include <optional>

namespace waymark {
namespace {

Timestamp at_ms(int milliseconds) {
  return timestamp_from_us(milliseconds * 1000);
}

TEST(Motion, DrivingBackwardsCountsNegativeInTheAdvance) {
  const Motion ahead = Motion::between({}, {0.5, 0.0, 0.0});
  const Motion back = Motion::between({}, {-0.2, 0.0, 0.0});
  EXPECT_NEAR(ahead.then(back).advance_m, 0.3, 1e-12);
  EXPECT_NEAR(ahead.then(back).distance_m, 0.7, 1e-12);
}

/// With one wheel larger than the other, the robot turns one way driving forwards and the opposite
/// way backwards.
TEST(OdometryErrors, DriftTurnsInTheOppositeDirectionInReverse) {
  OdometryErrors errors = OdometryErrors::Zero();
  errors[OdometryTerm::kDrift] = 0.01;  // rad/m
  const auto turn_rad = [&](double drive_m) {
    return corrected_motion(Motion::between({}, {drive_m, 0.0, 0.0}), errors, {})
        .start_from_end.theta();
  };
  EXPECT_NEAR(turn_rad(2.0), 0.02, 1e-12);
  EXPECT_NEAR(turn_rad(-2.0), -0.02, 1e-12);
}

OdometryNoise without_noise() {
  OdometryNoise noise;
  noise.along_per_sqrt_m = 0.0;
  noise.across_per_sqrt_m = 0.0;
  noise.turn_per_sqrt_m = 0.0;
  noise.turn_per_sqrt_rad = 0.0;
  return noise;
}

TEST(OdometryErrors, ALidarThatIsMountedElsewhereMovesAsARigidBody) {
  OdometryErrors errors = OdometryErrors::Zero();
  errors[OdometryTerm::kLidarAhead] = 0.08;
  errors[OdometryTerm::kLidarYaw] = 0.09;
  const Se2 mounting{0.08, 0.0, 0.09};
  const Se2 mounting_without_yaw{0.08, 0.0, 0.0};
  const Se2 base{0.4, -0.1, 0.7};
  const Se2 lidar =
      corrected_motion(Motion::between({}, base), errors, without_noise()).start_from_end;
  EXPECT_LT(pose_difference(lidar, mounting.inverse() * base * mounting).norm(), 1e-6);
  EXPECT_GT(
      pose_difference(lidar, mounting_without_yaw.inverse() * base * mounting_without_yaw).norm(),
      0.01);
}

TEST(OdometryErrors, TheJacobianIsTheDerivativeByEachError) {
  constexpr double kStep = 1e-6;
  const Motion motion = Motion::between({}, {0.4, -0.1, 0.3});
  OdometryErrors errors = OdometryErrors::Zero();
  errors[OdometryTerm::kLidarAhead] = 0.05;
  errors[OdometryTerm::kLidarYaw] = 0.05;
  const CorrectedMotion at = corrected_motion(motion, errors, without_noise());
  for (Eigen::Index i = 0; i < kOdometryTerms; ++i) {
    OdometryErrors more = errors;
    OdometryErrors less = errors;
    more[i] += kStep;
    less[i] -= kStep;
    const Eigen::Vector3d numeric =
        pose_difference(corrected_motion(motion, more, without_noise()).start_from_end,
                        corrected_motion(motion, less, without_noise()).start_from_end) /
        (2.0 * kStep);
    EXPECT_LT((numeric - at.jacobian_calibration.col(i)).norm(), 1e-3) << i;
  }
}

/// The wheels roll, so a turn on the spot has the noise of a straight path of the length
/// that each wheel rolls.
TEST(OdometryErrors, ATurnOnTheSpotHasPositionNoise) {
  OdometryNoise noise;
  noise.half_track_m = 0.2;
  const auto along_m2 = [&](const Se2& end) {
    return corrected_motion(Motion::between({}, end), OdometryErrors::Zero(), noise)
        .covariance(0, 0);
  };
  EXPECT_NEAR(along_m2({0.0, 0.0, 0.5}), along_m2({0.1, 0.0, 0.0}), 1e-8);
  EXPECT_NEAR(along_m2({0.3, 0.0, 0.0}), along_m2({0.3, 0.0, 0.5}), 1e-8);
}

TEST(OdometryBuffer, InterpolatesBetweenSamples) {
  OdometryBuffer buffer;
  buffer.add({at_ms(0), Se2{0.0, 0.0, 0.0}});
  buffer.add({at_ms(100), Se2{0.2, 0.1, 0.4}});

  EXPECT_TRUE(buffer.covers(at_ms(25)));
  EXPECT_FALSE(buffer.covers(at_ms(101)));
  EXPECT_NEAR(buffer.pose_at(at_ms(25)).x(), 0.05, 1e-12);
  EXPECT_NEAR(buffer.pose_at(at_ms(25)).theta(), 0.1, 1e-12);
  EXPECT_NEAR(buffer.pose_at(at_ms(100)).y(), 0.1, 1e-12);
}

TEST(OdometryBuffer, RefusesSamplesThatAreNotNewer) {
  OdometryBuffer buffer;
  EXPECT_EQ(buffer.add({at_ms(10), {}}), OdometryBuffer::Outcome::kAdded);
  EXPECT_EQ(buffer.add({at_ms(10), {}}), OdometryBuffer::Outcome::kOutOfOrder);
  EXPECT_EQ(buffer.add({at_ms(5), {}}), OdometryBuffer::Outcome::kOutOfOrder);
}

TEST(OdometryBuffer, AResetOfTheOdometryIsNoMotion) {
  OdometryBuffer buffer;
  buffer.add({at_ms(0), Se2{5.0, 1.0, 0.5}});
  EXPECT_EQ(buffer.add({at_ms(33), Se2{0.0, 0.0, 0.0}}), OdometryBuffer::Outcome::kJumped);
  for (int step = 1; step <= 6; ++step)
    buffer.add({at_ms(33 + 33 * step), Se2{0.01 * step, 0.0, 0.0}});

  const Motion motion = buffer.motion_between(at_ms(0), at_ms(231));

  EXPECT_NEAR(motion.start_from_end.x(), 0.06, 1e-12);
  EXPECT_NEAR(motion.start_from_end.y(), 0.0, 1e-12);
  EXPECT_FALSE(buffer.late_motion(at_ms(0), at_ms(231)));
}

TEST(OdometryBuffer, AResetAfterAGapIsNoMotion) {
  OdometryBuffer buffer;
  buffer.add({at_ms(0), Se2{5.0, 0.0, 0.3}});
  EXPECT_EQ(buffer.add({at_ms(8000), Se2{}}), OdometryBuffer::Outcome::kJumped);
  for (int step = 1; step <= 6; ++step)
    buffer.add({at_ms(8000 + 33 * step), Se2{0.01 * step, 0.0, 0.0}});

  const Motion motion = buffer.motion_between(at_ms(0), at_ms(8198));

  EXPECT_NEAR(motion.start_from_end.x(), 0.06, 1e-12);
  EXPECT_FALSE(buffer.late_motion(at_ms(0), at_ms(8198)));
}

TEST(OdometryBuffer, DrivingSlowlyThroughTheOriginIsMotion) {
  OdometryBuffer buffer;
  for (int step = -5; step <= 5; ++step) {
    EXPECT_EQ(buffer.add({at_ms(1000 + 100 * step), Se2{0.05 * step, 0.0, 0.0}}),
              OdometryBuffer::Outcome::kAdded);
  }
  EXPECT_NEAR(buffer.motion_between(at_ms(500), at_ms(1500)).start_from_end.x(), 0.5, 1e-12);
}

TEST(OdometryBuffer, AfterAShortStandstillAJumpIsLateMotionAtAnySampleRate) {
  for (const int rate_hz : {10, 30, 100}) {
    for (const double stuck_s : {1.0, 2.0, 4.0}) {
      OdometryBuffer buffer;
      const int period_ms = 1000 / rate_hz;
      const int samples = static_cast<int>(stuck_s * rate_hz);
      for (int i = 0; i <= samples; ++i)
        buffer.add({at_ms(i * period_ms), Se2{1.0, 0.0, 0.0}});
      const int end_ms = (samples + 1) * period_ms;
      const double late_m = 0.25 * stuck_s;  // as of a TurtleBot3
      buffer.add({at_ms(end_ms), Se2{1.0 + late_m, 0.0, 0.0}});
      const auto late = buffer.late_motion(at_ms(0), at_ms(end_ms));
      ASSERT_TRUE(late) << rate_hz << " Hz, " << stuck_s << " s";
      EXPECT_NEAR(late->start_from_end.x(), late_m, 1e-9);
    }
  }
}

TEST(OdometryBuffer, MotionDuringGarbageIsReportedAfterIt) {
  Random random{{5}};
  OdometryBuffer buffer;
  const auto right = [](int step) {
    return Se2{3.0 + 0.005 * step, -1.0, 0.3};
  };
  int jumps = 0;
  std::optional<Motion> late_motion;
  for (int step = 0; step <= 40; ++step) {
    const bool is_garbage = step > 10 && step <= 25;
    const Se2 off{random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-3.0, 3.0)};
    const auto outcome =
        buffer.add({at_ms(33 * step), is_garbage ? right(step) * off : right(step)});
    jumps += outcome == OdometryBuffer::Outcome::kJumped ? 1 : 0;
    if (outcome == OdometryBuffer::Outcome::kCaughtUp)
      late_motion = buffer.late_motion(at_ms(33 * (step - 1)), at_ms(33 * step));
  }
  EXPECT_GE(jumps, 10);
  EXPECT_FALSE(buffer.has_jumped(at_ms(0), at_ms(300)));
  EXPECT_TRUE(buffer.has_jumped(at_ms(500), at_ms(700)));
  EXPECT_FALSE(buffer.has_jumped(at_ms(1100), at_ms(1300)));
  ASSERT_TRUE(late_motion);
  const Motion reported = buffer.motion_between(at_ms(0), at_ms(33 * 40));
  const Se2 whole = right(0).inverse() * right(40);
  EXPECT_NEAR(reported.start_from_end.x() + late_motion->start_from_end.x(), whole.x(), 1e-9);
  EXPECT_NEAR(reported.start_from_end.y() + late_motion->start_from_end.y(), whole.y(), 1e-9);
}

/// Stands at (5, 1, 0.5), by default for a second, then reports another pose.
OdometryBuffer::Outcome outcome_after_standing(const Se2& then, OdometryBuffer& buffer,
                                               int standing_ms = 1000) {
  for (int ms = 0; ms <= standing_ms; ms += 50)
    EXPECT_EQ(buffer.add({at_ms(ms), Se2{5.0, 1.0, 0.5}}), OdometryBuffer::Outcome::kAdded);
  return buffer.add({at_ms(standing_ms + 50), then});
}

TEST(OdometryBuffer, TheJumpAfterAStandstillIsLateMotion) {
  OdometryBuffer buffer;
  const Se2 driven{1.5, 0.1, 0.2};
  EXPECT_EQ(outcome_after_standing(Se2{5.0, 1.0, 0.5} * driven, buffer),
            OdometryBuffer::Outcome::kCaughtUp);

  EXPECT_NEAR(buffer.motion_between(at_ms(0), at_ms(1050)).distance_m, 0.0, 1e-12);
  const auto late_motion = buffer.late_motion(at_ms(1000), at_ms(1050));
  ASSERT_TRUE(late_motion);
  EXPECT_NEAR((late_motion->start_from_end.translation() - driven.translation()).norm(), 0.0,
              1e-12);
  EXPECT_NEAR(late_motion->start_from_end.theta(), 0.2, 1e-12);
  EXPECT_FALSE(buffer.late_motion(at_ms(950), at_ms(1000)));
  EXPECT_FALSE(buffer.late_motion(at_ms(1050), at_ms(1100)));
}

TEST(OdometryBuffer, LateMotionIsBoundedByTheTimeOfTheStandstill) {
  for (const Se2& driven : {Se2{7.0, 0.0, 0.0}, Se2{0.1, 0.0, 2.8}}) {
    for (const int standing_ms : {1000, 4000}) {
      OdometryBuffer buffer;
      EXPECT_EQ(outcome_after_standing(Se2{5.0, 1.0, 0.5} * driven, buffer, standing_ms),
                standing_ms < 2000 ? OdometryBuffer::Outcome::kJumped
                                   : OdometryBuffer::Outcome::kCaughtUp);
    }
  }
}

TEST(OdometryBuffer, AResetOfAParkedRobotIsNoMotion) {
  const Se2 begins_anew;
  const Se2 further_than_it_can_drive{12.0, 1.0, 0.5};
  for (const Se2& then : {begins_anew, further_than_it_can_drive}) {
    OdometryBuffer buffer;
    EXPECT_EQ(outcome_after_standing(then, buffer), OdometryBuffer::Outcome::kJumped);
    EXPECT_FALSE(buffer.late_motion(at_ms(0), at_ms(1050)));
  }
}

TEST(OdometryBuffer, AClockStepShiftsTheSamples) {
  OdometryBuffer buffer;
  buffer.add({at_ms(0), Se2{}});
  buffer.add({at_ms(100), Se2{0.2, 0.0, 0.0}});
  buffer.shift(at_ms(5000) - at_ms(0));
  EXPECT_FALSE(buffer.covers(at_ms(50)));
  EXPECT_TRUE(buffer.covers(at_ms(5000)) && buffer.covers(at_ms(5100)));
  EXPECT_NEAR(buffer.pose_at(at_ms(5025)).x(), 0.05, 1e-12);
  EXPECT_EQ(buffer.newest(), at_ms(5100));
}

TEST(OdometryBuffer, AClockStepDoesNotChangeHowLongARobotHasStood) {
  for (const double driven_m : {1.5, 7.0}) {
    for (const int step_ms : {-10'000, 10'000}) {
      OdometryBuffer buffer;
      const Se2 standing{5.0, 1.0, 0.5};
      for (int ms = 0; ms <= 1000; ms += 50)
        buffer.add({at_ms(ms), standing});
      buffer.shift(at_ms(step_ms) - at_ms(0));
      EXPECT_EQ(
          buffer.add({at_ms(step_ms + 1050), standing * Se2{driven_m, 0.0, 0.0}}),
          driven_m < 2.0 ? OdometryBuffer::Outcome::kCaughtUp : OdometryBuffer::Outcome::kJumped);
    }
  }
}

TEST(OdometryBuffer, AClockStepShiftsLateMotion) {
  OdometryBuffer buffer;
  outcome_after_standing(Se2{5.0, 1.0, 0.5} * Se2{1.5, 0.1, 0.2}, buffer);
  buffer.shift(at_ms(5000) - at_ms(0));
  EXPECT_TRUE(buffer.late_motion(at_ms(6000), at_ms(6050)));
  EXPECT_FALSE(buffer.late_motion(at_ms(1000), at_ms(1050)));
}

/// Garbage for five samples, with a step of the clock in its middle; then the odometry goes on
/// `moved_m` farther than before.
OdometryBuffer after_garbage(int clock_step_ms, double moved_m) {
  Random random{{5}};
  OdometryBuffer buffer;
  for (int step = 0; step <= 30; ++step) {
    const bool is_garbage = step > 10 && step <= 15;
    Se2 pose{3.0 + 0.005 * step + (step > 10 ? moved_m : 0.0), -1.0, 0.3};
    if (is_garbage) pose = pose * Se2{random.uniform(2.0, 9.0), random.uniform(2.0, 9.0), 0.0};
    if (step == 13) buffer.shift(at_ms(clock_step_ms) - at_ms(0));
    buffer.add({at_ms(33 * step + (step < 13 ? 0 : clock_step_ms)), pose});
  }
  return buffer;
}

TEST(OdometryBuffer, AClockStepDuringGarbageDoesNotChangeWhatIsReportedAfterIt) {
  for (const int clock_step_ms : {-10'000, 0, 10'000}) {
    const auto at_step = [clock_step_ms](int step) {
      return at_ms(33 * step + clock_step_ms);
    };
    const OdometryBuffer buffer = after_garbage(clock_step_ms, 0.0);
    const auto late_motion = buffer.late_motion(at_step(10), at_step(30));
    ASSERT_TRUE(late_motion) << clock_step_ms;
    EXPECT_NEAR(late_motion->start_from_end.translation().norm(), 0.05, 0.01) << clock_step_ms;
    EXPECT_TRUE(buffer.has_jumped(at_step(10), at_step(11))) << clock_step_ms;
    EXPECT_FALSE(buffer.has_jumped(at_step(0), at_step(10))) << clock_step_ms;
    EXPECT_FALSE(buffer.has_jumped(at_step(22), at_step(30))) << clock_step_ms;
    const OdometryBuffer reset = after_garbage(clock_step_ms, 6.0);
    EXPECT_FALSE(reset.late_motion(at_step(10), at_step(30))) << clock_step_ms;
  }
}

TEST(OdometryBuffer, AClockStepShiftsTheTimesOfAPastJump) {
  OdometryBuffer buffer = after_garbage(0, 0.0);  // held from step 10 to step 19
  buffer.shift(at_ms(5000) - at_ms(0));
  const auto has_jumped = [&buffer](int from_step, int to_step) {
    return buffer.has_jumped(at_ms(5000 + 33 * from_step), at_ms(5000 + 33 * to_step));
  };
  EXPECT_FALSE(has_jumped(0, 10));
  EXPECT_TRUE(has_jumped(10, 11) && has_jumped(18, 19));
  EXPECT_FALSE(has_jumped(20, 30));
  EXPECT_FALSE(buffer.has_jumped(at_ms(33 * 10), at_ms(33 * 20)));
}

TEST(OdometryBuffer, MeasuresThePathNotTheDistanceOfItsEnds) {
  OdometryBuffer buffer;
  for (int step = 0; step <= 20; ++step) {
    const double x_m = 0.01 * (step <= 10 ? step : 20 - step);
    buffer.add({at_ms(33 * step), Se2{x_m, 0.0, 0.0}});
  }
  const Motion motion = buffer.motion_between(at_ms(0), at_ms(660));
  EXPECT_NEAR(motion.start_from_end.x(), 0.0, 1e-12);
  EXPECT_NEAR(motion.distance_m, 0.2, 1e-12);
}

struct Spread {
  Eigen::Vector3d mean{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
};

/// Spread at the end of a straight 2 m drive that is divided into equal steps.
Spread spread_after(int steps, const MotionNoise& noise) {
  constexpr int kSamples = 20000;
  const double step_m = 2.0 / steps;
  Spread spread;
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    Random random{17, static_cast<std::uint64_t>(steps), i};
    Se2 pose;
    for (int step = 0; step < steps; ++step)
      pose = pose * sample_motion({Se2{step_m, 0.0, 0.0}, step_m, 0.0}, noise, random);
    const Eigen::Vector3d end{pose.x(), pose.y(), pose.theta()};
    spread.mean += end / kSamples;
    spread.covariance += end * end.transpose() / kSamples;
  }
  spread.covariance -= spread.mean * spread.mean.transpose();
  return spread;
}

TEST(MotionModel, NoiseDoesNotDependOnTheStepRate) {
  const MotionNoise noise{.along_per_sqrt_m = 0.02, .turn_per_sqrt_m = 0.03};
  const Spread once = spread_after(1, noise);
  const Spread often = spread_after(40, noise);

  // Along: 0.02^2 * 2; heading: 0.03^2 * 2; sideways: 0.03^2 * 2^3 / 3. Standard error of a
  // variance of 20000 samples: 1 %.
  for (const Spread& spread : {once, often}) {
    EXPECT_NEAR(spread.covariance(0, 0), 8.0e-4, 0.05 * 8.0e-4);
    EXPECT_NEAR(spread.covariance(1, 1), 2.4e-3, 0.05 * 2.4e-3);
    EXPECT_NEAR(spread.covariance(2, 2), 1.8e-3, 0.05 * 1.8e-3);
    EXPECT_NEAR(spread.covariance(1, 2), 1.8e-3, 0.05 * 1.8e-3);
  }
}

TEST(MotionModel, RotationOnlyAddsNoNoiseToTheDistance) {
  const MotionNoise noise{.along_per_sqrt_m = 0.5, .rotation_only = true};
  for (std::uint64_t i = 0; i < 100; ++i) {
    Random random{i};
    EXPECT_EQ(sample_motion({Se2{0.5, 0.0, 0.0}, 0.5, 0.0}, noise, random).x(), 0.5);
  }
}

TEST(MotionModel, NoMotionMeansNoNoise) {
  Random random{1};
  const Se2 pose = sample_motion({}, {}, random);
  EXPECT_EQ(pose.x(), 0.0);
  EXPECT_EQ(pose.y(), 0.0);
  EXPECT_EQ(pose.theta(), 0.0);
}

}  // namespace
}  // namespace waymark
