// SPDX-License-Identifier: BSD-3-Clause
// What one particle knows: its pose, the errors of odometry and camera, and the markers, with the
// covariance of all of them together.
#pragma once

#include "slam/core/belief/pose_error.hpp"
#include "slam/core/grid/copy_on_write.hpp"
#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/core/mapping/landmark_map.hpp"
#include "slam/core/proposal/pose_information.hpp"

#include <Eigen/Core>

#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace waymark {

/// A measurement compared with a known marker.
struct Innovation {
  std::size_t marker{0};
  /// Measured minus expected, base frame (x, y, yaw).
  Eigen::Vector3d residual{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d by_pose{Eigen::Matrix3d::Zero()};    ///< of the expected, by (x, y, theta) in map
  Eigen::Matrix3d by_marker{Eigen::Matrix3d::Zero()};  ///< by the marker's (x, y, yaw) in map
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};  ///< of the residual
  double distance{0.0};                                 ///< squared, Mahalanobis

  double distance_m() const { return residual.head<2>().norm(); }

  /// The marker may be the one that was measured: it is where it is expected (chi^2 below `gate`),
  /// or so near that drift or a bad calibration explain it.
  bool may_be_it(double gate, double near_m) const {
    return distance < gate || distance_m() < near_m;
  }

  /// Log of the residual's density.
  double log_likelihood() const;
};

/// What one marker is called: its id, and its instance among those of that id.
using MarkerName = std::pair<int, int>;

inline MarkerName name_of(const Landmark& marker) {
  return {marker.id, marker.instance};
}

/// How the mean of the pose (x, y, theta; map frame) moves with what stays the same: with the
/// errors, then with (x, y, yaw) of the markers named.
struct PoseByStatics {
  std::vector<MarkerName> markers{};
  Eigen::Matrix<double, 3, Eigen::Dynamic> gain{};
};

/// Linear functions of the pose (x, y, theta; map frame), in columns.
using PoseAxes = Eigen::Matrix<double, 3, Eigen::Dynamic>;

/// How a belief begins.
struct BeliefPrior {
  OdometryNoise odometry{};
  /// Standard deviations; order as in Belief::sighting_errors().
  Eigen::Vector3d sighting_sigmas{Eigen::Vector3d::Zero()};
};

/// A Gaussian over (pose, odometry errors, sighting errors, markers), about a mean that is moved
/// with every correction (error-state Kalman filter). Markers that have not been seen for long are
/// settled: they leave the joint covariance with their own, so that it stays small. An id is a
/// class: several markers may have it, told apart by place.
class Belief {
 public:
  explicit Belief(const BeliefPrior& prior);

  const Se2& map_from_base() const { return map_from_base_; }

  /// Order x y theta, map frame.
  Eigen::Matrix3d pose_covariance() const { return covariance_.topLeftCorner<3, 3>(); }

  const OdometryErrors& odometry_errors() const { return odometry_errors_; }

  Eigen::Matrix<double, kOdometryErrors, kOdometryErrors> odometry_errors_covariance() const {
    return covariance_.block<kOdometryErrors, kOdometryErrors>(kOdometry, kOdometry);
  }

  /// What all sightings get wrong in the same way: the camera is mounted `x` [rad] further left
  /// than told, its focal length is 1 + `y` as long, and markers hang `z` [m] before their wall.
  const Eigen::Vector3d& sighting_errors() const { return sighting_errors_; }

  /// Where a motion leads, given where the robot is exactly.
  struct Prediction {
    Se2 map_from_base{};
    Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
  };

  Prediction predicted(const Motion& motion, const OdometryNoise& noise) const;

  void move(const Motion& motion, const OdometryNoise& noise);

  /// The odometry was off by `turn_rad` on that way, for a wheel slipped: the way is off, too.
  void slip(const Motion& motion, double turn_rad);

  PoseError pose_error() const;

  /// The pose may be off by more than was thought: by what the systematic errors have made of it,
  /// and by a rest that is independent of all else.
  void widen(const PoseError& more);

  /// Takes over what has been found about the pose; everything that is correlated with it follows.
  void correct_pose(const Se2& map_from_base, const Eigen::Matrix3d& covariance);

  /// Draws what the axes say of the pose: it is exact from now on, and the rest of the pose and the
  /// markers follow. What is known of the errors of odometry and camera stays as it is: they are
  /// the same for ever, and a few particles that are drawn again and again would soon agree on a
  /// value that nobody measured. Source: Schmidt (1966), "Application of state-space methods to
  /// navigation problems": considered states.
  void draw_pose(const PoseAxes& axes, const Eigen::Vector3d& standard_normal);

  /// Learns what sightings get wrong from what a wall says about one.
  void correct_sighting_errors(const WallInnovation& wall);

  /// The same from the perspective of a marker.
  void correct_sighting_errors(const FocalSighting& focal);

