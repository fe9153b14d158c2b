// SPDX-License-Identifier: BSD-3-Clause
// How far the map has drifted from where it began, place by place.
#pragma once

#include "slam/core/belief/belief.hpp"
#include "slam/core/scan/annotated_scan.hpp"
#include "slam/core/scan/observability.hpp"

#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace waymark {

/// How far the robot and the walls that it sees are off from each other, for they were mapped at
/// another time.
struct DriftFromWalls {
  PoseError since{};  ///< of the robot: what has come since they were mapped
  /// Of the walls (covariance): what they were off when they were mapped, and the robot is not.
  Eigen::Matrix3d before{Eigen::Matrix3d::Zero()};
};

/// A pose that has been drawn is exact for its particle, and what is mapped from there shares its
/// error. A few particles, drawn again and again, do not remember how large such errors may have
/// grown: this does. Each square metre keeps the error that the robot's pose had, on average, when
/// it was mapped. Where known walls are seen again, the robot may be off from them by what has come
/// since only, and is off from the origin by what they are. New walls that are seen beside them
/// hold the robot back: their errors are those of the scans that they were mapped by, and matching
/// finds a mean of all, weighted by what their beams tell.
/// Systematic errors push the same way at every step, so that what they do grows with the way and
/// not with its root: the drift is kept together with them.
class MapDrift {
 public:
  /// The robot has moved: an error of the heading turns into one of the position.
  void move(const Se2& map_from_base);

  /// What lies between the walls that a scan shows and the robot. What has come since they were
  /// mapped is taken from the drift: it now belongs to the pose, where matching can tell it.
  /// @param walls  of the scan, base frame: each counts for the weak direction, if that is told at
  /// all, and for the others, as far as it can tell them.
  /// @param errors_covariance  of the systematic errors, as they are known now.
  DriftFromWalls release(std::span<const AnnotatedBeam> beams, const Observability& walls,
                         const ErrorsCovariance& errors_covariance);

  /// What the pose has lost by drawing.
  /// @param by_noise  the part of it that comes from the noise of this scan alone.
  void take(const PoseError& drawn, const Eigen::Matrix3d& by_noise,
            const ErrorsCovariance& errors_covariance);

  /// A scan is mapped.
  /// @param by_scan  what its own noise adds to the walls; nothing where the pose has followed it.
  /// @param undrawn  error of the pose that has not been drawn: that of the walls, too.
  void map(std::span<const AnnotatedBeam> beams, const Eigen::Matrix3d& by_scan,
           const PoseError& undrawn, const ErrorsCovariance& errors_covariance);

  /// The region was well mapped when the pose was better than now: what the last released scan
  /// shows there belongs to walls that are known already, and would double them.
  bool is_better_known(const Eigen::Vector2d& point_in_map) const {
    return better_known_.contains(place_of(point_in_map));
  }

  /// Of what is being mapped.
  const PoseError& now() const { return now_; }

 private:
  using Place = std::pair<int, int>;

  struct Region {
    PoseError drawn{};                               ///< mean over its points
    PoseError whole{};                               ///< the same with what was not drawn
    Eigen::Vector2d robot{Eigen::Vector2d::Zero()};  ///< from where it was first seen
    int points{0};
  };

  /// A region that a scan shows.
  struct Seen {
    Place place{};
    Eigen::Matrix3d told{Eigen::Matrix3d::Zero()};
    PoseError error{};  ///< at the robot
  };

  /// As PoseError, but without what follows the systematic errors in the covariance.
  struct Error {
    Eigen::Matrix3d rest{Eigen::Matrix3d::Zero()};
    PoseByErrors by_errors{PoseByErrors::Zero()};
  };

  static Place place_of(const Eigen::Vector2d& point_in_map);
  std::map<Place, Eigen::Matrix3d> told_by_regions(std::span<const AnnotatedBeam> beams) const;
  Error error_by(const std::vector<Seen>& seen, const ErrorsCovariance& errors_covariance) const;
  bool knows_better(const Seen& seen, const Eigen::Matrix3d& axes,
                    const ErrorsCovariance& errors_covariance) const;

  Se2 map_from_base_{};
  PoseError now_{};
  Eigen::Matrix3d noise_{
      Eigen::Matrix3d::Zero()};  ///< the part of it that comes from the last scan
  std::map<Place, Region> regions_{};
  std::set<Place> better_known_{};  ///< of the last released scan
};

}  // namespace waymark
