// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/belief/belief.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace waymark {
namespace {

/// [m^2], [rad^2] below this an axis is exact already: nothing is left to draw.
constexpr double kExact = 1e-12;
constexpr double kRelocated_m = 0.5;  // sigma of a pose that is known by one marker only
constexpr double kRelocated_rad = 0.2;

double squared(double x) {
  return x * x;
}

/// The place where a marker is expected from a pose, with the derivatives.
struct Expected {
  Se2 base_from_marker{};
  Eigen::Matrix3d by_pose{Eigen::Matrix3d::Zero()};
  Eigen::Matrix3d by_marker{Eigen::Matrix3d::Identity()};
};

Expected expect(const Se2& map_from_base, const Se2& map_from_marker) {
  Expected expected;
  expected.base_from_marker = map_from_base.inverse() * map_from_marker;
  expected.by_marker.topLeftCorner<2, 2>() = map_from_base.rotation().transpose();
  expected.by_pose = -expected.by_marker;
  // Turning the robot left moves the marker to the right of it.
  expected.by_pose(0, 2) = expected.base_from_marker.y();
  expected.by_pose(1, 2) = -expected.base_from_marker.x();
  return expected;
}

}  // namespace

double Innovation::log_likelihood() const {
  return -0.5 *
         (distance + std::log(covariance.determinant()) + 3.0 * std::log(2.0 * std::numbers::pi));
}

Belief::Belief(const BeliefPrior& prior) : covariance_{Eigen::MatrixXd::Zero(kMarkers, kMarkers)} {
  covariance_(kOdometry, kOdometry) = squared(prior.odometry.scale_sigma);
  covariance_(kOdometry + 1, kOdometry + 1) = squared(prior.odometry.drift_sigma_rad_per_m);
  covariance_(kOdometry + 2, kOdometry + 2) = squared(prior.odometry.turn_scale_sigma);
  covariance_(kOdometry + 3, kOdometry + 3) = squared(prior.odometry.lidar_ahead_sigma_m);
  covariance_(kOdometry + kSpin, kOdometry + kSpin) = squared(prior.odometry.half_track_m);
  covariance_.diagonal().segment<3>(kSighting) = prior.sighting_sigmas.cwiseAbs2();
}

Belief::Prediction Belief::predicted(const Motion& motion, const OdometryNoise& noise) const {
  const CorrectedMotion corrected = corrected_motion(motion, odometry_errors_, noise);
  const Eigen::Matrix3d in_base = corrected.covariance + corrected.by_errors *
                                                             odometry_errors_covariance() *
                                                             corrected.by_errors.transpose();
  return {map_from_base_ * corrected.start_from_end, turned(map_from_base_, in_base)};
}

void Belief::move(const Motion& motion, const OdometryNoise& noise) {
  const CorrectedMotion corrected = corrected_motion(motion, odometry_errors_, noise);
  const Eigen::Matrix3d by_pose =
      carried_along(map_from_base_.rotation() * corrected.start_from_end.translation());
  const MotionByErrors by_errors = turning(map_from_base_) * corrected.by_errors;

  transform_pose(by_pose, by_errors);
  covariance_.topLeftCorner<3, 3>() += turned(map_from_base_, corrected.covariance);
  map_from_base_ = map_from_base_ * corrected.start_from_end;
}

/// The pose deviates by `by_pose` times itself and `by_errors` times the first systematic errors.
void Belief::transform_pose(const Eigen::Matrix3d& by_pose,
                            const Eigen::Ref<const Eigen::MatrixXd>& by_errors) {
  const Eigen::Index errors = by_errors.cols();
  const Eigen::MatrixXd rows =
      by_pose * covariance_.topRows<3>() + by_errors * covariance_.middleRows(kOdometry, errors);
  covariance_.topRows<3>() = rows;
  const Eigen::MatrixXd columns = covariance_.leftCols<3>() * by_pose.transpose() +
                                  covariance_.middleCols(kOdometry, errors) * by_errors.transpose();
  covariance_.leftCols<3>() = columns;
}

void Belief::slip(const Motion& motion, double turn_rad) {
  const Eigen::Vector2d way = motion.start_from_end.translation();
  MotionByErrors by_errors = MotionByErrors::Zero();
  by_errors.col(kSpin).head<2>() =
      std::abs(turn_rad) * (map_from_base_.rotation() * way.normalized());
  transform_pose(Eigen::Matrix3d::Identity(), by_errors);
  map_from_base_ = deviated(map_from_base_, by_errors * odometry_errors_);
}

PoseError Belief::pose_error() const {
  const Eigen::Matrix<double, kStaticErrors, 3> with_pose =
      covariance_.block<kStaticErrors, 3>(kOdometry, 0);
  return {pose_covariance(), errors_covariance().ldlt().solve(with_pose).transpose()};
}

void Belief::widen(const PoseError& more) {
  transform_pose(Eigen::Matrix3d::Identity(), more.by_errors);
  covariance_.topLeftCorner<3, 3>() += positive_part(rest_of(more, errors_covariance()));
}

