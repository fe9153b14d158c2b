// SPDX-License-Identifier: BSD-3-Clause
#include "common/pictures/png.hpp"
#include "placement/placement_report.hpp"
#include "viewer/core/painters/map_painter.hpp"

#include <fmt/format.h>

#include <vector>

namespace waymark::placement {
namespace {

constexpr int kTile = 64;  // cells

std::int8_t percent_of(Cell state) {
  switch (state) {
    case Cell::kFree:
      return 0;
    case Cell::kOccupied:
      return 100;
    case Cell::kUnknown:
      break;
  }
  return viewer::kUnknownOccupancy;
}

void put_map(const PlacedMapImage& image, viewer::TiledMap& map) {
  const viewer::TileLayout layout{image.origin_m.x(), image.origin_m.y(), image.resolution_m,
                                  kTile};
  std::vector<std::int8_t> occupancy(kTile * kTile);
  const std::vector<std::int16_t> no_markers(occupancy.size(), kNoMarker);
  for (int y = 0; y * kTile < image.height_px; ++y) {
    for (int x = 0; x * kTile < image.width_px; ++x) {
      for (int cell = 0; cell < kTile * kTile; ++cell)
        occupancy[static_cast<std::size_t>(cell)] =
            percent_of(image.at(x * kTile + cell % kTile, y * kTile + cell / kTile));
      map.put(layout, {}, {x, y, occupancy, no_markers});
    }
  }
}

viewer::Landmark landmark_of(int id, int instance, const Se2& pose, viewer::LandmarkState state) {
  viewer::Landmark landmark;
  landmark.id = id;
  landmark.instance = instance;
  landmark.map_from_marker = pose;
  landmark.state = state;
  return landmark;
}

}  // namespace

std::string placement_picture(const PlacementInput& input, const Placement& placement) {
  viewer::Scene scene;
  scene.title =
      fmt::format("placement: {} new, worst sigma {:.3f} to {:.3f} m", placement.markers.size(),
                  placement.worst_now_m(), placement.worst_then_m());
  put_map(input.image, scene.map);
  for (const MappedMarker& marker : input.markers)
    scene.landmarks.push_back(landmark_of(marker.id, marker.instance, marker.map_from_marker,
                                          viewer::LandmarkState::kConfirmed));
  scene.changes.emplace();
  for (const NewMarker& marker : placement.markers) {
    const Se2& pose = marker.place.map_from_marker;
    scene.landmarks.push_back(landmark_of(marker.id, 0, pose, viewer::LandmarkState::kTentative));
    viewer::MapChange change;
    change.kind = viewer::MapChange::Kind::kNew;
    change.id = marker.id;
    change.place = pose;
    scene.changes->push_back(change);
  }
  for (std::size_t i = 0; i < placement.steps.size(); ++i) {
    viewer::EstimatedPose pose;
    pose.time = timestamp_from_us(static_cast<std::int64_t>(i));
    pose.map_from_base = placement.steps[i].map_from_base;
    pose.covariance = placement.now[i];
    pose.health = Health::kTracking;
    scene.estimates.push_back(pose);
  }
  viewer::MapPageStyle style;
  style.marker_size_m = input.config.robot.markers.size_m;
  return png_bytes(viewer::paint_map(scene, style));
}

}  // namespace waymark::placement
