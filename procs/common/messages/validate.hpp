// SPDX-License-Identifier: BSD-3-Clause
// The semantic check of each message type: array sizes agree, numbers are finite where they must
// be and within bounds.hpp.
#pragma once

#include "common/messages/channels.hpp"
#include "common/messages/reject_reason.hpp"

namespace waymark {

/// kNone for a valid message. Used after decoding and before encoding.
RejectReason validate(const ack_t& message);
RejectReason validate(const annotated_scan_t& message);
RejectReason validate(const calibration_t& message);
/// Always kNone: slam answers an invalid command with the reason.
RejectReason validate(const command_t& message);
RejectReason validate(const correction_t& message);
RejectReason validate(const findings_t& message);
RejectReason validate(const image_t& message);
RejectReason validate(const lidar_t& message);
RejectReason validate(const map_changes_t& message);
RejectReason validate(const map_header_t& message);
RejectReason validate(const map_tiles_t& message);
RejectReason validate(const map_walls_t& message);
RejectReason validate(const marker_detections_t& message);
RejectReason validate(const marker_map_t& message);
RejectReason validate(const mbot_slam_reset_t& message);
RejectReason validate(const occupancy_grid_t& message);
RejectReason validate(const particles_t& message);
RejectReason validate(const planar_lidar_t& message);
RejectReason validate(const pose2D_t& message);
RejectReason validate(const pose_graph_t& message);
RejectReason validate(const process_status_t& message);
RejectReason validate(const reply_t& message);
RejectReason validate(const slam_estimate_t& message);
RejectReason validate(const slam_status_t& message);
RejectReason validate(const tick_t& message);
RejectReason validate(const trajectory_t& message);
RejectReason validate(const twist2D_t& message);

}  // namespace waymark