/// Everything deviates by gain * deviation, and loses gain * covariance_lost * gain'.
void Belief::condition(const Eigen::Ref<const Eigen::MatrixXd>& gain,
                       const Eigen::Ref<const Eigen::VectorXd>& deviation,
                       const Eigen::Ref<const Eigen::MatrixXd>& covariance_lost) {
  const Eigen::VectorXd by = gain * deviation;
  map_from_base_ = deviated(map_from_base_, by.head<3>());
  odometry_errors_ += by.segment<kOdometryErrors>(kOdometry);
  sighting_errors_ += by.segment<3>(kSighting);
  for (std::size_t i = 0; i < active_.size(); ++i) {
    active_[i].map_from_marker = deviated(active_[i].map_from_marker, by.segment<3>(place_of(i)));
  }
  const Eigen::MatrixXd lost = gain * covariance_lost;
  covariance_.noalias() -= lost * gain.transpose();
  covariance_ = (0.5 * (covariance_ + covariance_.transpose())).eval();
}

void Belief::correct_pose(const Se2& map_from_base, const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d before = pose_covariance();
  const Eigen::MatrixXd gain = before.ldlt().solve(covariance_.topRows<3>()).transpose();
  condition(gain, deviation(map_from_base_, map_from_base), before - covariance);
}

void Belief::draw_pose(const PoseAxes& axes, const Eigen::Vector3d& standard_normal) {
  const Eigen::MatrixXd with_axes = covariance_.leftCols<3>() * axes;
  const Eigen::MatrixXd spread = axes.transpose() * with_axes.topRows<3>();
  if (spread.diagonal().minCoeff() < kExact) return;
  const Eigen::LLT<Eigen::MatrixXd> root{spread};
  const Eigen::MatrixXd gain = root.solve(with_axes.transpose()).transpose();
  const OdometryErrors odometry_errors = odometry_errors_;
  const Eigen::Vector3d sighting_errors = sighting_errors_;
  const ErrorsCovariance errors_before = errors_covariance();
  condition(gain, root.matrixL() * standard_normal.head(axes.cols()), spread);
  odometry_errors_ = odometry_errors;
  sighting_errors_ = sighting_errors;
  covariance_.block<kStaticErrors, kStaticErrors>(kOdometry, kOdometry) = errors_before;
}

const std::vector<Landmark>& Belief::settled() const {
  static const std::vector<Landmark> none{};
  return settled_.get() ? *settled_.get() : none;
}

void Belief::correct_sighting_errors(const WallInnovation& wall) {
  correct_sighting_errors(wall.residual - wall.by_errors() * sighting_errors_, wall.by_errors(),
                          wall.covariance);
}

void Belief::correct_sighting_errors(const FocalSighting& focal) {
  correct_sighting_errors(Eigen::VectorXd::Constant(1, focal.error - sighting_errors_.y()),
                          Eigen::RowVector3d::UnitY(),
                          Eigen::MatrixXd::Constant(1, 1, squared(focal.sigma)));
}

void Belief::correct_sighting_errors(const Eigen::VectorXd& residual,
                                     const Eigen::MatrixXd& by_errors,
                                     const Eigen::MatrixXd& covariance) {
  const Eigen::MatrixXd with_residual =
      covariance_.middleCols<3>(kSighting) * by_errors.transpose();
  const Eigen::MatrixXd spread = covariance + by_errors * with_residual.middleRows<3>(kSighting);
  const Eigen::MatrixXd gain = spread.ldlt().solve(with_residual.transpose()).transpose();
  condition(gain, residual, spread);
}

/// In information form the priors' parts, which are about 0, are exchanged, one after the other.
void Belief::widen_prior(const Eigen::Vector3d& from_sigmas, const Eigen::Vector3d& to_sigmas) {
  for (Eigen::Index error = 0; error < from_sigmas.size(); ++error) {
    if (!(to_sigmas[error] > from_sigmas[error] && from_sigmas[error] > 0.0)) continue;
    const Eigen::Index place = kSighting + error;
    const double less = 1.0 / squared(from_sigmas[error]) - 1.0 / squared(to_sigmas[error]);
    const double gain = less / (1.0 - less * covariance_(place, place));
    condition(covariance_.col(place).eval(),
              Eigen::VectorXd::Constant(1, gain * sighting_errors_[error]),
              Eigen::MatrixXd::Constant(1, 1, -gain));
  }
}

/// @param with_residual  out: covariance of everything with what is expected.
Innovation Belief::compare(std::size_t index, const MarkerMeasurement& measurement,
                           Columns& with_residual) const {
  const Landmark& known = marker(index);
  const Expected expected = expect(map_from_base_, known.map_from_marker);
  const Eigen::Matrix3d by_errors =
      measurement.by_errors_at(expected.base_from_marker.translation());
  Innovation innovation;
  innovation.marker = index;
  innovation.by_pose = expected.by_pose;
  innovation.by_marker = expected.by_marker;
  innovation.residual = deviation(expected.base_from_marker, measurement.base_from_marker) -
                        by_errors * sighting_errors_;
  with_residual = covariance_.leftCols<3>() * expected.by_pose.transpose() +
                  covariance_.middleCols<3>(kSighting) * by_errors.transpose();
  innovation.covariance = measurement.covariance;
  if (index < active_.size()) {
    const Eigen::Index place = place_of(index);
    with_residual += covariance_.middleCols<3>(place) * expected.by_marker.transpose();
    innovation.covariance += expected.by_marker * with_residual.middleRows<3>(place);
  } else {
    innovation.covariance += expected.by_marker * known.covariance * expected.by_marker.transpose();
  }
  innovation.covariance += expected.by_pose * with_residual.topRows<3>() +
                           by_errors * with_residual.middleRows<3>(kSighting);
  innovation.distance =
      innovation.residual.dot(innovation.covariance.ldlt().solve(innovation.residual));
  return innovation;
}

