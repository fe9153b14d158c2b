// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/camera/camera_calibration.hpp"

#include "common/geometry/squared.hpp"
#include "slam/core/landmark/marker_measurement.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

namespace waymark {
namespace {

/// The estimated parameters. The last two, remaining scale errors of odometry, are nuisance
/// parameters.
enum Term : Eigen::Index { kFocal, kSize, kYaw, kLate, kDistance, kTurn, kTerms };

using Errors = Eigen::Matrix<double, kTerms, 1>;
using Information = Eigen::Matrix<double, kTerms, kTerms>;

/// Far wider than errors in practice, so that only unobservable terms keep the prior.
const Eigen::Vector4d kPriorSigmas{0.3, 0.3, 0.3, 1.0};           // relative, relative, rad, s
constexpr std::array kSteps{1e-4, 1e-4, 1e-4, 1e-3, 1e-4, 1e-4};  // for numerical derivatives
constexpr double kSlowStep_s = 0.25;  // about the time that a robot takes to start or stop turning
// Upper bound of the prior sigma of odometry's scales in the fit. With a wider one, the noise of
// distances would shrink the scale and the focal length together (errors in variables). The part of
// the scales' variances beyond this bound is added to the variances of the result.
constexpr double kWidestScalePrior = 0.001;
constexpr int kIterations = 8;
constexpr double kCutoff = 3.0;  // kernel width of the robust weights, in sigmas
constexpr int kMinTracks = 4;
constexpr double kMaxPause_s = 2.0;  // between consecutive sightings of a track
constexpr double kMinApart_m = 0.3;  // between the two sightings of a pair
constexpr double kTurnedEnough_rad = 0.15;
constexpr double kNearestScan_s = 0.15;
constexpr double kWallReach_m = 1.5;
// Random walk of a TurtleBot3's odometry; it only affects the weights of the residuals.
constexpr double kWalk_m2_per_m = 9e-6;
constexpr double kWalk_rad2_per_m = 7.6e-5;
constexpr double kWalk_rad2_per_rad = 1e-4;

/// Contribution of one track to the normal equations.
struct TrackEquations {
  Information information{Information::Zero()};
  Errors slope{Errors::Zero()};
};

/// A residual of one or two rows as a function of the errors, with the information (inverse
/// covariance) of its noise.
struct Residual {
  std::size_t track{0};
  std::function<Eigen::Vector2d(const Errors&)> value{};
  Eigen::Matrix2d information{Eigen::Matrix2d::Zero()};

  /// Derivative by one of the errors, from the difference between a step forwards and one back.
  Eigen::Vector2d slope(const Errors& errors, Eigen::Index term, double step) const {
    Errors change = Errors::Zero();
    change[term] = step;
    return (value(errors + change) - value(errors - change)) / (2.0 * step);
  }
};

class Problem {
 public:
  Problem(const std::vector<CameraSighting>& sightings, const CameraConfig& camera,
          const MarkerConfig& markers, const ImportedLog& log, Duration lidar_late,
          const ScaleSigmas& scales)
      : camera_{camera}, markers_{markers}, log_{log}, lidar_late_{lidar_late}, scales_{scales} {
    for (const CameraSighting& sighting : sightings) {
      if (is_covered(sighting.time)) tracks_by_id_[sighting.id].push_back(&sighting);
    }
  }

  std::optional<CameraCalibration> solve();

 private:
  bool is_covered(Timestamp time) const {
    const Duration margin = std::chrono::seconds{1};
    return time - margin >= log_.odometry.front().time &&
           time + margin <= log_.odometry.back().time;
  }

  Eigen::Vector2d place_in_base(const CameraSighting& sighting, const Errors& errors) const {
    const double size = 1.0 + errors[kSize];
    const Eigen::Vector3d place = sighting.place_in_camera.cwiseProduct(
        Eigen::Vector3d{size, size, size * (1.0 + errors[kFocal])});
    const Eigen::Vector3d offset = Eigen::AngleAxisd{errors[kYaw], Eigen::Vector3d::UnitZ()} *
                                   (base_from_camera_.linear() * place);
    return (base_from_camera_.translation() + offset).head<2>();
  }

