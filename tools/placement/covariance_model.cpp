// SPDX-License-Identifier: BSD-3-Clause
#include "placement/covariance_model.hpp"

#include "common/geometry/principal_axes.hpp"
#include "common/geometry/se2.hpp"
#include "placement/keyframe_schedule.hpp"
#include "placement/pose_covariance.hpp"
#include "slam/core/estimators/waymark.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::placement {
namespace {

constexpr double kInFront_m = 0.15;  // a line of sight ends this far before the marker's own wall

Variable pose_of_step(std::size_t step) {
  return {VariableKind::kKeyframe, step};
}

Variable landmark(std::size_t marker) {
  return {VariableKind::kLandmark, marker};
}

/// The part of odometry's variance per metre that depends on the learnt noise scale.
double along_m2_per_m(const OdometryNoise& noise, const LearntOdometryNoise& scale,
                      double hidden_slips) {
  const double rolling = scale.along * noise.along_per_sqrt_m;
  return rolling * rolling + hidden_slips * scale.slip_m2_per_m;
}

void drive_step(const Se2& before, const Step& step, const OdometryNoise& described,
                const LearntOdometryNoise& scale, double hidden_slips, PoseCovariance& known) {
  LearntOdometryNoise slips = scale;
  slips.slip_per_m = 0.0;
  const CorrectedMotion moved =
      with_slips(corrected_motion(step.motion, OdometryErrors::Zero(), scaled(described, scale)),
                 step.motion.distance_m, hidden_slips, slips);
  Eigen::Matrix<double, 3, kCalibrationSize> jacobian_calibration =
      Eigen::Matrix<double, 3, kCalibrationSize>::Zero();
  jacobian_calibration.leftCols<kOdometryTerms>() =
      block_rotation(before.rotation()) * moved.jacobian_calibration;
  known.move(lever_arm_jacobian(step.map_from_base.translation() - before.translation()),
             jacobian_calibration, in_axes(before.rotation(), moved.covariance));
}

/// @param keyframes  variable of each keyframe index that the factor uses.
std::vector<PoseCovariance::Block> blocks_of(const LinearFactor& linear,
                                             const std::vector<Variable>& keyframes,
                                             const Variable& marker, double root_weight) {
  std::vector<PoseCovariance::Block> blocks;
  for (const LinearFactor::Block& block : linear.blocks) {
    Variable variable = PoseCovariance::kCalibration;
    if (block.variable.kind == VariableKind::kKeyframe) variable = keyframes[block.variable.index];
    if (block.variable.kind == VariableKind::kLandmark) variable = marker;
    blocks.push_back({variable, root_weight * block.jacobian});
  }
  return blocks;
}

using References = std::vector<std::pair<std::size_t, double>>;

void match_scan_of(std::span<const Step> steps, std::size_t now, const References& references,
                   double keyframes, PoseCovariance& known) {
  if (references.empty() || !(keyframes > 0.0)) return;
  State state;
  std::vector<Variable> variables;
  ScanFactor factor;
  for (const auto& [step, share] : references) {
    factor.references.push_back(
        {variables.size(), share, steps[step].map_from_base.inverse() * steps[now].map_from_base});
    state.keyframes.push_back(steps[step].map_from_base);
    variables.push_back(pose_of_step(step));
  }
  factor.keyframe = variables.size();
  factor.root_information = root_of(steps[now].observed.information);
  state.keyframes.push_back(steps[now].map_from_base);
  variables.push_back(PoseCovariance::kPose);
  known.measure(blocks_of(factor.linearise(state), variables, {}, std::sqrt(keyframes)));
}

/// Updates the calibration with what a view of a marker observes of it, by the wall that the LiDAR
/// measures.
void learn_calibration(const MarkerMeasurement& measured, double keyframes, PoseCovariance& known) {
  const double root_weight = std::sqrt(keyframes);
  if (measured.wall) {
    const Eigen::LLT<Eigen::Matrix2d> root{measured.wall->covariance};
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(2, kCalibrationSize);
    rows.rightCols<kCameraTerms>() =
        root_weight * root.matrixL().solve(measured.wall->jacobian_calibration());
    known.measure({{PoseCovariance::kCalibration, rows}});
  }
}

void see_marker(const Step& step, const StepSighting& sighting, PoseCovariance& known) {
  const MarkerMeasurement& measured = sighting.view->measurement;
  learn_calibration(measured, sighting.keyframes, known);
  MarkerFactor factor;
  factor.measurement = measured;
  factor.root_information = root_of(measured.covariance.inverse());
  State state;
  state.keyframes = {step.map_from_base};
  state.landmarks = {step.map_from_base * measured.base_from_marker};
  const LinearFactor linear = factor.linearise(state, std::numeric_limits<double>::infinity());
  const Variable marker = landmark(sighting.marker);
  std::vector<PoseCovariance::Block> blocks =
      blocks_of(linear, {PoseCovariance::kPose}, marker, std::sqrt(sighting.keyframes));
  if (known.has(marker)) {
    known.measure(blocks);
    return;
  }
  const auto own = std::find_if(blocks.begin(), blocks.end(),
                                [&](const auto& block) { return block.variable == marker; });
  const Eigen::Matrix3d solve = Eigen::Matrix3d{own->jacobian}.inverse();
  blocks.erase(own);
  for (PoseCovariance::Block& block : blocks)
    block.jacobian = -solve * block.jacobian;
  known.add(marker, blocks, solve * solve.transpose());
}

/// For each step, the last step that refers to its pose; its own index if none does.
std::vector<std::size_t> last_uses(const std::vector<StepPlan>& plan) {
  std::vector<std::size_t> last(plan.size());
  for (std::size_t i = 0; i < plan.size(); ++i) {
    last[i] = i;
    for (const auto& [step, share] : plan[i].submap)
      last[step] = i;
    if (plan[i].loop) last[*plan[i].loop] = i;
  }
  return last;
}

}  // namespace

