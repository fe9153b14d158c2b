// SPDX-License-Identifier: BSD-3-Clause
// Prints how the errors of waymark compare with its covariance over many drives down synthetic
// corridors, so many that chance hardly matters (20 recorded seeds leave the mean square of an
// error uncertain by a third).
//
// The errors of odometry and camera are drawn with the standard deviations that the filter
// believes.
//
// usage: synthetic_consistency [SEEDS [DRIVE_M [SPACING_M [SILENT_FROM_M SILENT_TO_M]]]]
//   SEEDS          default: 100
//   DRIVE_M        default: 20
//   SPACING_M      of the pairs of markers, 0 = none; default: 4
//   SILENT_FROM_M  the LiDAR is off from there to SILENT_TO_M; default: nowhere
// Columns, every metre: travel [m], mean NEES (3 is right); then along, across [mm] and heading
// [mrad]: RMS error, RMS standard deviation, mean of squared error over variance (1 is right).
#include "property/slam/estimator_run.hpp"
#include "slam/core/estimators/waymark.hpp"
#include "slam/parallel.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <thread>

namespace waymark {
namespace {

constexpr double kSpeed_m_s = 0.5;

struct Drives {
  int seeds{100};
  double drive_m{20.0};
  double spacing_m{4.0};
  double silent_from_m{0.0};
  double silent_to_m{0.0};
};

/// Sums over the seeds.
struct Station {
  double nees{0.0};
  Eigen::Vector3d squares{Eigen::Vector3d::Zero()};
  Eigen::Vector3d variances{Eigen::Vector3d::Zero()};
  Eigen::Vector3d ratios{Eigen::Vector3d::Zero()};
};

using Stations = std::map<int, Station>;

test::SyntheticCorridor corridor_of(const Drives& drives, std::uint64_t seed) {
  Random random{seed};
  test::SyntheticCorridor corridor;
  corridor.length_m = drives.drive_m + 8.0;
  corridor.drive_m = drives.drive_m;
  corridor.speed_m_s = kSpeed_m_s;
  corridor.seed = seed;
  corridor.scale_error = random.normal(0.0, 0.01);
  corridor.turn_scale_error = random.normal(0.0, 0.005);
  corridor.camera_focal_error =
      random.normal(0.0, SightingNoise{}.calibration[SightingNoise::kFocal]);
  corridor.camera_yaw_error_rad =
      random.normal(0.0, SightingNoise{}.calibration[SightingNoise::kYaw]);
  if (drives.spacing_m > 0.0)
    corridor.markers = test::opposite_markers(corridor, 4.0, drives.spacing_m);
  return corridor;
}

test::SensorLog log_of(const Drives& drives, const test::SyntheticCorridor& corridor) {
  test::SensorLog log = test::drive(corridor);
  const Timestamp start = log.scans.front().time;
  std::erase_if(log.scans, [&](const LidarScan& scan) {
    const double travel_m = kSpeed_m_s * to_seconds(scan.time - start);
    return travel_m > drives.silent_from_m && travel_m < drives.silent_to_m;
  });
  return log;
}

Stations drive_once(const Drives& drives, std::uint64_t seed) {
  const test::SyntheticCorridor corridor = corridor_of(drives, seed);
  WaymarkEstimator estimator{test::estimator_setup_of(corridor, seed), {}};
  Stations stations;
  for (const test::Step& step :
       test::run(estimator, log_of(drives, corridor), test::setup_of(corridor))) {
    const int travel_m = static_cast<int>(step.truth.x());
    if (travel_m < 1 || stations.contains(travel_m)) continue;
    const Eigen::Vector3d error = pose_difference(step.estimate.map_from_base, step.truth);
    const Eigen::Matrix3d& covariance = step.estimate.covariance;
    const Eigen::Vector3d squares = error.cwiseAbs2();
    stations[travel_m] = {error.dot(covariance.ldlt().solve(error)), squares, covariance.diagonal(),
                          squares.cwiseQuotient(covariance.diagonal())};
  }
  return stations;
}

Stations drive_all(const Drives& drives) {
  std::vector<Stations> each(static_cast<std::size_t>(drives.seeds));
  const auto threads = static_cast<int>(std::max(1U, std::thread::hardware_concurrency()));
  parallel_for_with(threads)(each.size(), [&](std::size_t i) {
    each[i] = drive_once(drives, static_cast<std::uint64_t>(i) + 1);
  });
  Stations sums;
  for (const Stations& stations : each) {
    for (const auto& [travel_m, station] : stations) {
      Station& sum = sums[travel_m];
      sum.nees += station.nees;
      sum.squares += station.squares;
      sum.variances += station.variances;
      sum.ratios += station.ratios;
    }
  }
  return sums;
}

void print(const Stations& sums, int seeds) {
  Eigen::Vector3d ratios = Eigen::Vector3d::Zero();
  for (const auto& [travel_m, sum] : sums) {
    std::printf("%4d %5.2f", travel_m, sum.nees / seeds);
    for (int axis = 0; axis < 3; ++axis) {
      std::printf("  %7.3f %7.3f %5.2f", 1e3 * std::sqrt(sum.squares[axis] / seeds),
                  1e3 * std::sqrt(sum.variances[axis] / seeds), sum.ratios[axis] / seeds);
    }
    std::printf("\n");
    ratios += sum.ratios / seeds / static_cast<double>(sums.size());
  }
  std::printf("# squared errors over variances: along %.2f, across %.2f, heading %.2f\n", ratios[0],
              ratios[1], ratios[2]);
}

}  // namespace
}  // namespace waymark

int main(int argc, char** argv) {
  waymark::Drives drives;
  if (argc > 1) drives.seeds = std::atoi(argv[1]);
  if (argc > 2) drives.drive_m = std::atof(argv[2]);
  if (argc > 3) drives.spacing_m = std::atof(argv[3]);
  if (argc == 6) {
    drives.silent_from_m = std::atof(argv[4]);
    drives.silent_to_m = std::atof(argv[5]);
  }
  if (drives.seeds < 1 || drives.drive_m < 1.0 || argc == 5 || argc > 6) {
    std::fprintf(stderr,
                 "usage: synthetic_consistency [SEEDS [DRIVE_M [SPACING_M [SILENT_FROM_M "
                 "SILENT_TO_M]]]]\n");
    return 2;
  }
  waymark::print(waymark::drive_all(drives), drives.seeds);
}
