// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/scan_match.hpp"

#include "common/geometry/median.hpp"
#include "common/geometry/principal_axes.hpp"
#include "common/geometry/squared.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

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
// Largest number of beams in one cell that count as independent: the error of the cell's mean is
// common to all of them, and so is the displacement if they end on a person.
constexpr double kIndependentBeams = 4.0;
// The information of a beam has the factor n / (n + kFewKeyframes), where n is the number of
// keyframes from the first to the last that observed its cell: the error of the cell's mean falls
// with n, and a person stays at one place for a few keyframes only.
constexpr double kFewKeyframes = 3.0;
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

/// A quadratic model of the cost about a pose: cost + gradient' d + d' information d / 2.
struct Quadratic {
  Eigen::Matrix3d information{Eigen::Matrix3d::Zero()};
  Eigen::Vector3d gradient{Eigen::Vector3d::Zero()};
};

/// Residuals of one beam that ends in an NDT cell: across its wall, and along if it is no line.
struct BeamTerm {
  Eigen::Vector2d normal{Eigen::Vector2d::Zero()};
  double across_m{0.0};
  double along_m{0.0};
  double across_weight{0.0};  ///< inverse variances, times the robust weight
  double along_weight{0.0};
  double robust{0.0};  ///< Geman-McClure weight, 0..1
};

/// @param ray  from the base to the point, map's axes; approximates the beam, which begins at the
///             LiDAR.
BeamTerm compare(const NdtCell& cell, const Eigen::Vector2d& point, const Eigen::Vector2d& ray,
                 double point_variance_m2, double blur_m2, const ScanMatchConfig& config) {
  BeamTerm term;
  const Eigen::Vector2d distance = point - cell.mean;
  term.normal = cell.normal;
  term.across_m = term.normal.dot(distance);
  // A cell may be thin by chance: the variance is at least the range noise along its normal.
  const double by_range_m2 = point_variance_m2 * squared(term.normal.dot(ray)) / ray.squaredNorm();
  term.across_weight =
      1.0 / (std::max(cell.across_m2, by_range_m2) + squared(config.roughness_m) + blur_m2);
  double chi2 = term.across_weight * squared(term.across_m);
  if (!cell.is_line) {
    term.along_m = term.normal.x() * distance.y() - term.normal.y() * distance.x();
    term.along_weight = 1.0 / (cell.along_m2 + blur_m2);
    chi2 += term.along_weight * squared(term.along_m);
  }
  const double kernel2 = squared(config.kernel_sigmas);
  term.robust = squared(kernel2 / (kernel2 + chi2));
  term.across_weight *= term.robust;
  term.along_weight *= term.robust;
  return term;
}

double known_share(const NdtCell& cell) {
  if (cell.last_keyframe == kNoKeyframe) return 1.0;
  const int seen_from = cell.last_keyframe - cell.first_keyframe + 1;
  return seen_from / (seen_from + kFewKeyframes);
}

/// A scan in a map, with the cells of its points cached: most stay the same from step to step.
class PointsInMap {
 public:
  /// @param uses_parts  of thick cells, if the map is divided.
  PointsInMap(std::span<const Eigen::Vector2d> points, const NdtMap& map, double point_variance_m2,
              bool uses_parts)
      : points_{points},
        map_{map},
        point_variance_m2_{point_variance_m2},
        uses_parts_{uses_parts && map.is_divided()},
        places_(points.size()) {}

  Quadratic quadratic_about(const Se2& pose, double blur_m2, const ScanMatchConfig& config) {
    Quadratic sum;
    const Eigen::Matrix2d rotation = pose.rotation();
    for (std::size_t i = 0; i < points_.size(); ++i)
      find_place(i, rotation * points_[i] + pose.translation());
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const NdtCell* cell = places_[i].cell;
      if (cell == nullptr) continue;
      const Eigen::Vector2d lever = rotation * points_[i];
      const Eigen::Vector2d there = lever + pose.translation();
      const BeamTerm term = compare(*cell, there, lever, point_variance_m2_, blur_m2, config);
      const double share = independent_share(*places_[i].beams) * known_share(*cell);
      add(term.normal, lever, term.across_m, share * term.across_weight, sum);
      if (term.along_weight > 0.0) {
        const Eigen::Vector2d along{-term.normal.y(), term.normal.x()};
        add(along, lever, term.along_m, share * term.along_weight, sum);
      }
    }
    sum.information.bottomLeftCorner<1, 2>() = sum.information.topRightCorner<2, 1>().transpose();
    sum.information(1, 0) = sum.information(0, 1);
    return sum;
  }

 private:
  struct Place {
    NdtMap::Key key{0};
    const NdtCell* cell{nullptr};
    int* beams{nullptr};  ///< number of the scan's beams in that cell, in all of its parts
    bool is_known{false};
  };

  void find_place(std::size_t point, const Eigen::Vector2d& there) {
    Place& place = places_[point];
    const NdtMap::Key key = uses_parts_ ? map_.part_at(there) : map_.key_at(there);
    if (place.is_known && place.key == key) return;
    if (place.cell != nullptr) --*place.beams;
    const NdtCell* cell =
        uses_parts_ ? map_.at_part(key, point_variance_m2_) : map_.at(key, point_variance_m2_);
    place = {key, cell, nullptr, true};
    if (place.cell == nullptr) return;
    place.beams = &beams_on_[uses_parts_ ? NdtMap::cell_of_part(key) : key];
    ++*place.beams;
  }

  /// Adds a residual along `direction`, with d(residual)/d(x, y, theta) = (direction, by_turn).
  static void add(const Eigen::Vector2d& direction, const Eigen::Vector2d& lever, double distance_m,
                  double weight, Quadratic& sum) {
    const double by_turn = lever.x() * direction.y() - lever.y() * direction.x();
    const double wx = weight * direction.x();
    const double wy = weight * direction.y();
    sum.information(0, 0) += wx * direction.x();
    sum.information(0, 1) += wx * direction.y();
    sum.information(1, 1) += wy * direction.y();
    sum.information(0, 2) += wx * by_turn;
    sum.information(1, 2) += wy * by_turn;
    sum.information(2, 2) += weight * by_turn * by_turn;
    sum.gradient += weight * distance_m * Eigen::Vector3d{direction.x(), direction.y(), by_turn};
  }

  std::span<const Eigen::Vector2d> points_;
  const NdtMap& map_;
  double point_variance_m2_;
  bool uses_parts_;
  std::vector<Place> places_;
  std::unordered_map<NdtMap::Key, int> beams_on_{};  ///< by cell; never iterated over
};

void summarise(std::span<const Eigen::Vector2d> points, const NdtMap& map, double point_variance_m2,
               const ScanMatchConfig& config, ScanMatch& match) {
  int mapped = 0;
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
    if (cell->last_keyframe == kNoKeyframe) continue;
    const int keyframes = cell->last_keyframe - cell->first_keyframe + 1;
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

double independent_share(int beams) {
  return std::min(1.0, kIndependentBeams / beams);
}

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

}  // namespace waymark
