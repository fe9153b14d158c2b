// SPDX-License-Identifier: BSD-3-Clause
// All channels, each with its type. lcmtypes/README.md describes them.
#pragma once

#include <waymark/ack_t.hpp>
#include <waymark/annotated_scan_t.hpp>
#include <waymark/calibration_t.hpp>
#include <waymark/command_t.hpp>
#include <waymark/correction_t.hpp>
#include <waymark/findings_t.hpp>
#include <waymark/image_t.hpp>
#include <waymark/lidar_t.hpp>
#include <waymark/map_changes_t.hpp>
#include <waymark/map_header_t.hpp>
#include <waymark/map_tiles_t.hpp>
#include <waymark/map_walls_t.hpp>
#include <waymark/marker_detections_t.hpp>
#include <waymark/marker_map_t.hpp>
#include <waymark/mbot_slam_reset_t.hpp>
#include <waymark/occupancy_grid_t.hpp>
#include <waymark/particles_t.hpp>
#include <waymark/planar_lidar_t.hpp>
#include <waymark/pose2D_t.hpp>
#include <waymark/pose_graph_t.hpp>
#include <waymark/process_status_t.hpp>
#include <waymark/reply_t.hpp>
#include <waymark/slam_estimate_t.hpp>
#include <waymark/slam_status_t.hpp>
#include <waymark/tick_t.hpp>
#include <waymark/trajectory_t.hpp>
#include <waymark/twist2D_t.hpp>

#include <string_view>

namespace waymark {

/// Where a channel occurs.
enum class ChannelUse {
  kNetwork,
  kNetworkOnceNamed,  ///< on the network only if section [channels] gives it a name
  kMapFiles,
};

/// A channel name bound to the type that travels on it.
template <class Type>
struct Channel {
  std::string_view name;
  ChannelUse use{ChannelUse::kNetwork};
};

namespace channels {

inline constexpr Channel<image_t> kCamera{"CAMERA"};
inline constexpr Channel<planar_lidar_t> kLidar{"LIDAR"};
inline constexpr Channel<lidar_t> kMbotLidar{"LIDAR"};  // the other type that LIDAR may carry
inline constexpr Channel<pose2D_t> kOdometry{"ODOMETRY"};
inline constexpr Channel<twist2D_t> kDriveCommand{"DRIVE_COMMAND"};
inline constexpr Channel<pose2D_t> kTruePose{"TRUE_POSE"};

inline constexpr Channel<marker_detections_t> kMarkers{"MARKERS"};

inline constexpr Channel<pose2D_t> kSlamPose{"SLAM_POSE"};
inline constexpr Channel<slam_estimate_t> kSlamEstimate{"SLAM_ESTIMATE"};
inline constexpr Channel<correction_t> kSlamCorrection{"SLAM_CORRECTION"};
inline constexpr Channel<map_tiles_t> kSlamMap{"SLAM_MAP"};
inline constexpr Channel<occupancy_grid_t> kSlamGrid{"SLAM_GRID", ChannelUse::kNetworkOnceNamed};
inline constexpr Channel<marker_map_t> kSlamMarkers{"SLAM_MARKERS"};
inline constexpr Channel<map_changes_t> kSlamChanges{"SLAM_CHANGES"};
inline constexpr Channel<findings_t> kSlamFindings{"SLAM_FINDINGS"};
inline constexpr Channel<particles_t> kSlamParticles{"SLAM_PARTICLES"};
inline constexpr Channel<annotated_scan_t> kSlamScan{"SLAM_SCAN"};
inline constexpr Channel<trajectory_t> kSlamTrajectory{"SLAM_TRAJECTORY"};
inline constexpr Channel<command_t> kSlamCommand{"SLAM_COMMAND"};
inline constexpr Channel<reply_t> kSlamReply{"SLAM_REPLY"};

// Of the MBot's software: the status that we send to it, and its request to reset SLAM.
inline constexpr Channel<slam_status_t> kMbotSlamStatus{"MBOT_SLAM_STATUS",
                                                        ChannelUse::kNetworkOnceNamed};
inline constexpr Channel<mbot_slam_reset_t> kMbotSystemReset{"MBOT_SYSTEM_RESET",
                                                             ChannelUse::kNetworkOnceNamed};

// In map files; MAP_GRAPH is also published on the network, at the end of a run.
inline constexpr Channel<map_header_t> kMapHeader{"MAP_HEADER", ChannelUse::kMapFiles};
inline constexpr Channel<map_walls_t> kMapWalls{"MAP_WALLS", ChannelUse::kMapFiles};
inline constexpr Channel<pose_graph_t> kMapGraph{"MAP_GRAPH"};
inline constexpr Channel<calibration_t> kMapCalibration{"MAP_CALIBRATION", ChannelUse::kMapFiles};

inline constexpr Channel<process_status_t> kSimStatus{"SIM_STATUS"};
inline constexpr Channel<process_status_t> kDetectorStatus{"DETECTOR_STATUS"};
inline constexpr Channel<process_status_t> kSlamStatus{"SLAM_STATUS"};
inline constexpr Channel<process_status_t> kViewerStatus{"VIEWER_STATUS"};
inline constexpr Channel<process_status_t> kRecorderStatus{"RECORDER_STATUS"};

inline constexpr Channel<tick_t> kTick{"TICK"};
inline constexpr Channel<ack_t> kAck{"ACK"};

/// Calls `visit` with all of the above. (As a tuple they would cost every file a quarter of a
/// second of compile time.)
template <class Visitor>
auto visit_all(Visitor visit) {
  return visit(kCamera, kLidar, kMbotLidar, kOdometry, kDriveCommand, kTruePose, kMarkers,
               kSlamPose, kSlamEstimate, kSlamCorrection, kSlamMap, kSlamGrid, kSlamMarkers,
               kSlamChanges, kSlamFindings, kSlamParticles, kSlamScan, kSlamTrajectory,
               kSlamCommand, kSlamReply, kMbotSlamStatus, kMbotSystemReset, kMapHeader, kMapWalls,
               kMapGraph, kMapCalibration, kSimStatus, kDetectorStatus, kSlamStatus, kViewerStatus,
               kRecorderStatus, kTick, kAck);
}

}  // namespace channels
}  // namespace waymark