  /// Of the sighting errors, by themselves.
  Eigen::Vector3d sighting_variances() const {
    return covariance_.diagonal().segment<3>(kSighting);
  }

  /// As if the priors of the sighting errors had been wider from the beginning: all that has been
  /// concluded from the narrow ones follows, but for settled markers and drawn poses. What was
  /// exact (0) stays so.
  void widen_prior(const Eigen::Vector3d& from_sigmas, const Eigen::Vector3d& to_sigmas);

  /// The marker of that id that fits best; nothing when none is known.
  std::optional<Innovation> nearest(const MarkerMeasurement& measurement) const;

  /// The marker of that id, if there is exactly one and it is confirmed.
  std::optional<std::size_t> witness(int id) const;

  /// Where the robot is if the measurement is of that marker.
  Se2 pose_by(std::size_t marker, const MarkerMeasurement& measurement) const;

  /// Puts the robot there. The pose is all but unknown afterwards and has nothing to do with what
  /// was known before: the measurement is still to be used.
  void relocate(std::size_t marker, const MarkerMeasurement& measurement);

  /// The same to a given pose.
  void relocate(const Se2& map_from_base);

  /// The robot is off by a step in its own frame, which is known as well as it is itself.
  void step(const Se2& base_from_there) { map_from_base_ = map_from_base_ * base_from_there; }

  /// Markers that were first seen after that are no longer known, settled or not.
  void forget_since(Timestamp time);

  /// Kalman update with a measurement of a known marker. One that is off by more than the gate
  /// counts as much less.
  /// @param gate  chi^2, 3 degrees of freedom.
  /// @return log-likelihood of the measurement.
  double correct(std::size_t marker, const MarkerMeasurement& measurement, double gate);

  /// A marker that was not known.
  void add(const MarkerMeasurement& measurement);

  /// Counts, for each marker that should be in view and was not sighted, one more miss. A marker
  /// that was missed often while another one of its id has turned up later has been moved there:
  /// the old place is forgotten.
  /// @param is_in_view  for a place and the direction that it faces, base frame.
  void note_absences(const std::function<bool(const Se2& base_from_marker)>& is_in_view,
                     Timestamp now);

  /// Settles the markers that were seen longest ago while more than `limit` are in the covariance.
  void settle_oldest(std::size_t limit);

  ErrorsCovariance errors_covariance() const {
    return covariance_.block<kStaticErrors, kStaticErrors>(kOdometry, kOdometry);
  }

  StaticErrors static_errors() const {
    return (StaticErrors{} << odometry_errors_, sighting_errors_).finished();
  }

  /// By the errors and the `most` markers that were seen last.
  PoseByStatics pose_by_statics(std::size_t most) const;

  /// In order of their first sighting, with their marginal covariances.
  std::vector<Landmark> markers() const;

 private:
  static constexpr Eigen::Index kOdometry = 3;
  static constexpr Eigen::Index kSighting = kOdometry + kOdometryErrors;
  static constexpr Eigen::Index kMarkers = kOdometry + kStaticErrors;

  static Eigen::Index place_of(std::size_t marker) {
    return kMarkers + 3 * static_cast<Eigen::Index>(marker);
  }

  /// All columns' covariance with a residual's parts.
  using Columns = Eigen::Matrix<double, Eigen::Dynamic, 3>;

  std::size_t num_markers() const { return active_.size() + settled().size(); }

  const Landmark& marker(std::size_t index) const {
    return index < active_.size() ? active_[index] : settled()[index - active_.size()];
  }

  const std::vector<Landmark>& settled() const;
  void correct_sighting_errors(const Eigen::VectorXd& residual, const Eigen::MatrixXd& by_errors,
                               const Eigen::MatrixXd& covariance);
  Innovation compare(std::size_t marker, const MarkerMeasurement& measurement,
                     Columns& with_residual) const;
  void transform_pose(const Eigen::Matrix3d& by_pose,
                      const Eigen::Ref<const Eigen::MatrixXd>& by_errors);
  void condition(const Eigen::Ref<const Eigen::MatrixXd>& gain,
                 const Eigen::Ref<const Eigen::VectorXd>& deviation,
                 const Eigen::Ref<const Eigen::MatrixXd>& covariance_lost);
  void augment(const Landmark& landmark, const Columns& with_all, const Eigen::Matrix3d& own);
  std::size_t revive(std::size_t settled_marker);
  void settle(std::size_t marker);
  Landmark& editable(std::size_t marker);
  void remove_active(std::size_t marker);
  void forget_moved();

  Se2 map_from_base_{};
  OdometryErrors odometry_errors_{OdometryErrors::Zero()};
  Eigen::Vector3d sighting_errors_{Eigen::Vector3d::Zero()};
  std::vector<Landmark> active_{};  ///< their covariances are in `covariance_`
  CopyOnWrite<std::vector<Landmark>> settled_{};
  Eigen::MatrixXd covariance_;
};

}  // namespace waymark
