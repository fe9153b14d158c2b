// SPDX-License-Identifier: BSD-3-Clause
// Trajectories, markers, changes and findings as text files.
#pragma once

#include "viewer/core/scene/scene.hpp"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace waymark::viewer {

/// TUM format: `t x y z qx qy qz qw`, one line per pose, z = 0, t [s] with six decimals.
std::string tum_text(std::span<const TimedPose> path);
std::string tum_text(std::span<const EstimatedPose> path);

/// `t,cxx,cxy,cxt,cyy,cyt,ctt,health`: covariance of (x, y, theta) in the map frame for each line
/// of the trajectory [m^2, m rad, rad^2]; health as the number in lcmtypes/slam_estimate_t.lcm.
std::string covariance_csv_text(std::span<const EstimatedPose> path);

/// `id,instance,x_m,y_m,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad,sightings,state`, sorted by
/// id and instance.
std::string markers_csv_text(std::vector<Landmark> landmarks);

/// `change,id,instance,x_m,y_m,yaw_rad,was_x_m,was_y_m,size_m,sigmas,support`: one line for each
/// difference from the loaded map or the survey; id is -1 for walls.
std::string changes_csv_text(std::span<const MapChange> changes);

/// `{NAME: {"value": number, "share": number or null, "text": "..."}, ...}`.
std::string findings_json_text(std::span<const Finding> findings);

/// "marker_moved", "wall_gone", ...
std::string_view name_of(MapChange::Kind kind);

}  // namespace waymark::viewer