  Se2 odom_at(const CameraSighting& sighting, const Errors& errors) const {
    return pose_at(log_.odometry, sighting.time - duration_from_seconds(errors[kLate]));
  }

  Eigen::Matrix2d covariance_of(const CameraSighting& sighting) const {
    const Eigen::Matrix3d in_base = base_from_camera_.linear() * sighting.covariance_in_camera *
                                    base_from_camera_.linear().transpose();
    return in_base.topLeftCorner<2, 2>();
  }

  void add_track(const std::vector<const CameraSighting*>& track);
  void add_pair(const CameraSighting& first, const CameraSighting& second, std::size_t track);
  void add_wall(const CameraSighting& sighting, std::size_t track);
  std::vector<AnnotatedBeam> beams_at(const ImportedScan& scan, const Se2& base_from_odom) const;
  void collect(const Errors& errors);

  /// Information [1/s^2] of a residual about the time offset kLate, by central differences.
  double late_information(const Residual& residual, double step_s) const {
    const Eigen::Vector2d slope = residual.slope(errors_, kLate, step_s);
    return slope.dot(residual.information * slope);
  }

  /// Half of the interval between odometry samples: noise from sample to sample can shift the time
  /// offset by up to this. It is weighted with the share of noise in late_information(), which is
  /// the part that disappears with the long step kSlowStep_s.
  double half_interval_s() const {
    return 0.5 * to_seconds(log_.odometry.back().time - log_.odometry.front().time) /
           static_cast<double>(log_.odometry.size());
  }

