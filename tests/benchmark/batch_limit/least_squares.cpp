// SPDX-License-Identifier: BSD-3-Clause
#include "batch_limit/least_squares.hpp"

#include "batch_limit/residuals.hpp"

#include <algorithm>

namespace waymark::benchmark {
namespace {

constexpr double kOutlierSigmas = 4.0;  // residuals beyond count linearly
constexpr int kRounds = 2;              // the derivatives by odometry errors are taken anew
constexpr int kMaxIterations = 100;
constexpr double kExact = 1e-7;  // stands for a standard deviation of zero

std::array<double, 3> values_of(const Se2& pose) {
  return {pose.x(), pose.y(), pose.theta()};
}

Se2 pose_of(const std::array<double, 3>& values) {
  return {values[0], values[1], values[2]};
}

/// The unknowns in the form that Ceres edits, and the problem over them.
class Batch {
 public:
  Batch(std::span<const Stop> stops, const BatchSolution& start, const BatchModel& model)
      : stops_{stops}, solution_{start} {
    for (const Se2& pose : start.scene.map_from_base)
      poses_.push_back(values_of(pose));
    for (const Marker& marker : start.scene.markers)
      markers_.push_back(values_of(marker.map_from_marker));
    add_motions(model.odometry);
    add_walls(model.straight_over_m);
    add_markers();
    add_hanging(model);
    add_priors(model);
    problem_.SetParameterBlockConstant(poses_.front().data());
  }

  BatchSolution solve() {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
    options.max_num_iterations = kMaxIterations;
    options.function_tolerance = 1e-10;
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem_, &summary);
    solution_.has_converged = summary.termination_type == ceres::CONVERGENCE;
    solution_.report = summary.BriefReport();
    solution_.chi2 = 2.0 * summary.final_cost;
    solution_.residuals = static_cast<std::size_t>(problem_.NumResiduals());
    take_over();
    return solution_;
  }

 private:
  template <class Residual, int kResiduals, int... kBlocks>
  void add(const Residual& residual, ceres::LossFunction* loss, auto*... blocks) {
    problem_.AddResidualBlock(
        new ceres::AutoDiffCostFunction<Residual, kResiduals, kBlocks...>(new Residual(residual)),
        loss, blocks...);
  }

  static ceres::LossFunction* robust() { return new ceres::HuberLoss(kOutlierSigmas); }

  void add_motions(const OdometryNoise& noise) {
    for (std::size_t i = 1; i < stops_.size(); ++i) {
      const CorrectedMotion motion =
          corrected_motion(stops_[i].motion, solution_.odometry_errors, noise);
      add<MotionResidual, 3, 3, 3, kOdometryTerms>(
          {motion, solution_.odometry_errors, whitening(motion.covariance)}, nullptr,
          poses_[i - 1].data(), poses_[i].data(), solution_.odometry_errors.data());
    }
  }

  /// Each line in the parts that lie on one piece of its wall each, as far as is known before.
  void add_walls(double piece_m) {
    for (const Link& link : solution_.scene.wall_links) {
      const LineOfScan& line = stops_[link.stop].lines[link.measurement];
      const Se2 map_from_base = pose_of(poses_[link.stop]);
      Wall& wall = solution_.scene.walls[link.landmark];
      const auto piece_of = [&](std::size_t point) {
        return wall.piece_at(map_from_base * line.points[point].end, piece_m);
      };
      for (std::size_t from = 0, to = 0; from < line.points.size(); from = to) {
        const int piece = piece_of(from);
        while (to < line.points.size() && piece_of(to) == piece)
          ++to;
        add<WallResidual, 2, 3, 1, 1>({line.part(from, to), {wall, piece, piece_m}}, robust(),
                                      poses_[link.stop].data(), &wall.knots_m[piece],
                                      &wall.knots_m[piece + 1]);
      }
    }
  }

  void add_markers() {
    double* const camera = solution_.camera_errors.data();
    for (const Link& link : solution_.scene.marker_links) {
      const MarkerMeasurement& measurement = stops_[link.stop].markers[link.measurement];
      add<MarkerResidual, 3, 3, 3, 2>({measurement, whitening(measurement.covariance)}, robust(),
                                      poses_[link.stop].data(), markers_[link.landmark].data(),
                                      camera);
    }
  }

  void add_hanging(const BatchModel& model) {
    for (std::size_t i = 0; i < markers_.size(); ++i) {
      const Marker& marker = solution_.scene.markers[i];
      if (!marker.wall) continue;
      Wall& wall = solution_.scene.walls[*marker.wall];
      const int piece = wall.piece_at(marker.map_from_marker.translation(), model.straight_over_m);
      add<HangingResidual, 2, 3, 1, 1, 1>({{wall, piece, model.straight_over_m},
                                           std::max(model.sightings.bulge_m, kExact),
                                           model.sightings.skew_rad},
                                          robust(), markers_[i].data(), &wall.knots_m[piece],
                                          &wall.knots_m[piece + 1], &solution_.standoff_m);
    }
  }

  void add_priors(const BatchModel& model) {
    const OdometryNoise& odometry = model.odometry;
    add<PriorResidual<kOdometryTerms>, kOdometryTerms, kOdometryTerms>(
        {{odometry.scale_sigma, odometry.drift_sigma_rad_per_m, odometry.turn_scale_sigma,
          odometry.lidar_ahead_sigma_m, odometry.lidar_yaw_sigma_rad}},
        nullptr, solution_.odometry_errors.data());
    add<PriorResidual<2>, 2, 2>(
        {{std::max(model.sightings.calibration[SightingNoise::kYaw], kExact),
          std::max(model.sightings.calibration[SightingNoise::kFocal], kExact)}},
        nullptr, solution_.camera_errors.data());
    add<PriorResidual<1>, 1, 1>(
        {{std::max(model.sightings.calibration[SightingNoise::kStandoff], kExact)}}, nullptr,
        &solution_.standoff_m);
  }

  void take_over() {
    Scene& scene = solution_.scene;
    for (std::size_t i = 0; i < poses_.size(); ++i)
      scene.map_from_base[i] = pose_of(poses_[i]);
    for (std::size_t i = 0; i < markers_.size(); ++i)
      scene.markers[i].map_from_marker = pose_of(markers_[i]);
  }

  std::span<const Stop> stops_;
  BatchSolution solution_;  ///< systematic errors and walls are edited in place
  std::vector<std::array<double, 3>> poses_{};
  std::vector<std::array<double, 3>> markers_{};
  ceres::Problem problem_{};
};

}  // namespace

BatchSolution solve(std::span<const Stop> stops, const BatchModel& model) {
  BatchSolution solution;
  solution.scene = associate(stops, model.odometry, model.same_marker_within_m);
  for (int round = 0; round < kRounds; ++round)
    solution = Batch{stops, solution, model}.solve();
  return solution;
}

}  // namespace waymark::benchmark
