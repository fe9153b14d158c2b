// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/scan_match.hpp"

#include "common/geometry/median.hpp"
#include "common/geometry/principal_axes.hpp"
#include "common/geometry/squared.hpp"
#include "slam/core/registration/points_in_map.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>

namespace waymark {
namespace {

constexpr double kBlurStep = 1.0 / 3.0;  // factor from one stage to the next finer one
constexpr double kFinestBlur_m = 0.01;   // a smaller blur is left out
constexpr int kStepsPerStage = 3;
constexpr int kFinalSteps = 6;
constexpr double kConverged = 2e-5;    // metres or radians
constexpr double kMaxBlur_m = 0.25;    // no more than half of a cell
constexpr double kPartsBlur_m = 0.06;  // less than the distance of parts; above it, whole cells
constexpr double kReachOfCell = 0.5;   // of a level's spacing; a more certain guess skips the level
constexpr double kConvergedCoarse = 1e-3;
constexpr double kInlierWeight = 0.25;  // robust weight at the kernel's width
// Settled walls: cells that this many keyframes have seen, or of a loaded map. As many scans were
// compared with them, and a cell's error is common to all of these, so each counts as a part of an
// observation only.
constexpr int kSettledKeyframes = 10;
constexpr double kAlongWeak = 0.98;  // cosine of the angle to the weak direction

// Added to the guess's sigmas in the descent. The guess chooses among optima some centimetres
// apart. If it were believed more, the match would stop short of the optimum, agree with odometry
// by construction, and odometry would count twice.
const Eigen::Vector3d kDescentAdded{0.03, 0.03, 0.01};  // [m, m, rad]

// In the last step the guess's sigmas are multiplied by the first, then the second is added.
constexpr double kGuessFactor = 10.0;
const Eigen::Vector3d kGuessAdded{0.2, 0.2, 0.1};  // [m, m, rad]

// Noise of ranges.
constexpr int kWellSeen = 20;      // least number of points in a cell
constexpr double kSquareOn = 0.5;  // least cosine of a beam's angle of incidence

void summarise(std::span<const Eigen::Vector2d> points, const NdtMap& map, double point_variance_m2,
               const ScanMatchConfig& config, ScanMatch& match) {
  int mapped = 0;
  match.inliers = 0;
  match.settled_inliers = 0;
  std::map<int, double> shares;
  std::vector<double> off_range_m;
  const Eigen::Matrix2d rotation = match.map_from_base.rotation();
  for (const Eigen::Vector2d& point : points) {
    const Eigen::Vector2d ray = rotation * point;
    const Eigen::Vector2d there = ray + match.map_from_base.translation();
    const NdtCell* cell = map.at(there, point_variance_m2);
    if (cell == nullptr) continue;
    ++mapped;
    const BeamTerm term = compare(*cell, there, ray, point_variance_m2, 0.0, config);
    const double square_on = std::abs(cell->normal.dot(ray.normalized()));
    if (cell->is_line && cell->count >= kWellSeen && square_on > kSquareOn)
      off_range_m.push_back(std::abs(term.across_m) / square_on);
    if (term.robust < kInlierWeight) continue;
    ++match.inliers;
    const int keyframes = num_keyframes(*cell);
    if (keyframes == 0 || keyframes >= kSettledKeyframes) ++match.settled_inliers;
    if (keyframes == 0) continue;
    for (int k = cell->first_keyframe; k <= cell->last_keyframe; ++k)
      shares[k] += 1.0 / keyframes;
  }
  match.num_mapped = mapped;
  match.num_scattered = static_cast<int>(off_range_m.size());
  if (!off_range_m.empty())
    match.range_scatter_m = kSigmaOfMad * upper_median(std::move(off_range_m));
  match.mapped_share = points.empty() ? 0.0 : mapped / static_cast<double>(points.size());
  match.inlier_share = mapped == 0 ? 0.0 : match.inliers / static_cast<double>(mapped);
  if (shares.empty()) return;
  match.first_keyframe = shares.begin()->first;
  match.keyframe_shares.assign(
      static_cast<std::size_t>(shares.rbegin()->first - match.first_keyframe + 1), 0.0);
  for (const auto& [keyframe, share] : shares)
    match.keyframe_shares[static_cast<std::size_t>(keyframe - match.first_keyframe)] =
        share / match.inliers;
}

Eigen::Vector3d along_observed(Eigen::Vector3d gradient, const ObservedAxes& observed) {
  if (!observed.is_degenerate) return gradient;
  const Eigen::Vector2d& weak = observed.weak_direction;
  gradient.head<2>() -= weak * weak.dot(gradient.head<2>());
  return gradient;
}

/// Gauss-Newton on the cost of the walls and of the guess as a prior; walls have no effect along
/// unobserved directions.
class Descent {
 public:
  Descent(const Se2& guess, const Eigen::Matrix3d& guess_covariance, const ScanMatchConfig& config)
      : guess_{guess}, guess_information_{guess_covariance.inverse()}, config_{config} {}

