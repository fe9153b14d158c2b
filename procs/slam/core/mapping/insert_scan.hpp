// SPDX-License-Identifier: BSD-3-Clause
// Map update of the paper (IV-D): inserts a scan and its markers at the estimated pose.
#pragma once

#include "slam/core/grid/grid_map.hpp"
#include "slam/core/scan/annotated_scan.hpp"

#include <span>

namespace waymark {

/// Counts a hit and a visit in the cell where each beam ends, and a visit in each cell that it
/// crosses, unless this scan also hits that cell: otherwise grazing beams would erase the wall that
/// they run along.
void insert_beams(std::span<const AnnotatedBeam> beams, const Se2& map_from_base, GridMap& map);

/// Undoes insert_beams() with the same arguments.
void erase_beams(std::span<const AnnotatedBeam> beams, const Se2& map_from_base, GridMap& map);

/// A point of a wall that the camera has observed: on a marker, or beside one.
struct FacePoint {
  Eigen::Vector2d in_base{Eigen::Vector2d::Zero()};
  int marker_id{kNoMarker};
};

/// Points along the marker's line: those on its face have its id, those in the margins kNoMarker.
std::vector<FacePoint> face_points(const MarkerSighting& sighting, double spacing_m,
                                   double margin_m);

/// Adds votes for the points' ids to the cells that they lie in: one vote per cell width.
void insert_face_points(std::span<const FacePoint> points, double spacing_m,
                        const Se2& map_from_base, GridMap& map);

}  // namespace waymark
