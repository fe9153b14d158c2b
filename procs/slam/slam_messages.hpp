// SPDX-License-Identifier: BSD-3-Clause
// The core's results as messages.
#pragma once

#include "common/messages/channels.hpp"
#include "slam/core/estimators/estimator.hpp"
#include "slam/findings_text.hpp"

#include <span>
#include <vector>

namespace waymark {

slam_estimate_t to_message(const Estimate& estimate);

/// Id of a map that is being made. Never 0.
std::int64_t new_map_id(Timestamp first_observation, std::int64_t parent_map_id);

annotated_scan_t to_message(const LidarScan& scan, const Observation& observation,
                            const Se2& map_from_lidar);

/// Particles, thinned evenly to as many as fit one datagram.
particles_t to_message(std::span<const PublishedParticle> particles, Timestamp time);

/// In parts, each of which fits one datagram; at least one.
std::vector<marker_map_t> to_messages(std::span<const Landmark> landmarks, Timestamp time);

findings_t to_message(std::span<const Finding> findings, Timestamp time, std::int64_t map_id);

/// As many changes as fit one datagram; the others are dropped.
map_changes_t to_message(std::span<const MapChange> changes, Timestamp time, std::int64_t map_id);

/// In parts, each of which fits one datagram; none for an empty trajectory.
std::vector<trajectory_t> to_messages(std::span<const TimedPose> trajectory);

/// In parts, each of which fits one datagram; at least one.
std::vector<pose_graph_t> to_messages(const PoseGraph& graph, Timestamp time);

}  // namespace waymark
