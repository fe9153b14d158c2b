// SPDX-License-Identifier: BSD-3-Clause
// What a scan says about the pose, given the walls of a map: point to line, along observed axes.
#pragma once

#include "slam/core/proposal/pose_information.hpp"
#include "slam/core/scan/annotated_scan.hpp"
#include "slam/core/surface/surface_map.hpp"

#include <span>

namespace waymark {

class Fields;

struct SurfaceMatchingConfig {
  double range_sigma_m{0.01};     ///< of the LiDAR; taken from the robot
  double surface_sigma_m{0.002};  ///< roughness of walls, errors of beam angles
  double outlier_sigmas{10.0};    ///< a beam this far off counts a quarter
  double information_share{1.0};  ///< beams are not quite independent, nor is the map exact
  double clump_weight{3.0};       ///< of a beam that hits a clump; 0: clumps are not matched
  double weak_share{0.02};        ///< directions below this share of the strongest are unobserved

  void describe(Fields& fields);
};

struct SurfaceMatch {
  PoseInformation pose{};  ///< without the unobserved directions
  double mapped{0.0};      ///< number of beams that ended where the map has a surface
  double agreeing{0.0};    ///< of those: in accordance with it
  int beams{0};            ///< number of beams looked at
};

/// Second-order model of the scan's negative log-likelihood at a pose. Beams that end where nothing
/// is mapped are neutral. Each beam measures its distance to the wall, n'(p - m), with the part of
/// the range error that lies across the wall; where there is no line but a clump of points, how far
/// it is from their middle, judged by their scatter. Directions that the scan does not tell get no
/// information and no gradient, so nothing pulls back along a bare corridor.
/// Source: Censi (2008), "An ICP variant using a point-to-line metric"; Biber, Strasser (2003),
/// "The normal distributions transform"; Zhang, Kaess, Singh (2016), "On degeneracy of
/// optimization-based state estimation problems".
/// @param map  for the same beams at every call.
/// @param uncertainty  covariance of the pose (x, y, theta), map frame: how far off beams may be
/// before they count as outliers.
SurfaceMatch match_surfaces(std::span<const AnnotatedBeam> beams, SurfaceFinder& map,
                            const Se2& map_from_base, const Eigen::Matrix3d& uncertainty,
                            const SurfaceMatchingConfig& config);

/// How far the walls of one scan are off, as a whole, by its noise: covariance of the rigid motion
/// (x, y, theta; base frame) that would put them right. Zero where the scan does not tell.
Eigen::Matrix3d noise_of_walls(std::span<const AnnotatedBeam> beams,
                               const SurfaceMatchingConfig& config);

/// Removes the direction with the least information and what is correlated with it, so that
/// nothing is learnt about it: one scan knows a wall's direction to a fraction of a milliradian
/// only, and what that leaves would take the uncertainty along the wall away, update by update.
/// @param open  covariance of the pose that such scans have left, carried along to here: what the
/// way from there adds is the motion's, and walls that are driven towards or away from tell of it.
void remove_weak_direction(const Eigen::Matrix3d& open, PoseInformation& pose);

/// Removes the directions with little information.
void keep_observed(double weak_share, PoseInformation& pose);

}  // namespace waymark
