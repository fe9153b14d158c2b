// SPDX-License-Identifier: BSD-3-Clause
#include "slam/slam_messages.hpp"

#include "common/messages/codec.hpp"
#include "common/messages/convert.hpp"
#include "slam/in_parts.hpp"

#include <algorithm>

namespace waymark {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

static_assert(static_cast<int>(Health::kInitialising) == slam_estimate_t::HEALTH_INITIALISING &&
              static_cast<int>(Health::kTracking) == slam_estimate_t::HEALTH_TRACKING &&
              static_cast<int>(Health::kDegenerate) == slam_estimate_t::HEALTH_DEGENERATE &&
              static_cast<int>(Health::kLost) == slam_estimate_t::HEALTH_LOST);
static_assert(static_cast<int>(WeakAxisSource::kOdometry) == slam_estimate_t::SOURCE_ODOMETRY &&
              static_cast<int>(WeakAxisSource::kMarkers) == slam_estimate_t::SOURCE_MARKERS &&
              static_cast<int>(WeakAxisSource::kNothing) == slam_estimate_t::SOURCE_NOTHING);

static_assert(static_cast<int>(MapChange::Kind::kMarkerMoved) == map_change_t::KIND_MARKER_MOVED &&
              static_cast<int>(MapChange::Kind::kMarkerMissing) ==
                  map_change_t::KIND_MARKER_MISSING &&
              static_cast<int>(MapChange::Kind::kMarkerNew) == map_change_t::KIND_MARKER_NEW &&
              static_cast<int>(MapChange::Kind::kWallNew) == map_change_t::KIND_WALL_NEW &&
              static_cast<int>(MapChange::Kind::kWallGone) == map_change_t::KIND_WALL_GONE &&
              static_cast<int>(MapChange::Kind::kSurveyOff) == map_change_t::KIND_SURVEY_OFF);

constexpr std::size_t kBeamsPerMessage = 5400;      // 12 bytes each
constexpr std::size_t kParticlesPerMessage = 1300;  // 48 bytes each
constexpr std::size_t kLandmarksPerMessage = 500;   // 125 bytes each
constexpr std::size_t kPosesPerMessage = 3000;      // 20 bytes each
constexpr std::size_t kVerticesPerMessage = 500;    // 24 bytes each, and as many edges of 80 bytes
constexpr std::size_t kChangesPerMessage = 900;     // 69 bytes each

marker_landmark_t to_message(const Landmark& landmark) {
  marker_landmark_t message{};
  message.id = landmark.id;
  message.instance = landmark.instance;
  message.x_m = landmark.map_from_marker.x();
  message.y_m = landmark.map_from_marker.y();
  message.yaw_rad = landmark.map_from_marker.theta();
  Eigen::Map<RowMajor3>{message.covariance} = landmark.covariance;
  message.sightings = landmark.sightings;
  message.first_seen_utime = to_us(landmark.first_seen);
  message.last_seen_utime = to_us(landmark.last_seen);
  message.state = marker_landmark_t::STATE_TENTATIVE;
  if (landmark.is_confirmed()) message.state = marker_landmark_t::STATE_CONFIRMED;
  if (landmark.was_moved) message.state = marker_landmark_t::STATE_MOVED;
  return message;
}

graph_edge_t to_message(const GraphEdge& edge) {
  graph_edge_t message{};
  message.from_vertex = static_cast<std::int32_t>(edge.from);
  message.to_vertex = static_cast<std::int32_t>(edge.to);
  message.pose[0] = edge.from_from_to.x();
  message.pose[1] = edge.from_from_to.y();
  message.pose[2] = edge.from_from_to.theta();
  std::size_t at = 0;
  for (Eigen::Index row = 0; row < 3; ++row)
    for (Eigen::Index column = row; column < 3; ++column)
      message.information[at++] = edge.information(row, column);
  return message;
}

}  // namespace

slam_estimate_t to_message(const Estimate& estimate) {
  slam_estimate_t message{};
  message.utime = to_us(estimate.time);
  message.has_pose = estimate.has_pose ? 1 : 0;
  message.x_m = estimate.map_from_base.x();
  message.y_m = estimate.map_from_base.y();
  message.theta_rad = estimate.map_from_base.theta();
  Eigen::Map<RowMajor3>{message.covariance} = estimate.covariance;
  message.health = static_cast<std::int8_t>(estimate.health);
  message.num_particles = static_cast<std::int32_t>(estimate.num_particles);
  message.effective_particles = estimate.effective_particles;
  message.beams_on_markers = estimate.beams_on_markers;
  message.markers_in_view = estimate.markers_in_view;
  const Observability& walls = estimate.observability;
  Eigen::Map<RowMajor3>{message.information} = walls.information;
  message.weak_information = walls.weak_information;
  if (walls.is_degenerate) {
    message.weak_axis[0] = walls.weak_direction.x();
    message.weak_axis[1] = walls.weak_direction.y();
    message.weak_axis_source = static_cast<std::int8_t>(estimate.weak_axis_source);
  }
  return message;
}

std::int64_t new_map_id(Timestamp first_observation, std::int64_t parent_map_id) {
  Message named;
  for (const std::int64_t part : {to_us(first_observation), parent_map_id})
    for (int byte = 0; byte < 8; ++byte)
      named.payload.push_back(
          static_cast<std::uint8_t>(static_cast<std::uint64_t>(part) >> (8 * byte)));
  const std::int64_t id = content_hash(named);
  return id == 0 ? 1 : id;
}