  CameraConfig camera_;
  MarkerConfig markers_;
  const ImportedLog& log_;
  Duration lidar_late_;
  ScaleSigmas scales_;
  Eigen::Isometry3d base_from_camera_{camera_.base_from_camera()};
  std::map<int, std::vector<const CameraSighting*>> tracks_by_id_{};
  Errors errors_{Errors::Zero()};
  std::vector<Residual> residuals_{};
  CameraCalibration counts_{};
};

void Problem::add_pair(const CameraSighting& first, const CameraSighting& second,
                       std::size_t track) {
  const Se2 motion = odom_at(first, errors_).inverse() * odom_at(second, errors_);
  const double walked_m = motion.translation().norm();
  const double heading_rad2 =
      kWalk_rad2_per_m * walked_m + kWalk_rad2_per_rad * std::abs(motion.theta());
  const Eigen::Vector2d place = place_in_base(first, errors_);
  const Eigen::Vector2d across{-place.y(), place.x()};
  const Eigen::Matrix2d turn = motion.rotation();
  const Eigen::Matrix2d covariance = covariance_of(first) +
                                     turn * covariance_of(second) * turn.transpose() +
                                     kWalk_m2_per_m * walked_m * Eigen::Matrix2d::Identity() +
                                     heading_rad2 * across * across.transpose();
  residuals_.push_back(
      {track,
       [this, &first, &second](const Errors& errors) -> Eigen::Vector2d {
         const Se2 by_odometry = odom_at(first, errors).inverse() * odom_at(second, errors);
         const Se2 moved{(1.0 + errors[kDistance]) * by_odometry.translation(),
                         (1.0 + errors[kTurn]) * by_odometry.theta()};
         return moved * place_in_base(second, errors) - place_in_base(first, errors);
       },
       covariance.inverse()});
  ++counts_.num_pairs;
}

std::vector<AnnotatedBeam> Problem::beams_at(const ImportedScan& imported,
                                             const Se2& base_from_odom) const {
  const LidarScan scan = scan_of(imported);
  const LidarConfig& lidar = log_.robot.lidar;
  std::vector<AnnotatedBeam> beams;
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const double range_m = scan.ranges_m[i];
    if (!(range_m > lidar.range_min_m && range_m < lidar.range_max_m)) continue;
    const Duration offset =
        scan.beam_time_offsets.empty() ? Duration{0} : scan.beam_time_offsets[i];
    const Se2 base_from_then =
        base_from_odom * pose_at(log_.odometry, scan.time + offset - lidar_late_);
    const Se2 from_lidar = base_from_then * lidar.base_from_lidar();
    const Eigen::Vector2d end{range_m * std::cos(scan.angles_rad[i]),
                              range_m * std::sin(scan.angles_rad[i])};
    beams.push_back({{static_cast<int>(i), from_lidar.translation(), from_lidar * end, range_m}});
  }
  return beams;
}

void Problem::add_wall(const CameraSighting& sighting, std::size_t track) {
  const Timestamp time = sighting.time - duration_from_seconds(errors_[kLate]) + lidar_late_;
  auto scan = std::ranges::lower_bound(log_.scans, time, {}, &ImportedScan::time);
  if (scan == log_.scans.end()) return;
  if (scan != log_.scans.begin() && time - std::prev(scan)->time < scan->time - time) --scan;
  if (std::abs(to_seconds(scan->time - time)) > kNearestScan_s) return;
  // All positions are in the base frame at the camera frame's time.
  const Se2 base_from_odom = odom_at(sighting, errors_).inverse();
  const double facing_rad = sighting.facing_rad + errors_[kYaw];
  const auto wall = fit_wall(beams_at(*scan, base_from_odom), place_in_base(sighting, errors_),
                             facing_rad, log_.robot.lidar.range_sigma_m, kWallReach_m);
  if (!wall) return;
  const double across_m2 = wall->normal.dot(covariance_of(sighting) * wall->normal) +
                           squared(wall->sigma_m) + squared(markers_.standoff_sigma_m) +
                           squared(markers_.bulge_sigma_m);
  // The wall is fixed in the odometry frame; a time offset changes the pose of the base.
  const Se2 odom_from_base = base_from_odom.inverse();
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  information(0, 0) = 1.0 / across_m2;
  residuals_.push_back(
      {track,
       [this, &sighting, wall = *wall, odom_from_base](const Errors& errors) -> Eigen::Vector2d {
         const Se2 moved = odom_from_base.inverse() * odom_at(sighting, errors);
         const Eigen::Vector2d place = moved * place_in_base(sighting, errors);
         return {wall.normal.dot(place - wall.point), 0.0};
       },
       information});
  ++counts_.num_walls;
}

void Problem::add_track(const std::vector<const CameraSighting*>& track) {
  const auto number = static_cast<std::size_t>(counts_.num_tracks++);
  for (const CameraSighting* sighting : track)
    add_wall(*sighting, number);
  for (std::size_t i = 0; i < track.size(); ++i) {
    const Se2 base_from_odom = odom_at(*track[i], errors_).inverse();
    const auto is_apart = [&](const CameraSighting* later) {
      const Se2 motion = base_from_odom * odom_at(*later, errors_);
      return motion.translation().norm() > kMinApart_m ||
             std::abs(motion.theta()) > kTurnedEnough_rad;
    };
    const auto later =
        std::find_if(track.begin() + static_cast<std::ptrdiff_t>(i), track.end(), is_apart);
    if (later != track.end()) add_pair(*track[i], **later, number);
  }
}

/// Sets the linearisation point, and selects the residuals of walls and pairs there.
void Problem::collect(const Errors& errors) {
  errors_ = errors;
  residuals_.clear();
  counts_ = {};
  for (const auto& [id, sightings] : tracks_by_id_) {
    std::vector<const CameraSighting*> track;
    for (const CameraSighting* sighting : sightings) {
      if (!track.empty() && to_seconds(sighting->time - track.back()->time) > kMaxPause_s) {
        add_track(track);
        track.clear();
      }
      track.push_back(sighting);
    }
    add_track(track);
  }
}

std::optional<CameraCalibration> Problem::solve() {
  Errors prior_sigmas;
  prior_sigmas << kPriorSigmas, std::min(scales_.distance_sigma, kWidestScalePrior),
      std::min(scales_.turn_sigma, kWidestScalePrior);
  const Information prior = prior_sigmas.cwiseAbs2().cwiseInverse().asDiagonal();
  Information information = Information::Zero();
  std::map<std::size_t, TrackEquations> equations_by_track;
  double squares = 0.0;
  double weights = 0.0;
  double fast = 0.0;
  double slow = 0.0;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    collect(errors_);
    if (counts_.num_tracks < kMinTracks) return std::nullopt;
    information = prior;
    Errors gradient = prior * errors_;
    equations_by_track.clear();
    squares = weights = fast = slow = 0.0;
    for (const Residual& residual : residuals_) {
      const Eigen::Vector2d value = residual.value(errors_);
      Eigen::Matrix<double, 2, kTerms> jacobian;
      for (Eigen::Index i = 0; i < kTerms; ++i)
        jacobian.col(i) = residual.slope(errors_, i, kSteps[static_cast<std::size_t>(i)]);
      const double distance2 = value.dot(residual.information * value);
      const double weight = 1.0 / (1.0 + distance2 / squared(kCutoff));
      const Information added = weight * jacobian.transpose() * residual.information * jacobian;
      information += added;
      const Errors slope = weight * jacobian.transpose() * residual.information * value;
      gradient += slope;
      fast += weight * late_information(residual, kSteps[kLate]);
      slow += weight * late_information(residual, kSlowStep_s);
      TrackEquations& equations = equations_by_track[residual.track];
      equations.information += added;
      equations.slope += slope;
      squares += weight * distance2;
      weights += weight * (residual.information(1, 1) > 0.0 ? 2.0 : 1.0);
    }
    const Errors step = information.ldlt().solve(gradient);
    if (!step.allFinite()) return std::nullopt;
    errors_ -= step;
  }
  const Information inverse = information.inverse();
  Information clustered = Information::Zero();
  for (const auto& [track, equations] : equations_by_track) {
    const Errors without = (information - equations.information).ldlt().solve(equations.slope);
    clustered += without * without.transpose();
  }
  const double scale = std::max(1.0, squares / std::max(1.0, weights));
  // A scale's variance beyond the prior of the fit, times the term's squared derivative.
  const auto scale_variance = [&](Eigen::Index term, Eigen::Index scale_term, double sigma) {
    const double beyond = squared(sigma) - squared(prior_sigmas[scale_term]);
    return squared(inverse(term, scale_term) / inverse(scale_term, scale_term)) * beyond;
  };
  const auto measured = [&](Eigen::Index term, double offset) {
    const double variance = std::max(clustered(term, term), scale * inverse(term, term)) +
                            scale_variance(term, kDistance, scales_.distance_sigma) +
                            scale_variance(term, kTurn, scales_.turn_sigma);
    return Measured{offset + errors_[term], std::sqrt(variance)};
  };
  CameraCalibration found = counts_;
  found.focal = measured(kFocal, 1.0);
  found.marker_size = measured(kSize, 1.0);
  found.yaw_rad = measured(kYaw, 0.0);
  found.late_s = measured(kLate, 0.0);
  const double noise_share = fast > 0.0 ? std::clamp(1.0 - slow / fast, 0.0, 1.0) : 1.0;
  found.late_s.sigma = std::hypot(found.late_s.sigma, noise_share * half_interval_s());
  return found;
}

}  // namespace

std::optional<CameraCalibration> calibrate_camera(const std::vector<CameraSighting>& sightings,
                                                  const CameraConfig& camera,
                                                  const MarkerConfig& markers,
                                                  const ImportedLog& log, Duration lidar_late,
                                                  const ScaleSigmas& scales) {
  return Problem{sightings, camera, markers, log, lidar_late, scales}.solve();
}

std::vector<ImportedPose> rescaled(const std::vector<ImportedPose>& odometry, double distance_scale,
                                   double turn_scale) {
  std::vector<ImportedPose> scaled = odometry;
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const Se2 step = odometry[i - 1].pose.inverse() * odometry[i].pose;
    // An arc's chord points along half of its turn: scaling the turn rotates the chord.
    const double half_rad = 0.5 * step.theta();
    const Eigen::Vector2d along = Se2{0.0, 0.0, half_rad / turn_scale - half_rad} *
                                  Eigen::Vector2d{step.translation() / distance_scale};
    scaled[i].pose = scaled[i - 1].pose * Se2{along, step.theta() / turn_scale};
  }
  return scaled;
}

}  // namespace waymark
