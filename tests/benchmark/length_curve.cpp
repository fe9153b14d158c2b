// SPDX-License-Identifier: BSD-3-Clause
// Prints how the error of waymark grows with the length of the corridor: drives of 25 to 200 m down
// synthetic corridors, markers every 4 m, odometry errors as in the simulator.
//
// usage: length_curve [SEEDS [CAMERA]]
//   SEEDS   default: 10
//   CAMERA  drawn: focal length and mounting are off as much as usual calibrations; exact: they are
//           as configured, with zero prior sigmas. default: drawn
// Columns: length [m], RMS over the seeds of: error of the length of the way [m], that per metre,
// error along the way [m], error across [m]. The last line is the exponent b of length^b that fits
// the second column best.
#include "common/geometry/squared.hpp"
#include "property/slam/estimator_run.hpp"
#include "slam/core/estimators/waymark.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace waymark {
namespace {

constexpr std::array kLengths_m{25.0, 50.0, 100.0, 200.0};
constexpr double kSpeed_m_s = 0.5;  // a scan per update: quicker to compute than the robot's 0.1

struct Errors {
  double end_m{0.0};
  double along_m{0.0};
  double across_m{0.0};
};

test::SyntheticCorridor corridor_of(double length_m, bool is_exact, std::uint64_t seed) {
  test::SyntheticCorridor corridor;
  corridor.length_m = length_m;
  corridor.drive_m = length_m - 2.0;
  corridor.speed_m_s = kSpeed_m_s;
  corridor.seed = seed;
  corridor.scale_error = seed % 2 == 0 ? -0.01 : 0.01;
  Random random{seed};
  const Eigen::Vector3d estimated = SightingSigmas{}.learnt;
  if (!is_exact) {
    corridor.camera_focal_error = random.normal(0.0, estimated[SightingSigmas::kFocal]);
    corridor.camera_yaw_error_rad = random.normal(0.0, estimated[SightingSigmas::kYaw]);
  }
  corridor.markers = test::opposite_markers(corridor);
  return corridor;
}

Errors errors_of(double length_m, bool is_exact, std::uint64_t seed) {
  const test::SyntheticCorridor corridor = corridor_of(length_m, is_exact, seed);
  EstimatorSetup setup = test::estimator_setup_of(corridor, seed);
  if (is_exact) setup.sighting_sigmas = test::exact_camera();
  WaymarkEstimator estimator{setup, {}};
  const auto steps = test::run(estimator, test::drive(corridor), test::setup_of(corridor));
  double across = 0.0;
  for (const test::Step& step : steps)
    across += squared(step.estimate.map_from_base.y() - step.truth.y());
  const test::Step& last = steps.back();
  return {last.estimate.map_from_base.x() - last.truth.x(), test::along_rmse_m(steps),
          std::sqrt(across / static_cast<double>(steps.size()))};
}

/// Root mean squares over the seeds.
Errors errors_of_seeds(double length_m, bool is_exact, int seeds) {
  Errors sums;
  for (int seed = 1; seed <= seeds; ++seed) {
    const Errors errors = errors_of(length_m, is_exact, static_cast<std::uint64_t>(seed));
    sums.end_m += squared(errors.end_m) / seeds;
    sums.along_m += squared(errors.along_m) / seeds;
    sums.across_m += squared(errors.across_m) / seeds;
  }
  return {std::sqrt(sums.end_m), std::sqrt(sums.along_m), std::sqrt(sums.across_m)};
}

void print_curve(int seeds, bool is_exact) {
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  for (const double length_m : kLengths_m) {
    const Errors errors = errors_of_seeds(length_m, is_exact, seeds);
    std::printf("%.0f %.4f %.6f %.4f %.4f\n", length_m, errors.end_m, errors.end_m / length_m,
                errors.along_m, errors.across_m);
    std::fflush(stdout);
    x += std::log(length_m);
    y += std::log(errors.end_m);
    xx += squared(std::log(length_m));
    xy += std::log(length_m) * std::log(errors.end_m);
  }
  const double count = kLengths_m.size();
  std::printf("# exponent %.2f\n", (count * xy - x * y) / (count * xx - x * x));
}

}  // namespace
}  // namespace waymark

int main(int argc, char** argv) {
  const int seeds = argc > 1 ? std::atoi(argv[1]) : 10;
  const std::string_view camera = argc > 2 ? argv[2] : "drawn";
  if (seeds < 1 || argc > 3 || (camera != "drawn" && camera != "exact")) {
    std::fprintf(stderr, "usage: length_curve [SEEDS [drawn|exact]]\n");
    return 2;
  }
  waymark::print_curve(seeds, camera == "exact");
}
