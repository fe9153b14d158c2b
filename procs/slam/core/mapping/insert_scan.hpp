// SPDX-License-Identifier: BSD-3-Clause
// Map update of the paper (IV-D): a scan and its markers enter the map at the estimated pose.
#pragma once

#include "slam/core/grid/grid_map.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <span>

namespace waymark {

/// Counts a hit where each beam ends and a visit in each cell that it crosses. A cell that this
/// scan hits counts no crossing by the same scan: else grazing beams would erase the wall that they
/// run along.
void insert_beams(std::span<const AnnotatedBeam> beams, const Se2& map_from_base, GridMap& map);

/// Undoes insert_beams() with the same arguments.
void erase_beams(std::span<const AnnotatedBeam> beams, const Se2& map_from_base, GridMap& map);

/// A sample of a wall as the camera saw it: on a marker, or beside one.
struct FacePoint {
  Eigen::Vector2d in_base{Eigen::Vector2d::Zero()};
  int marker_id{kNoMarker};
};

/// Points along the marker's line: its face carries its id, the margin on both sides carries none.
std::vector<FacePoint> face_points(const MarkerSighting& sighting, double spacing_m,
                                   double margin_m);

/// Votes for the marker ids of the cells that the points fall into: one vote per cell width.
void insert_face_points(std::span<const FacePoint> points, double spacing_m,
                        const Se2& map_from_base, GridMap& map);

}  // namespace waymark