std::optional<Innovation> Belief::nearest(const MarkerMeasurement& measurement) const {
  std::optional<Innovation> nearest;
  Columns unused;
  for (std::size_t i = 0; i < num_markers(); ++i) {
    if (marker(i).id != measurement.id) continue;
    const Innovation innovation = compare(i, measurement, unused);
    if (!nearest || innovation.distance < nearest->distance) nearest = innovation;
  }
  return nearest;
}

std::optional<std::size_t> Belief::witness(int id) const {
  std::optional<std::size_t> only;
  for (std::size_t i = 0; i < num_markers(); ++i) {
    if (marker(i).id != id) continue;
    if (only || !marker(i).is_confirmed()) return std::nullopt;
    only = i;
  }
  return only;
}

Se2 Belief::pose_by(std::size_t index, const MarkerMeasurement& measurement) const {
  const Se2 base_from_marker =
      deviated(measurement.base_from_marker, -(measurement.by_errors() * sighting_errors_));
  return marker(index).map_from_marker * base_from_marker.inverse();
}

void Belief::relocate(std::size_t index, const MarkerMeasurement& measurement) {
  relocate(pose_by(index, measurement));
}

void Belief::relocate(const Se2& map_from_base) {
  map_from_base_ = map_from_base;
  covariance_.topRows<3>().setZero();
  covariance_.leftCols<3>().setZero();
  covariance_.topLeftCorner<3, 3>().diagonal() << squared(kRelocated_m), squared(kRelocated_m),
      squared(kRelocated_rad);
}

double Belief::correct(std::size_t index, const MarkerMeasurement& measurement, double gate) {
  if (index >= active_.size()) index = revive(index - active_.size());
  Columns with_residual;
  Innovation innovation = compare(index, measurement, with_residual);
  if (innovation.distance > gate) {
    innovation.covariance *= innovation.distance / gate;
    innovation.distance = gate;
  }
  const Eigen::MatrixXd gain =
      innovation.covariance.ldlt().solve(with_residual.transpose()).transpose();
  condition(gain, innovation.residual, innovation.covariance);
  ++active_[index].sightings;
  active_[index].misses = 0;
  active_[index].last_seen = measurement.time;
  return innovation.log_likelihood();
}

void Belief::add(const MarkerMeasurement& measurement) {
  Landmark fresh;
  fresh.id = measurement.id;
  for (std::size_t i = 0; i < num_markers(); ++i)
    if (marker(i).id == fresh.id) fresh.instance = std::max(fresh.instance, marker(i).instance + 1);
  fresh.sightings = 1;
  fresh.first_seen = measurement.time;
  fresh.last_seen = measurement.time;
  const Se2 base_from_marker =
      deviated(measurement.base_from_marker, -(measurement.by_errors() * sighting_errors_));
  fresh.map_from_marker = map_from_base_ * base_from_marker;

  const Expected expected = expect(map_from_base_, fresh.map_from_marker);
  const Eigen::Matrix3d turn = expected.by_marker.transpose();
  const Eigen::Matrix3d by_pose = -turn * expected.by_pose;
  const Eigen::Matrix3d by_errors = -turn * measurement.by_errors();
  const Columns with_all = covariance_.leftCols<3>() * by_pose.transpose() +
                           covariance_.middleCols<3>(kSighting) * by_errors.transpose();
  const Eigen::Matrix3d own = by_pose * with_all.topRows<3>() +
                              by_errors * with_all.middleRows<3>(kSighting) +
                              turn * measurement.covariance * turn.transpose();
  augment(fresh, with_all, own);
}

PoseByStatics Belief::pose_by_statics(std::size_t most) const {
  std::vector<std::size_t> chosen(active_.size());
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) {
    return active_[a].last_seen > active_[b].last_seen;
  });
  if (chosen.size() > most) chosen.resize(most);

  PoseByStatics by;
  std::vector<Eigen::Index> places(static_cast<std::size_t>(kStaticErrors));
  std::iota(places.begin(), places.end(), kOdometry);
  for (const std::size_t marker : chosen) {
    by.markers.push_back(name_of(active_[marker]));
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      places.push_back(place_of(marker) + axis);
  }
  const Eigen::MatrixXd statics = covariance_(places, places);
  const Eigen::MatrixXd with_pose = covariance_(places, Eigen::seqN(0, 3));
  by.gain = statics.ldlt().solve(with_pose).transpose();
  return by;
}

}  // namespace waymark
