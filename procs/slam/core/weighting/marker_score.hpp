// SPDX-License-Identifier: BSD-3-Clause
// Weight update of the paper (IV-C): the camera's observations compared with the marker layer.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/grid/grid_map.hpp"
#include "slam/core/scan/observation.hpp"

#include <span>
#include <vector>

namespace waymark {

class Fields;

/// Values of one beam in units of log weight (the temperature is in the values).
struct MatchingRewards {
  double strong_reward{1.0};
  double penalty{1.0};
  /// For a beam outside marker regions that ends on a mapped wall. With a quarter of this, a
  /// particle with good ids and a bad heading bends the map by half a degree.
  double weak_reward{0.2};

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

/// Score of one point that the camera has observed, given the votes of the cells around it: between
/// strong_reward (the same id) and -penalty (something else). Zero if both are "no marker", or the
/// map has no votes: an unmapped point scores like a confirmed bare wall, so that mapped places do
/// not attract the particles.
double marker_score(const GridMap& map, const Eigen::Vector2d& point_in_map, int marker_id,
                    const MatchingRewards& rewards);

/// A point that the camera has observed: the end of a beam, or a point on or beside a marker.
struct ObservedSpot {
  Eigen::Vector2d in_base{Eigen::Vector2d::Zero()};
  int marker_id{kNoMarker};
  double weight{1.0};  ///< factor on the score
};

/// A sighting with this standard deviation along its wall has half the weight.
inline constexpr double kSightingSigma_m = 0.025;

/// The ends of beams in the camera's view, and points of the sighted markers' faces.
/// @param face_spacing_m  between the points of a face.
/// @param face_margin_m  bare wall beside a marker, seen together with it.
std::vector<ObservedSpot> observed_spots(const Observation& observation, double face_spacing_m,
                                         double face_margin_m,
                                         double sighting_sigma_m = kSightingSigma_m);

/// Sum of the weighted scores of all spots.
double marker_score(const GridMap& map, std::span<const ObservedSpot> spots,
                    const Se2& map_from_base, const MatchingRewards& rewards);

}  // namespace waymark
