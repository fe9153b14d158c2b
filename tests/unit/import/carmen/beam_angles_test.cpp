// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/beam_angles.hpp"

#include "synthetic_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

/// Scans by a LiDAR with these beams along a path through the room, with 2 cm noise.
std::vector<std::vector<double>> scans_of(std::size_t num_beams, const BeamAngles& angles,
                                          Walls walls = Walls::kRoom) {
  std::mt19937 random{5};
  std::normal_distribution<double> noise{0.0, 0.02};
  std::vector<std::vector<double>> scans;
  Se2 pose{};
  for (const Se2& step : to_and_fro(0.05)) {
    pose = pose * step;
    std::vector<double>& ranges_m = scans.emplace_back();
    for (std::size_t i = 0; i < num_beams; ++i) {
      const double angle_rad = angles.first_rad + angles.step_rad * static_cast<double>(i);
      ranges_m.push_back(range_to_walls_m(pose, angle_rad, walls) + noise(random));
    }
  }
  return scans;
}

std::optional<BeamAngles> found_in(const std::vector<std::vector<double>>& scans,
                                   std::size_t num_beams) {
  return straightest_angles(std::vector<std::span<const double>>{scans.begin(), scans.end()},
                            num_beams);
}

struct Layout {
  std::size_t num_beams;
  double first_deg;
  double step_deg;
};

class BeamAnglesOf : public ::testing::TestWithParam<Layout> {};

INSTANTIATE_TEST_SUITE_P(Lidars, BeamAnglesOf,
                         ::testing::Values(Layout{180, -90.0, 1.0}, Layout{181, -90.0, 1.0},
                                           Layout{360, -90.0, 0.5}, Layout{361, -90.0, 0.5},
                                           Layout{181, -135.0, 1.5}, Layout{360, -180.0, 1.0},
                                           Layout{720, -180.0, 0.5}, Layout{721, -90.0, 0.25},
                                           Layout{1081, -135.0, 0.25}, Layout{541, -135.0, 0.5},
                                           Layout{401, -50.0, 0.25},
                                           Layout{682, -120.0, 240.0 / 681.0}));

TEST_P(BeamAnglesOf, AreThoseWithWhichWallsAreStraight) {
  const auto [num_beams, first_deg, step_deg] = GetParam();
  for (const Walls walls : {Walls::kRoom, Walls::kCorridor}) {
    const auto scans = scans_of(num_beams, {radians(first_deg), radians(step_deg)}, walls);

    const auto found = found_in(scans, num_beams);

    ASSERT_TRUE(found);
    EXPECT_NEAR(degrees(found->first_rad), first_deg, 1e-9);
    EXPECT_NEAR(degrees(found->step_rad), step_deg, 1e-9);
  }
}

TEST(BeamAngles, AreThoseOfCarmensConventionWithoutWalls) {
  const std::vector<std::vector<double>> nothing(200, std::vector<double>(181, 81.91));
  EXPECT_EQ(found_in(nothing, 181)->step_rad, radians(1.0));
  EXPECT_FALSE(found_in(nothing, 90));
}

TEST(BeamAngles, AreNotEstimatedFromNoReturnRanges) {
  auto scans = scans_of(361, {radians(-90.0), radians(0.5)});
  for (std::size_t i = 0; i < scans.size(); ++i)
    std::fill(scans[i].begin() + 40, scans[i].end(), 5.6);
  EXPECT_EQ(found_in(scans, 361)->step_rad, radians(0.5));
}

}  // namespace
}  // namespace waymark
