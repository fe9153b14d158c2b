// SPDX-License-Identifier: BSD-3-Clause
// Prints how far gmapping thinks it has come down a bare 50 m corridor with perfect odometry,
// beside what the released GMapping was measured to think on scans made in the same way.
//
// usage: gmapping_corridor [SEEDS [ROW ...]]      default: 1 seed, all rows; rows count from 1
#include "slam/core/estimators/gmapping.hpp"
#include "support/observations.hpp"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <set>
#include <vector>

namespace waymark {
namespace {

struct Row {
  const char* name;
  double width_m;
  double range_m;
  double usable_range_m;
  double linear_update_m;
  int particles;
  FreeCells free_cells;
  double scale_error;
  double minimum_score;
  double temporal_update_s;
  double angular_update_rad;
  const char* released;  ///< [%] of 48 m, research on the unchanged library, 1 to 3 seeds
};

constexpr auto kReleased = FreeCells::kAsReleased;
constexpr auto kIntended = FreeCells::kIntended;

constexpr Row kRows[]{
    {"slam_gmapping", 2.0, 3.5, 3.49, 1.0, 30, kReleased, 0.0, 0.0, -1.0, 0.5, "80-85"},
    {"100 particles", 2.0, 3.5, 3.49, 1.0, 100, kReleased, 0.0, 0.0, -1.0, 0.5, "83-84"},
    {"odometry 2 % too long", 2.0, 3.5, 3.49, 1.0, 30, kReleased, 0.02, 0.0, -1.0, 0.5, "85-86"},
    {"gate 0.2 m", 2.0, 3.5, 3.49, 0.2, 30, kReleased, 0.0, 0.0, -1.0, 0.5, "78"},
    {"gate 0.05 m", 2.0, 3.5, 3.49, 0.05, 30, kReleased, 0.0, 0.0, -1.0, 0.5, "9.7"},
    {"width 2.5 m", 2.5, 3.5, 3.49, 1.0, 30, kReleased, 0.0, 0.0, -1.0, 0.5, "30"},
    {"width 3.0 m", 3.0, 3.5, 3.49, 1.0, 30, kReleased, 0.0, 0.0, -1.0, 0.5, "19"},
    {"usable range 3.0 m", 2.0, 3.5, 3.0, 1.0, 30, kReleased, 0.0, 0.0, -1.0, 0.5, "16"},
    {"same, minimum score 200", 2.0, 3.5, 3.0, 1.0, 30, kReleased, 0.0, 200.0, -1.0, 0.5, "16"},
    {"turtlebot3", 2.0, 3.5, 3.0, 1.0, 100, kReleased, 0.0, 50.0, 0.5, 0.2, "8"},
    {"turtlebot3, no time gate", 2.0, 3.5, 3.0, 1.0, 100, kReleased, 0.0, 50.0, -1.0, 0.2, "16-20"},
    {"12 m LiDAR", 2.0, 12.0, 11.99, 1.0, 30, kReleased, 0.0, 0.0, -1.0, 0.5, "96.5-97"},
    {"12 m LiDAR, width 3.0 m", 3.0, 12.0, 11.99, 1.0, 30, kReleased, 0.0, 0.0, -1.0, 0.5, "97"},
    {"12 m LiDAR, gate 0.5 s", 2.0, 12.0, 11.99, 1.0, 30, kReleased, 0.0, 0.0, 0.5, 0.5, "45"},
    {"intended", 2.0, 3.5, 3.49, 1.0, 30, kIntended, 0.0, 0.0, -1.0, 0.5, "93-95"},
    {"intended, width 3.0 m", 3.0, 3.5, 3.49, 1.0, 30, kIntended, 0.0, 0.0, -1.0, 0.5, "61"},
    {"intended, tb3, no time gate", 2.0, 3.5, 3.0, 1.0, 100, kIntended, 0.0, 50.0, -1.0, 0.2,
     "75-77"},
    {"never matched, 2 % too long", 2.0, 3.5, 3.0, 1.0, 30, kReleased, 0.02, 1000.0, -1.0, 0.5,
     "101.8"},
};

/// Share of the true way, in percent.
double estimated_travel_percent(const Row& row, std::uint64_t seed) {
  test::SyntheticCorridor corridor = test::bare_corridor();
  corridor.width_m = row.width_m;
  corridor.range_max_m = row.range_m;
  corridor.scale_error = row.scale_error;
  corridor.seed = seed;
  GmappingConfig config;
  config.particles = row.particles;
  config.max_usable_range_m = row.usable_range_m;
  config.minimum_score = row.minimum_score;
  config.gate = {row.linear_update_m, row.angular_update_rad, row.temporal_update_s};
  config.matcher.free_cells = row.free_cells;
  EstimatorSetup setup;
  setup.range_max_m = corridor.range_max_m;
  setup.seed = seed;
  GmappingEstimator estimator{setup, config};
  double x_m = 0.0;
  for (const Observation& observation : test::observations_of(test::drive(corridor), corridor))
    x_m = estimator.update(observation).map_from_base.x();
  return 100.0 * x_m / corridor.drive_m;
}

}  // namespace
}  // namespace waymark

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 1;
  std::set<int> chosen;
  for (int i = 2; i < argc; ++i)
    chosen.insert(std::atoi(argv[i]));
  std::printf("row  %-28s %9s %9s   seeds\n", "estimated travel [%]", "released", "median");
  int number = 0;
  for (const waymark::Row& row : waymark::kRows) {
    ++number;
    if (!chosen.empty() && !chosen.contains(number)) continue;
    std::vector<double> travels;
    for (int seed = 1; seed <= seeds; ++seed)
      travels.push_back(waymark::estimated_travel_percent(row, static_cast<std::uint64_t>(seed)));
    std::sort(travels.begin(), travels.end());
    std::printf("%3d  %-28s %9s %9.1f   %.1f .. %.1f\n", number, row.name, row.released,
                travels[travels.size() / 2], travels.front(), travels.back());
    std::fflush(stdout);
  }
}