annotated_scan_t to_message(const LidarScan& scan, const Observation& observation,
                            const Se2& map_from_lidar) {
  annotated_scan_t message{};
  message.utime = to_us(scan.time);
  message.x_m = map_from_lidar.x();
  message.y_m = map_from_lidar.y();
  message.theta_rad = map_from_lidar.theta();
  const std::size_t step = (scan.ranges_m.size() + kBeamsPerMessage - 1) / kBeamsPerMessage;
  for (std::size_t beam = 0; beam < scan.ranges_m.size(); beam += step) {
    message.ranges.push_back(static_cast<float>(scan.ranges_m[beam]));
    message.angles.push_back(static_cast<float>(scan.angles_rad[beam]));
  }
  message.num_beams = static_cast<std::int32_t>(message.ranges.size());
  message.marker_ids.assign(message.ranges.size(), kNoMarker);
  for (const AnnotatedBeam& annotated : observation.beams) {
    const auto beam = static_cast<std::size_t>(annotated.beam.index);
    if (beam % step == 0) message.marker_ids[beam / step] = annotated.marker_id;
  }
  return message;
}

particles_t to_message(std::span<const PublishedParticle> particles, Timestamp time) {
  const std::size_t count = std::min(particles.size(), kParticlesPerMessage);
  particles_t message{};
  message.utime = to_us(time);
  message.num_particles = static_cast<std::int32_t>(count);
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const PublishedParticle& particle = particles[i * particles.size() / count];
    particle_t& sent = message.particles.emplace_back();
    sent.pose = to_pose_message(time, particle.map_from_base);
    sent.parent_pose = to_pose_message(time, particle.previous_map_from_base);
    sent.weight = particle.weight;
    sum += particle.weight;
  }
  if (sum > 0.0) {
    for (particle_t& sent : message.particles)
      sent.weight /= sum;
  }
  return message;
}

std::vector<marker_map_t> to_messages(std::span<const Landmark> landmarks, Timestamp time) {
  return in_parts<marker_map_t>(std::max<std::size_t>(1, landmarks.size()), kLandmarksPerMessage,
                                time, [&](marker_map_t& message, const Part& part) {
                                  for (const Landmark& landmark : part.of(landmarks))
                                    message.landmarks.push_back(to_message(landmark));
                                  message.num_landmarks =
                                      static_cast<std::int32_t>(message.landmarks.size());
                                });
}

findings_t to_message(std::span<const Finding> findings, Timestamp time, std::int64_t map_id) {
  findings_t message{};
  message.utime = to_us(time);
  message.map_id = map_id;
  for (const Finding& finding : findings) {
    finding_t& sent = message.findings.emplace_back();
    sent.name = finding.name;
    sent.text = finding.text;
    sent.value = finding.value;
    sent.share = finding.share.value_or(-1.0);
  }
  message.num_findings = static_cast<std::int32_t>(message.findings.size());
  return message;
}

map_changes_t to_message(std::span<const MapChange> changes, Timestamp time, std::int64_t map_id) {
  map_changes_t message{};
  message.utime = to_us(time);
  message.map_id = map_id;
  for (const MapChange& change : changes.first(std::min(changes.size(), kChangesPerMessage))) {
    map_change_t& sent = message.changes.emplace_back();
    sent.kind = static_cast<std::int8_t>(change.kind);
    sent.id = change.id;
    sent.instance = change.instance;
    sent.x_m = change.place.x();
    sent.y_m = change.place.y();
    sent.yaw_rad = change.place.theta();
    sent.was_x_m = change.was_at.x();
    sent.was_y_m = change.was_at.y();
    sent.size_m = change.size_m;
    sent.sigmas = change.sigmas;
    sent.support = change.support;
  }
  message.num_changes = static_cast<std::int32_t>(message.changes.size());
  return message;
}

std::vector<trajectory_t> to_messages(std::span<const TimedPose> trajectory) {
  const Timestamp time = trajectory.empty() ? Timestamp{} : trajectory.back().time;
  return in_parts<trajectory_t>(
      trajectory.size(), kPosesPerMessage, time, [&](trajectory_t& message, const Part& part) {
        for (const TimedPose& pose : part.of(trajectory))
          message.poses.push_back(to_pose_message(pose.time, pose.map_from_base));
        message.num_poses = static_cast<std::int32_t>(message.poses.size());
      });
}

std::vector<pose_graph_t> to_messages(const PoseGraph& graph, Timestamp time) {
  const std::size_t items = std::max({graph.poses.size(), graph.edges.size(), std::size_t{1}});
  return in_parts<pose_graph_t>(
      items, kVerticesPerMessage, time, [&](pose_graph_t& message, const Part& part) {
        for (const Se2& pose : part.of(graph.poses))
          message.vertices.push_back({pose.x(), pose.y(), pose.theta()});
        for (const GraphEdge& edge : part.of(graph.edges))
          message.edges.push_back(to_message(edge));
        message.num_vertices = static_cast<std::int32_t>(message.vertices.size());
        message.num_edges = static_cast<std::int32_t>(message.edges.size());
      });
}

}  // namespace waymark
