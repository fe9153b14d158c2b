// SPDX-License-Identifier: BSD-3-Clause
// Prints how the error of waymark grows with the length of the corridor: drives of 25 to 200 m down
// synthetic corridors, markers every 4 m, odometry errors as in the simulator.
//
// usage: length_curve [SEEDS [CAMERA [SURVEY_M]]]
//   SEEDS     default: 10
//   CAMERA    drawn: focal length and mounting are off as much as usual calibrations; exact: they
//             are as configured, with zero prior sigmas. default: drawn
//   SURVEY_M  of the markers on the right, the first one and then one every so many metres are
//             surveyed: to 5 mm, and to 0.005 rad. default: none
// Columns: length [m], RMS over the seeds of: error of the length of the way [m], that per metre,
// error along the way [m], error across [m]. The last line is the exponent b of length^b that fits
// the second column best. Errors are in the frame of the first pose, or in that of the survey.
#include "common/geometry/squared.hpp"
#include "property/slam/estimator_run.hpp"
#include "slam/core/estimators/waymark.hpp"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <string_view>
#include <vector>

namespace waymark {
namespace {

constexpr std::array kLengths_m{25.0, 50.0, 100.0, 200.0};
constexpr double kSpeed_m_s = 0.5;  // a scan per update: quicker to compute than the robot's 0.1

constexpr double kSurvey_m = 0.005;
constexpr double kSurvey_rad = 0.005;

struct Options {
  int seeds{10};
  bool has_exact_camera{false};
  double survey_every_m{0.0};  ///< 0: no survey
};

struct Errors {
  double end_m{0.0};
  double along_m{0.0};
  double across_m{0.0};
};

test::SyntheticCorridor corridor_of(double length_m, const Options& options, std::uint64_t seed) {
  test::SyntheticCorridor corridor;
  corridor.length_m = length_m;
  corridor.drive_m = length_m - 2.0;
  corridor.speed_m_s = kSpeed_m_s;
  corridor.seed = seed;
  corridor.scale_error = seed % 2 == 0 ? -0.01 : 0.01;
  Random random{seed};
  const Eigen::Vector3d estimated = SightingNoise{}.calibration;
  if (!options.has_exact_camera) {
    corridor.camera_focal_error = random.normal(0.0, estimated[SightingNoise::kFocal]);
    corridor.camera_yaw_error_rad = random.normal(0.0, estimated[SightingNoise::kYaw]);
  }
  corridor.markers = test::opposite_markers(corridor);
  return corridor;
}

std::vector<SurveyedMarker> survey_of(const test::SyntheticCorridor& corridor, double every_m,
                                      std::uint64_t seed) {
  std::vector<SurveyedMarker> survey;
  if (every_m <= 0.0) return survey;
  Random random{seed};
  double next_m = 0.0;
  for (std::size_t i = 0; i < corridor.markers.size(); i += 2) {  // they hang in pairs
    const test::SyntheticMarker& marker = corridor.markers[i];
    const double after_first_m = marker.position_m.x() - corridor.markers.front().position_m.x();
    if (after_first_m < next_m) continue;
    next_m += every_m;
    const Se2 measured{marker.position_m.x() + random.normal(0.0, kSurvey_m),
                       marker.position_m.y() + random.normal(0.0, kSurvey_m),
                       marker.yaw_rad + random.normal(0.0, kSurvey_rad)};
    survey.push_back({marker.id, measured, {kSurvey_m, kSurvey_m, kSurvey_rad}, true});
  }
  return survey;
}

/// On line, from the first pose in the frame on.
Errors errors_of(double length_m, const Options& options, std::uint64_t seed) {
  const test::SyntheticCorridor corridor = corridor_of(length_m, options, seed);
  EstimatorSetup setup = test::estimator_setup_of(corridor, seed);
  if (options.has_exact_camera) setup.sighting_noise = test::exact_camera();
  setup.survey = survey_of(corridor, options.survey_every_m, seed);
  WaymarkEstimator estimator{setup, {}};
  const test::SensorLog log = test::drive(corridor);
  const Se2 frame_from_start = setup.survey.empty() ? Se2{} : log.truth.front().world_from_base;
  double end = 0.0;
  double along = 0.0;
  double across = 0.0;
  double count = 0.0;
  for (const test::Step& step : test::run(estimator, log, test::setup_of(corridor))) {
    if (!step.estimate.has_pose) continue;
    const Eigen::Vector2d off =
        step.estimate.map_from_base.translation() - (frame_from_start * step.truth).translation();
    end = off.x();
    along += squared(off.x());
    across += squared(off.y());
    ++count;
  }
  return {end, std::sqrt(along / count), std::sqrt(across / count)};
}

/// Root mean squares over the seeds.
Errors errors_of_seeds(double length_m, const Options& options) {
  Errors sums;
  for (int seed = 1; seed <= options.seeds; ++seed) {
    const Errors errors = errors_of(length_m, options, static_cast<std::uint64_t>(seed));
    sums.end_m += squared(errors.end_m) / options.seeds;
    sums.along_m += squared(errors.along_m) / options.seeds;
    sums.across_m += squared(errors.across_m) / options.seeds;
  }
  return {std::sqrt(sums.end_m), std::sqrt(sums.along_m), std::sqrt(sums.across_m)};
}

void print_curve(const Options& options) {
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  for (const double length_m : kLengths_m) {
    const Errors errors = errors_of_seeds(length_m, options);
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
  waymark::Options options;
  if (argc > 1) options.seeds = std::atoi(argv[1]);
  const std::string_view camera = argc > 2 ? argv[2] : "drawn";
  options.has_exact_camera = camera == "exact";
  if (argc > 3) options.survey_every_m = std::atof(argv[3]);
  if (options.seeds < 1 || argc > 4 || (camera != "drawn" && camera != "exact") ||
      !(options.survey_every_m >= 0.0)) {
    std::fprintf(stderr, "usage: length_curve [SEEDS [drawn|exact [SURVEY_M]]]\n");
    return 2;
  }
  waymark::print_curve(options);
}
