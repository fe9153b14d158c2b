// SPDX-License-Identifier: BSD-3-Clause
#include "common/messages/validate.hpp"

#include <algorithm>
#include <cmath>
#include <ranges>

namespace waymark {
namespace {

constexpr int kMaxBeams = 16384;
constexpr int kMaxImageSide_px = 16384;
constexpr float kMaxCoordinate = 1e7F;  // [m, rad] no odometry counts up to that
constexpr std::int64_t kMaxBeamTimeOffset_us = 10'000'000;  // a sweep lasts well below 10 s

template <class Numbers>
bool finite(const Numbers& numbers) {
  return std::ranges::all_of(numbers, [](auto number) { return std::isfinite(number); });
}

template <class... Numbers>
bool all_finite(Numbers... numbers) {
  return (std::isfinite(numbers) && ...);
}

template <class Array>
bool has_size(const Array& array, std::int64_t size) {
  return std::ssize(array) == size;
}

/// First reason that is not kNone.
RejectReason first_of(bool consistent, bool is_finite) {
  if (!consistent) return RejectReason::kInconsistent;
  return is_finite ? RejectReason::kNone : RejectReason::kNotFinite;
}

bool is_unit_quaternion(const double (&q)[4]) {
  const double norm = std::hypot(std::hypot(q[0], q[1]), std::hypot(q[2], q[3]));
  return std::abs(norm - 1.0) < 1e-3;
}

bool contents_agree(const std::vector<channel_content_t>& channels, int num_channels) {
  return has_size(channels, num_channels) &&
         std::ranges::all_of(channels, [](const auto& c) { return has_size(c.hashes, c.count); });
}

bool detection_is_finite(const marker_detection_t& d) {
  return std::ranges::all_of(d.corners_px, [](const auto& corner) { return finite(corner); }) &&
         finite(d.position_m) && finite(d.orientation) && finite(d.covariance) &&
         finite(d.other_position_m) && finite(d.other_orientation) &&
         all_finite(d.reprojection_error_px, d.other_reprojection_error_px, d.width_px);
}

bool detection_is_consistent(const marker_detection_t& d) {
  return d.id >= 0 && is_unit_quaternion(d.orientation) && is_unit_quaternion(d.other_orientation);
}

}  // namespace

RejectReason validate(const ack_t& m) {
  return first_of(contents_agree(m.channels, m.num_channels) && !m.who.empty(), true);
}

RejectReason validate(const annotated_scan_t& m) {
  return first_of(has_size(m.ranges, m.num_beams) && has_size(m.angles, m.num_beams) &&
                      has_size(m.marker_ids, m.num_beams),
                  all_finite(m.x_m, m.y_m, m.theta_rad) && finite(m.angles));
}

RejectReason validate(const calibration_t& m) {
  return first_of(true, finite(m.mean) && finite(m.covariance));
}

RejectReason validate(const image_t& m) {
  const auto is_side = [](int side_px) {
    return side_px > 0 && side_px <= kMaxImageSide_px;
  };
  return first_of(is_side(m.width) && is_side(m.height) && has_size(m.data, m.size) &&
                      has_size(m.metadata, m.nmetadata),
                  true);
}

RejectReason validate(const lidar_t& m) {
  const bool sizes_agree = m.num_ranges <= kMaxBeams && has_size(m.ranges, m.num_ranges) &&
                           has_size(m.thetas, m.num_ranges) && has_size(m.times, m.num_ranges) &&
                           has_size(m.intensities, m.num_ranges);
  if (!sizes_agree || m.num_ranges < 1) return RejectReason::kInconsistent;
  const bool times_near = std::ranges::all_of(m.times, [&m](std::int64_t time) {
    return time >= m.utime - kMaxBeamTimeOffset_us && time <= m.utime + kMaxBeamTimeOffset_us;
  });
  if (!times_near) return RejectReason::kBadTime;
  return first_of(true, finite(m.thetas));
}

RejectReason validate(const map_header_t& m) {
  return first_of(m.num_messages >= 0 && m.resolution_m > 0.0 && m.marker_size_m > 0.0,
                  all_finite(m.resolution_m, m.marker_size_m));
}

RejectReason validate(const map_tiles_t& m) {
  const std::int64_t cells_per_tile = std::int64_t{m.tile_size_cells} * m.tile_size_cells;
  const bool tiles_agree = std::ranges::all_of(m.tiles, [cells_per_tile](const map_tile_t& tile) {
    constexpr int kMaxTileIndex = 1 << 20;
    return tile.num_cells == cells_per_tile && has_size(tile.occupancy, tile.num_cells) &&
           has_size(tile.marker_ids, tile.num_cells) && tile.tile_x > -kMaxTileIndex &&
           tile.tile_x < kMaxTileIndex && tile.tile_y > -kMaxTileIndex &&
           tile.tile_y < kMaxTileIndex;
  });
  const bool parts_agree = m.part >= 0 && m.part < m.num_parts;
  return first_of(has_size(m.tiles, m.num_tiles) && tiles_agree && parts_agree &&
                      m.tile_size_cells > 0 && m.tile_size_cells <= 1024 && m.resolution_m > 0.0,
                  all_finite(m.origin_x_m, m.origin_y_m, m.resolution_m));
}

RejectReason validate(const map_walls_t& m) {
  const auto is_cell = [](const wall_cell_t& cell) {
    constexpr int kMaxCell = 1 << 24;
    return cell.count > 0.0 && std::abs(cell.column) < kMaxCell && std::abs(cell.row) < kMaxCell;
  };
  const bool cells_finite = std::ranges::all_of(m.cells, [](const wall_cell_t& cell) {
    return std::isfinite(cell.count) && finite(cell.sum_m) && finite(cell.squares_m2);
  });
  return first_of(has_size(m.cells, m.num_cells) && std::ranges::all_of(m.cells, is_cell) &&
                      m.part >= 0 && m.part < m.num_parts && m.spacing_m > 0.0,
                  cells_finite && std::isfinite(m.spacing_m));
}

RejectReason validate(const marker_detections_t& m) {
  return first_of(has_size(m.detections, m.num_detections) &&
                      std::ranges::all_of(m.detections, detection_is_consistent),
                  std::ranges::all_of(m.detections, detection_is_finite));
}

RejectReason validate(const marker_map_t& m) {
  const bool landmarks_finite = std::ranges::all_of(m.landmarks, [](const auto& landmark) {
    return all_finite(landmark.x_m, landmark.y_m, landmark.yaw_rad) && finite(landmark.covariance);
  });
  return first_of(has_size(m.landmarks, m.num_landmarks) && m.part >= 0 && m.part < m.num_parts,
                  landmarks_finite);
}

RejectReason validate(const occupancy_grid_t& m) {
  const bool sizes_agree = m.width >= 0 && m.height >= 0 &&
                           std::int64_t{m.width} * m.height == m.num_cells &&
                           has_size(m.cells, m.num_cells);
  return first_of(sizes_agree && m.meters_per_cell > 0.0F,
                  all_finite(m.origin_x, m.origin_y, m.meters_per_cell));
}

RejectReason validate(const particles_t& m) {
  const bool particles_finite = std::ranges::all_of(m.particles, [](const particle_t& p) {
    return all_finite(p.pose.x, p.pose.y, p.pose.theta, p.parent_pose.x, p.parent_pose.y,
                      p.parent_pose.theta, p.weight);
  });
  return first_of(has_size(m.particles, m.num_particles), particles_finite);
}

RejectReason validate(const planar_lidar_t& m) {
  const bool sizes_agree = m.nranges >= 1 && m.nranges <= kMaxBeams &&
                           has_size(m.ranges, m.nranges) &&
                           (m.nintensities == 0 || m.nintensities == m.nranges) &&
                           has_size(m.intensities, m.nintensities);
  return first_of(sizes_agree, all_finite(m.rad0, m.radstep));
}

RejectReason validate(const pose2D_t& m) {
  const bool is_finite = all_finite(m.x, m.y, m.theta);
  const bool is_near = std::abs(m.x) < kMaxCoordinate && std::abs(m.y) < kMaxCoordinate &&
                       std::abs(m.theta) < kMaxCoordinate;
  return first_of(is_near || !is_finite, is_finite);
}

RejectReason validate(const pose_graph_t& m) {
  const bool vertices_finite =
      std::ranges::all_of(m.vertices, [](const auto& vertex) { return finite(vertex); });
  const bool edges_finite = std::ranges::all_of(m.edges, [](const graph_edge_t& edge) {
    return finite(edge.pose) && finite(edge.information);
  });
  const bool edges_agree = std::ranges::all_of(
      m.edges, [](const graph_edge_t& edge) { return edge.from >= 0 && edge.to >= 0; });
  return first_of(has_size(m.vertices, m.num_vertices) && has_size(m.edges, m.num_edges) &&
                      edges_agree && m.part >= 0 && m.part < m.num_parts,
                  vertices_finite && edges_finite);
}

RejectReason validate(const process_status_t& m) {
  return first_of(has_size(m.counters, m.num_counters), true);
}

RejectReason validate(const slam_estimate_t& m) {
  return first_of(
      m.num_particles >= 0 && m.health >= slam_estimate_t::HEALTH_UNKNOWN &&
          m.health <= slam_estimate_t::HEALTH_LOST,
      all_finite(m.x_m, m.y_m, m.theta_rad, m.effective_particles, m.weak_information) &&
          finite(m.covariance) && finite(m.information) && finite(m.weak_axis));
}

RejectReason validate(const tick_t& m) {
  return first_of(contents_agree(m.channels, m.num_channels) &&
                      has_size(m.participants, m.num_participants) && m.tick >= tick_t::TICK_CLOSED,
                  true);
}

RejectReason validate(const trajectory_t& m) {
  const bool poses_finite = std::ranges::all_of(
      m.poses, [](const pose2D_t& pose) { return all_finite(pose.x, pose.y, pose.theta); });
  return first_of(has_size(m.poses, m.num_poses) && m.part >= 0 && m.part < m.num_parts,
                  poses_finite);
}

RejectReason validate(const twist2D_t& m) {
  return first_of(true, all_finite(m.vx, m.vy, m.wz));
}

}  // namespace waymark
