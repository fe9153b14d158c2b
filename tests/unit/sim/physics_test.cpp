// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/robot/physics.hpp"

#include "sim/core/robot/drive.hpp"
#include "sim/core/world/mjcf.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace waymark {
namespace {

constexpr int kRate_hz = 600;

Physics standing_at(const Se2& world_from_start) {
  MjcfOptions options{};
  options.time_step_s = 1.0 / kRate_hz;
  options.world_from_start = world_from_start;
  return Physics{to_mjcf(build_world({}, {}, 0.6, 1), {}, options)};
}

/// Speeds up within half a second, so that the tyres do not slip.
void drive(Physics& physics, const Velocity& velocity, double duration_s) {
  for (int i = 0; i < duration_s * kRate_hz; ++i) {
    const double share = std::min(1.0, 2.0 * i / kRate_hz);
    physics.step(wheel_speeds({}, {share * velocity.forward_mps, share * velocity.turn_radps}));
  }
}

TEST(Physics, StandsStillOnItsWheels) {
  Physics physics = standing_at({2.0, 0.3, 0.5});
  drive(physics, {}, 2.0);
  EXPECT_NEAR(physics.world_from_base().x(), 2.0, 1e-4);
  EXPECT_NEAR(physics.world_from_base().y(), 0.3, 1e-4);
  EXPECT_NEAR(physics.world_from_base().theta(), 0.5, 1e-4);
  EXPECT_NEAR(physics.world_from_base_3d().translation().z(), 0.0, 0.001);
  EXPECT_NEAR(physics.wheel_angles().left, 0.0, 1e-3);
}

TEST(Physics, MassIsThatOfTheWafflePi) {
  Physics physics = standing_at({2.0, 0.0, 0.0});
  EXPECT_NEAR(mj_getTotalmass(&physics.model()), 1.8, 1e-6);
}

TEST(Physics, DrivesAsItsWheelsTurn) {
  Physics physics = standing_at({2.0, 0.0, 0.0});
  drive(physics, {0.2, 0.0}, 5.0);
  const double travelled_m = physics.world_from_base().x() - 2.0;
  const double rolled_m = physics.wheel_angles().left * BaseConfig{}.wheel_radius_m;
  EXPECT_NEAR(travelled_m, 0.2 * 4.75, 0.01);
  EXPECT_NEAR(rolled_m, travelled_m, 0.0005 * travelled_m);  // slip below 0.05 %
}

TEST(Physics, TurnsOnTheSpot) {
  Physics physics = standing_at({2.0, 0.0, 0.0});
  drive(physics, {0.0, 0.5}, 2.0);
  EXPECT_NEAR(physics.world_from_base().theta(), 0.5 * 1.75, 0.02);
  EXPECT_NEAR(physics.world_from_base().x(), 2.0, 0.01);
}

TEST(Physics, ThePoseAtAnotherTimeIsThatOfAnEvenMotion) {
  constexpr double kLater_s = 0.1;
  Physics physics = standing_at({2.0, 0.0, 0.5});
  drive(physics, {0.2, 0.5}, 2.0);
  const Eigen::Isometry3d expected_later = physics.world_from_base_3d_at(kLater_s);
  const Eigen::Isometry3d now = physics.world_from_base_3d();
  EXPECT_TRUE(physics.world_from_base_3d_at(0.0).isApprox(now));
  for (int i = 0; i < kLater_s * kRate_hz; ++i)
    physics.step(wheel_speeds({}, {0.2, 0.5}));
  const Eigen::Isometry3d later = physics.world_from_base_3d();
  EXPECT_NEAR((later.translation() - now.translation()).norm(), 0.02, 0.001);
  // In 0.1 s the heading turns by 0.05 rad, so that the path bends by half of that.
  EXPECT_NEAR((later.translation() - expected_later.translation()).norm(), 0.0, 0.03 * 0.02);
  EXPECT_NEAR((expected_later.linear().transpose() * later.linear()).trace(), 3.0, 1e-4);
  const Eigen::Isometry3d expected_now = physics.world_from_base_3d_at(-kLater_s);
  EXPECT_NEAR((now.translation() - expected_now.translation()).norm(), 0.0, 0.03 * 0.02);
}

TEST(Physics, WallsStopTheRobotAndItsWheelsSlip) {
  Physics physics = standing_at({49.5, 0.0, 0.0});
  drive(physics, {0.3, 0.0}, 5.0);
  const double travelled_m = physics.world_from_base().x() - 49.5;
  const double rolled_m = physics.wheel_angles().left * BaseConfig{}.wheel_radius_m;
  EXPECT_LT(travelled_m, 0.5);
  EXPECT_GT(rolled_m, travelled_m + 0.1);
}

TEST(Physics, InvalidModelsAreExplained) {
  EXPECT_THROW(Physics{"<mujoco><nonsense/></mujoco>"}, SimulatorError);
}

}  // namespace
}  // namespace waymark
