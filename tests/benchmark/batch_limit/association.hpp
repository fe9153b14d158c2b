// SPDX-License-Identifier: BSD-3-Clause
// Which measurement is of which wall and which marker, and a first guess of where all of them are.
#pragma once

#include "batch_limit/recorded_drive.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <vector>

namespace waymark::benchmark {

/// A wall, map frame: a polyline about the line through `anchor`, bent by a little where two of its
/// pieces meet. Piece i lies between knot i and knot i + 1; the anchor is in the middle of piece 0.
struct Wall {
  Eigen::Vector2d anchor{Eigen::Vector2d::Zero()};  ///< on it when first seen; fixed
  double normal_rad{0.0};                           ///< of the line; fixed
  std::map<int, double> knots_m{};                  ///< how far off the line, along the normal

  Eigen::Vector2d normal() const { return {std::cos(normal_rad), std::sin(normal_rad)}; }

  Eigen::Vector2d along() const { return {-std::sin(normal_rad), std::cos(normal_rad)}; }

  int piece_at(const Eigen::Vector2d& place, double piece_m) const {
    return static_cast<int>(std::floor(along().dot(place - anchor) / piece_m + 0.5));
  }
};

struct Marker {
  int id{kNoMarker};
  Se2 map_from_marker{};
  std::optional<std::size_t> wall{};  ///< that it hangs on
};

/// A measurement (by its place among those of its stop) and the wall or marker that it is of.
struct Link {
  std::size_t stop{0};
  std::size_t measurement{0};
  std::size_t landmark{0};
};

/// The map's origin is the first stop.
struct Scene {
  std::vector<Se2> map_from_base{};  ///< of each stop
  std::vector<Wall> walls{};
  std::vector<Marker> markers{};
  std::vector<Link> wall_links{};
  std::vector<Link> marker_links{};
};

/// Dead reckoning that keeps to the walls; walls by place and direction, markers by id and place.
/// @param same_marker_within_m  sightings of an id further apart are of different markers.
Scene associate(std::span<const Stop> stops, const OdometryNoise& noise,
                double same_marker_within_m);

}  // namespace waymark::benchmark