  /// @return the pose after at most `steps` steps.
  Se2 from(Se2 pose, PointsInMap& points, double blur_m, int steps, double converged) const {
    for (int i = 0; i < steps; ++i) {
      const Quadratic model = points.quadratic_about(pose, squared(blur_m), config_);
      const ObservedAxes observed = observed_axes(model.information, config_.weak_share);
      const Eigen::Vector3d off = pose_difference(pose, guess_);
      const Eigen::Vector3d step =
          -(observed.information + guess_information_)
               .ldlt()
               .solve(along_observed(model.gradient, observed) + guess_information_ * off);
      pose = moved_by(pose, step);
      if (step.cwiseAbs().maxCoeff() < converged) break;
    }
    return pose;
  }

 private:
  Se2 guess_;
  Eigen::Matrix3d guess_information_;
  const ScanMatchConfig& config_;
};

/// A covariance with its standard deviations multiplied by a factor, plus some more.
Eigen::Matrix3d widened(const Eigen::Matrix3d& covariance, double factor,
                        const Eigen::Vector3d& added_sigmas) {
  Eigen::Matrix3d wide = squared(factor) * covariance;
  wide.diagonal() += added_sigmas.cwiseAbs2();
  return wide;
}

/// Information that keeps the pose in unobserved directions and has little effect in the others.
/// Not less information, so that the step stays small enough for the quadratic model.
Eigen::Matrix3d nearly_none(const Eigen::Matrix3d& guess_covariance) {
  return widened(guess_covariance, kGuessFactor, kGuessAdded).inverse();
}

/// Standard deviation [m] of the beams' ends, across the beams, due to the covariance of the pose:
/// root mean square over all beams; position and heading count as uncorrelated.
double beam_end_sigma_m(std::span<const Eigen::Vector2d> points_in_base,
                        const Eigen::Matrix3d& covariance) {
  double lever2_m2 = 0.0;
  for (const Eigen::Vector2d& point : points_in_base)
    lever2_m2 += point.squaredNorm();
  if (!points_in_base.empty()) lever2_m2 /= static_cast<double>(points_in_base.size());
  return std::sqrt(0.5 * covariance.topLeftCorner<2, 2>().trace() + lever2_m2 * covariance(2, 2));
}

}  // namespace

bool ObservedAxes::is_along_weak(const Eigen::Vector2d& shift) const {
  return is_degenerate && std::abs(weak_direction.dot(shift)) >= kAlongWeak * shift.norm();
}

/// What stays is the marginal information about the other axes: a Schur complement.
void ObservedAxes::drop_information_along(const Eigen::Vector2d& direction) {
  const Eigen::Vector3d axis{direction.x(), direction.y(), 0.0};
  const Eigen::Vector3d column = information * axis;
  information -= (column * column.transpose() / axis.dot(column)).eval();
  weak_direction = direction;
  is_degenerate = true;
}

ObservedAxes observed_axes(const Eigen::Matrix3d& information, double weak_share) {
  ObservedAxes observed;
  observed.information = information;
  const PrincipalAxes axes = principal_axes(information.topLeftCorner<2, 2>());
  observed.weak_direction = axes.directions.col(0);
  observed.is_degenerate = axes.values[0] <= weak_share * axes.values[1];
  if (!observed.is_degenerate) return observed;
  Eigen::Matrix3d keep = Eigen::Matrix3d::Identity();
  keep.topLeftCorner<2, 2>() -= observed.weak_direction * observed.weak_direction.transpose();
  observed.information = keep * information * keep;
  return observed;
}

ScanMatch match_scan(std::span<const Eigen::Vector2d> points_in_base, const NdtMap& map,
                     const Se2& guess, const Eigen::Matrix3d& guess_covariance,
                     const RangeNoise& noise, const ScanMatchConfig& config,
                     std::span<const NdtMap> coarse) {
  const double point_variance_m2 = noise.variance_m2();
  const double guess_sigma_m = beam_end_sigma_m(points_in_base, guess_covariance);
  const Descent descent{guess, widened(guess_covariance, 1.0, kDescentAdded), config};
  ScanMatch match;
  match.map_from_base = guess;
  for (auto level = coarse.rbegin(); level != coarse.rend(); ++level) {
    if (guess_sigma_m < kReachOfCell * level->spacing_m()) continue;
    PointsInMap points{points_in_base, *level, point_variance_m2, false};
    match.map_from_base =
        descent.from(match.map_from_base, points, std::min(level->spacing_m(), guess_sigma_m),
                     kStepsPerStage, kConvergedCoarse);
  }
  double blur_m = std::min(kMaxBlur_m, guess_sigma_m);
  if (blur_m > kPartsBlur_m) {
    PointsInMap whole_cells{points_in_base, map, point_variance_m2, false};
    for (; blur_m > kPartsBlur_m; blur_m *= kBlurStep)
      match.map_from_base =
          descent.from(match.map_from_base, whole_cells, blur_m, kStepsPerStage, kConverged);
  }
  PointsInMap points{points_in_base, map, point_variance_m2, true};
  for (; blur_m >= kFinestBlur_m; blur_m *= kBlurStep)
    match.map_from_base =
        descent.from(match.map_from_base, points, blur_m, kStepsPerStage, kConverged);
  match.map_from_base = descent.from(match.map_from_base, points, 0.0, kFinalSteps, kConverged);
  // One step towards the optimum almost without the guess, in observed directions.
  const Quadratic model = points.quadratic_about(match.map_from_base, 0.0, config);
  match.observed = observed_axes(model.information, config.weak_share);
  const Eigen::Vector3d gradient = along_observed(model.gradient, match.observed);
  match.map_from_base = moved_by(
      match.map_from_base,
      -(match.observed.information + nearly_none(guess_covariance)).ldlt().solve(gradient));
  summarise(points_in_base, map, point_variance_m2, config, match);
  return match;
}

ScanMatch with_settled_walls(ScanMatch match, std::span<const Eigen::Vector2d> points_in_base,
                             const NdtMap& map, const Eigen::Matrix3d& guess_covariance,
                             const RangeNoise& noise, const ScanMatchConfig& config) {
  if (!match.observed.is_degenerate) return match;
  const double point_variance_m2 = noise.variance_m2();
  const Eigen::Vector2d weak = match.observed.weak_direction;
  const Eigen::Vector3d along{weak.x(), weak.y(), 0.0};
  const double guess_m2 =
      squared(kDescentAdded.x()) + weak.dot(guess_covariance.topLeftCorner<2, 2>() * weak);
  PointsInMap points{points_in_base, map, point_variance_m2, true};
  const auto moved_along = [&](double shift_m) {
    return moved_by(match.map_from_base, shift_m * along);
  };
  double shift_m = 0.0;
  double settled = 0.0;  // information of settled walls
  for (int i = 0; i < kFinalSteps; ++i) {
    const Quadratic model =
        points.quadratic_about(moved_along(shift_m), 0.0, config, kSettledKeyframes);
    settled = along.dot(model.information * along);
    const double step_m =
        -(along.dot(model.gradient) + shift_m / guess_m2) / (settled + 1.0 / guess_m2);
    shift_m += step_m;
    if (std::abs(step_m) < kConverged) break;
  }
  // Less is noise of the walls' normals, of which the mean over many keyframes has less.
  const double across = match.observed.information.topLeftCorner<2, 2>().trace();
  if (settled <= config.weak_share / kSettledKeyframes * across) return match;
  const double information = settled / kSettledKeyframes;
  match.map_from_base = moved_along(shift_m);
  match.observed.information.topLeftCorner<2, 2>() += information * weak * weak.transpose();
  summarise(points_in_base, map, point_variance_m2, config, match);
  return match;
}

}  // namespace waymark