double sigma_along(const Eigen::Matrix3d& covariance, const Eigen::Vector2d& axis) {
  const Eigen::Matrix2d position = covariance.topLeftCorner<2, 2>();
  if (!axis.isZero()) return std::sqrt(std::max(0.0, axis.dot(position * axis)));
  const PrincipalAxes axes = principal_axes(position);
  return std::sqrt(std::max(0.0, axes.values[1]));
}

Sightings sightings_along(std::span<const Step> steps, const Se2& map_from_marker,
                          const OccupiedWalls& walls, const ViewModel& views) {
  Sightings sightings;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    const Se2 base_from_marker = step.map_from_base.inverse() * map_from_marker;
    const double away_m = base_from_marker.translation().norm();
    if (away_m > views.reach_m()) continue;
    const auto view = views.view(base_from_marker, step.hits, step.speed_mps);
    if (!view) continue;
    const Eigen::Vector2d there = map_from_marker.translation() - step.map_from_base.translation();
    const Eigen::Vector2d stop =
        there + kInFront_m * map_from_marker.rotation().col(0);  // before its wall
    if (walls.first_hit(step.map_from_base.translation(), stop.normalized(), stop.norm())) continue;
    sightings.push_back({i, *view});
  }
  return sightings;
}

CovarianceModel::CovarianceModel(std::span<const Step> steps, const SlamConfig& config)
    : steps_{steps}, config_{config}, setup_{estimator_setup(config)} {
  config_.slam.waymark.odometry.half_track_m = setup_.half_track_m;
}

std::vector<Eigen::Matrix3d> CovarianceModel::predict(
    std::span<const Sightings* const> markers) const {
  const OdometryNoise& odometry = config_.slam.waymark.odometry;
  PoseCovariance known{calibration_sigmas(setup_, config_.slam.waymark), kFirstPoseSigma};

  const std::vector<StepPlan> plan = plan_keyframes(steps_, markers, config_);
  const std::vector<std::size_t> last_use = last_uses(plan);
  std::vector<std::size_t> kept;
  std::vector<Eigen::Matrix3d> covariances;
  double unfixed_m2 = 0.0;  // variance by the noise scale known now minus that by the later one
  for (std::size_t i = 0; i < steps_.size(); ++i) {
    const Step& step = steps_[i];
    const StepPlan& now = plan[i];
    if (i > 0) {
      const LearntOdometryNoise& later = plan[now.leaves_window].noise;
      drive_step(steps_[i - 1].map_from_base, step, odometry, later, now.hidden_slips, known);
      match_scan_of(steps_, i, now.submap, now.keyframes, known);
      if (now.loop) match_scan_of(steps_, i, {{*now.loop, 1.0}}, 1.0, known);
      const double more = along_m2_per_m(odometry, now.noise, now.hidden_slips) -
                          along_m2_per_m(odometry, later, now.hidden_slips);
      unfixed_m2 = now.shows_way ? 0.0 : unfixed_m2 + std::max(0.0, more) * step.motion.distance_m;
    }
    for (const StepSighting& sighting : now.sightings)
      if (sighting.keyframes > 0.0) see_marker(step, sighting, known);
    Eigen::Matrix3d covariance = known.of_pose();
    const Eigen::Vector2d ahead = step.map_from_base.rotation().col(0);
    covariance.topLeftCorner<2, 2>() += unfixed_m2 * ahead * ahead.transpose();
    covariances.push_back(covariance);
    if (last_use[i] > i) {
      known.add(pose_of_step(i), {{PoseCovariance::kPose, Eigen::Matrix3d::Identity()}},
                Eigen::Matrix3d::Zero());
      kept.push_back(i);
    }
    std::erase_if(kept, [&](std::size_t old) {
      if (last_use[old] > i) return false;
      known.drop(pose_of_step(old));
      return true;
    });
  }
  return covariances;
}

std::vector<double> CovarianceModel::sigmas_m(std::span<const Eigen::Matrix3d> covariances) const {
  std::vector<double> sigmas;
  for (std::size_t i = 0; i < covariances.size(); ++i)
    sigmas.push_back(sigma_along(covariances[i], steps_[i].weak_axis));
  return sigmas;
}

}  // namespace waymark::placement
