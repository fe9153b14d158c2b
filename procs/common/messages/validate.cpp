// SPDX-License-Identifier: BSD-3-Clause
#include "common/messages/validate.hpp"

#include "common/messages/bounds.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace waymark {
namespace {

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

template <class... Numbers>
bool all_within(double bound, Numbers... numbers) {
  return ((std::abs(numbers) <= bound) && ...);
}

template <class Numbers>
bool each_within(double bound, const Numbers& numbers) {
  return std::ranges::all_of(numbers, [bound](auto number) { return std::abs(number) <= bound; });
}

bool is_pose_within(double x_m, double y_m, double theta_rad) {
  return all_within(bounds::kPosition_m, x_m, y_m) && all_within(bounds::kAngle_rad, theta_rad);
}

bool is_within(const pose2D_t& pose) {
  return is_pose_within(pose.x, pose.y, pose.theta);
}

/// Infinity is a beam without return, NaN an invalid one.
bool are_ranges_within(const std::vector<float>& ranges_m) {
  return std::ranges::all_of(ranges_m, [](float range_m) {
    return !std::isfinite(range_m) || std::abs(range_m) <= bounds::kRange_m;
  });
}

/// The first failed check. NaN and infinity violate bounds, too, but are reported as not finite.
RejectReason first_of(bool consistent, bool is_finite, bool is_within_bounds = true) {
  if (!consistent) return RejectReason::kInconsistent;
  if (!is_finite) return RejectReason::kNotFinite;
  return is_within_bounds ? RejectReason::kNone : RejectReason::kOutOfBounds;
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

bool detection_is_within(const marker_detection_t& d) {
  return each_within(bounds::kPosition_m, d.position_m) &&
         each_within(bounds::kPosition_m, d.other_position_m) &&
         std::ranges::all_of(d.corners_px, [](const auto& corner) {
           return each_within(bounds::kPixel_px, corner);
         });
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
                  all_finite(m.x_m, m.y_m, m.theta_rad) && finite(m.angles),
                  is_pose_within(m.x_m, m.y_m, m.theta_rad) && are_ranges_within(m.ranges) &&
                      each_within(bounds::kAngle_rad, m.angles));
}

RejectReason validate(const calibration_t& m) {
  return first_of(true, finite(m.mean) && finite(m.covariance));
}

RejectReason validate(const command_t& /*m*/) {
  return RejectReason::kNone;
}

RejectReason validate(const correction_t& m) {
  return first_of(
      m.health >= slam_estimate_t::HEALTH_UNKNOWN && m.health <= slam_estimate_t::HEALTH_LOST &&
          m.reason >= correction_t::REASON_ODOMETRY && m.reason <= correction_t::REASON_COMMAND,
      all_finite(m.x_m, m.y_m, m.theta_rad) && finite(m.covariance) && finite(m.jump));
}

RejectReason validate(const findings_t& m) {
  const bool all_valid = std::ranges::all_of(m.findings, [](const finding_t& finding) {
    return all_finite(finding.value, finding.share);
  });
  return first_of(has_size(m.findings, m.num_findings), all_valid);
}

RejectReason validate(const image_t& m) {
  const auto is_side = [](int side_px) {
    return side_px > 0 && side_px <= bounds::kImageSide_px;
  };
  return first_of(is_side(m.width) && is_side(m.height) && has_size(m.data, m.size) &&
                      has_size(m.metadata, m.nmetadata),
                  true);
}

RejectReason validate(const lidar_t& m) {
  const bool sizes_agree = m.num_ranges <= bounds::kBeams && has_size(m.ranges, m.num_ranges) &&
                           has_size(m.thetas, m.num_ranges) && has_size(m.times, m.num_ranges) &&
                           has_size(m.intensities, m.num_ranges);
  if (!sizes_agree || m.num_ranges < 1) return RejectReason::kInconsistent;
  const bool times_near = std::ranges::all_of(m.times, [&m](std::int64_t time) {
    return time >= m.utime - bounds::kBeamTimeOffset_us &&
           time <= m.utime + bounds::kBeamTimeOffset_us;
  });
  if (!times_near) return RejectReason::kBadTime;
  return first_of(true, finite(m.thetas),
                  are_ranges_within(m.ranges) && each_within(bounds::kAngle_rad, m.thetas));
}

RejectReason validate(const map_changes_t& m) {
  const bool kinds_known = std::ranges::all_of(m.changes, [](const map_change_t& change) {
    return change.kind >= map_change_t::KIND_MARKER_MOVED &&
           change.kind <= map_change_t::KIND_SURVEY_OFF;
  });
  const bool changes_finite = std::ranges::all_of(m.changes, [](const map_change_t& change) {
    return all_finite(change.x_m, change.y_m, change.yaw_rad, change.was_x_m, change.was_y_m,
                      change.size_m, change.sigmas);
  });
  return first_of(has_size(m.changes, m.num_changes) && kinds_known, changes_finite);
}

RejectReason validate(const map_header_t& m) {
  return first_of(m.num_messages >= 0 && m.resolution_m > 0.0 && m.marker_size_m > 0.0,
                  all_finite(m.resolution_m, m.marker_size_m),
                  all_within(bounds::kLength_m, m.resolution_m, m.marker_size_m));
}

RejectReason validate(const map_tiles_t& m) {
  const std::int64_t cells_per_tile = std::int64_t{m.tile_size_cells} * m.tile_size_cells;
  const bool tiles_agree = std::ranges::all_of(m.tiles, [cells_per_tile](const map_tile_t& tile) {
    return tile.num_cells == cells_per_tile && has_size(tile.occupancy, tile.num_cells) &&
           has_size(tile.marker_ids, tile.num_cells) && tile.tile_x > -bounds::kTileIndex &&
           tile.tile_x < bounds::kTileIndex && tile.tile_y > -bounds::kTileIndex &&
           tile.tile_y < bounds::kTileIndex;
  });
  const bool parts_agree = m.part >= 0 && m.part < m.num_parts;
  return first_of(has_size(m.tiles, m.num_tiles) && tiles_agree && parts_agree &&
                      m.tile_size_cells > 0 && m.tile_size_cells <= bounds::kTileSize_cells &&
                      m.resolution_m > 0.0,
                  all_finite(m.origin_x_m, m.origin_y_m, m.resolution_m),
                  all_within(bounds::kPosition_m, m.origin_x_m, m.origin_y_m) &&
                      all_within(bounds::kLength_m, m.resolution_m));
}

RejectReason validate(const map_walls_t& m) {
  const auto is_cell = [](const wall_cell_t& cell) {
    return cell.count > 0.0 && std::abs(cell.column) < bounds::kCellIndex &&
           std::abs(cell.row) < bounds::kCellIndex;
  };
  const bool cells_finite = std::ranges::all_of(m.cells, [](const wall_cell_t& cell) {
    return std::isfinite(cell.count) && finite(cell.sum_m) && finite(cell.squares_m2);
  });
  return first_of(has_size(m.cells, m.num_cells) && std::ranges::all_of(m.cells, is_cell) &&
                      m.part >= 0 && m.part < m.num_parts && m.spacing_m > 0.0,
                  cells_finite && std::isfinite(m.spacing_m),
                  all_within(bounds::kLength_m, m.spacing_m));
}

RejectReason validate(const marker_detections_t& m) {
  return first_of(has_size(m.detections, m.num_detections) &&
                      std::ranges::all_of(m.detections, detection_is_consistent),
                  std::ranges::all_of(m.detections, detection_is_finite),
                  std::ranges::all_of(m.detections, detection_is_within));
}

RejectReason validate(const marker_map_t& m) {
  const bool landmarks_finite = std::ranges::all_of(m.landmarks, [](const auto& landmark) {
    return all_finite(landmark.x_m, landmark.y_m, landmark.yaw_rad) && finite(landmark.covariance);
  });
  const bool landmarks_within = std::ranges::all_of(m.landmarks, [](const auto& landmark) {
    return is_pose_within(landmark.x_m, landmark.y_m, landmark.yaw_rad);
  });
  return first_of(has_size(m.landmarks, m.num_landmarks) && m.part >= 0 && m.part < m.num_parts,
                  landmarks_finite, landmarks_within);
}

RejectReason validate(const mbot_slam_reset_t& m) {
  return first_of(m.retain_pose == 0 || m.retain_pose == 1, true);
}

RejectReason validate(const occupancy_grid_t& m) {
  const bool sizes_agree = m.width >= 0 && m.height >= 0 &&
                           std::int64_t{m.width} * m.height == m.num_cells &&
                           has_size(m.cells, m.num_cells);
  return first_of(sizes_agree && m.meters_per_cell > 0.0F,
                  all_finite(m.origin_x, m.origin_y, m.meters_per_cell),
                  all_within(bounds::kPosition_m, m.origin_x, m.origin_y) &&
                      all_within(bounds::kLength_m, m.meters_per_cell));
}

RejectReason validate(const particles_t& m) {
  const bool particles_finite = std::ranges::all_of(m.particles, [](const particle_t& p) {
    return all_finite(p.pose.x, p.pose.y, p.pose.theta, p.parent_pose.x, p.parent_pose.y,
                      p.parent_pose.theta, p.weight);
  });
  const bool particles_within = std::ranges::all_of(m.particles, [](const particle_t& p) {
    return is_within(p.pose) && is_within(p.parent_pose);
  });
  return first_of(has_size(m.particles, m.num_particles), particles_finite, particles_within);
}

RejectReason validate(const planar_lidar_t& m) {
  const bool sizes_agree = m.nranges >= 1 && m.nranges <= bounds::kBeams &&
                           has_size(m.ranges, m.nranges) &&
                           (m.nintensities == 0 || m.nintensities == m.nranges) &&
                           has_size(m.intensities, m.nintensities);
  return first_of(sizes_agree, all_finite(m.rad0, m.radstep),
                  are_ranges_within(m.ranges) && all_within(bounds::kAngle_rad, m.rad0, m.radstep));
}

RejectReason validate(const pose2D_t& m) {
  return first_of(true, all_finite(m.x, m.y, m.theta), is_within(m));
}

RejectReason validate(const pose_graph_t& m) {
  const bool vertices_finite =
      std::ranges::all_of(m.vertices, [](const auto& vertex) { return finite(vertex); });
  const bool edges_finite = std::ranges::all_of(m.edges, [](const graph_edge_t& edge) {
    return finite(edge.pose) && finite(edge.information);
  });
  const bool vertices_within = std::ranges::all_of(m.vertices, [](const auto& vertex) {
    return is_pose_within(vertex[0], vertex[1], vertex[2]);
  });
  const bool edges_within = std::ranges::all_of(m.edges, [](const graph_edge_t& edge) {
    return is_pose_within(edge.pose[0], edge.pose[1], edge.pose[2]);
  });
  const bool edges_agree = std::ranges::all_of(m.edges, [](const graph_edge_t& edge) {
    return edge.from_vertex >= 0 && edge.to_vertex >= 0;
  });
  return first_of(has_size(m.vertices, m.num_vertices) && has_size(m.edges, m.num_edges) &&
                      edges_agree && m.part >= 0 && m.part < m.num_parts,
                  vertices_finite && edges_finite, vertices_within && edges_within);
}

RejectReason validate(const process_status_t& m) {
  const bool kinds_known = std::ranges::all_of(m.counters, [](const counter_t& counter) {
    return counter.kind >= counter_t::KIND_EVENT && counter.kind <= counter_t::KIND_REJECTION;
  });
  return first_of(has_size(m.counters, m.num_counters) && kinds_known, true);
}

RejectReason validate(const reply_t& m) {
  return first_of(m.state == reply_t::STATE_DONE || m.state == reply_t::STATE_REFUSED, true);
}

RejectReason validate(const slam_estimate_t& m) {
  return first_of(
      m.num_particles >= 0 && m.health >= slam_estimate_t::HEALTH_UNKNOWN &&
          m.health <= slam_estimate_t::HEALTH_LOST,
      all_finite(m.x_m, m.y_m, m.theta_rad, m.effective_particles, m.weak_information) &&
          finite(m.covariance) && finite(m.information) && finite(m.weak_axis),
      is_pose_within(m.x_m, m.y_m, m.theta_rad));
}

RejectReason validate(const slam_status_t&) {
  return RejectReason::kNone;
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
                  poses_finite, std::ranges::all_of(m.poses, is_within));
}

RejectReason validate(const twist2D_t& m) {
  return first_of(
      true, all_finite(m.vx, m.vy, m.wz),
      all_within(bounds::kSpeed_mps, m.vx, m.vy) && all_within(bounds::kTurnRate_radps, m.wz));
}

}  // namespace waymark
