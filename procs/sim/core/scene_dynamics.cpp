// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/scene_dynamics.hpp"

#include "sim/core/world/mjcf.hpp"

#include <string>

namespace waymark {
namespace {

constexpr double kStandBefore_s = 1.0;  // time from the stop until the robot is lifted
constexpr double kStandAfter_s = 1.0;
const Eigen::Vector3d kOutOfSight_m{0.0, 0.0, -100.0};  // deep under the floor

}  // namespace

void KidnapConfig::describe(Fields& fields) {
  when.describe(fields);
  fields.field("to_x_m", to_x_m, kAnyNumber, "where it is put down, world frame");
  fields.field("to_y_m", to_y_m, kAnyNumber, "where it is put down");
  fields.field("to_yaw_rad", to_yaw_rad, {-7.0, 7.0}, "heading there");
}

SceneDynamics::SceneDynamics(const World& world)
    : markers_{world.markers},
      moved_by_m_(world.markers.size(), Eigen::Vector2d::Zero()),
      moves_{world.moves},
      boxes_{world.boxes},
      is_shown_(world.boxes.size(), true) {}

std::vector<MovedMarker> SceneDynamics::update(Timestamp time, const Moment& moment,
                                               Physics& physics) {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const bool is_present = boxes_[i].present.covers(moment);
    if (is_present == is_shown_[i]) continue;
    is_shown_[i] = is_present;
    physics.displace(body_of(mjcf_names::kBoxPrefix + std::to_string(i)),
                     is_present ? Eigen::Vector3d::Zero() : kOutOfSight_m);
  }
  std::vector<MovedMarker> moved;
  for (auto move = moves_.begin(); move != moves_.end();) {
    if (!move->when.is_reached(moment)) {
      ++move;
      continue;
    }
    MarkerPlate& marker = markers_[move->marker];
    marker.centre_m.head<2>() += move->by_m;
    moved_by_m_[move->marker] += move->by_m;
    physics.displace(body_of(mjcf_names::kMarkerPrefix + std::to_string(move->marker)),
                     {moved_by_m_[move->marker].x(), moved_by_m_[move->marker].y(), 0.0});
    moved.push_back({time, marker});
    move = moves_.erase(move);
  }
  return moved;
}

Kidnapper::RobotState Kidnapper::update(const Moment& moment, Physics& physics) {
  if (kidnaps_.empty()) return RobotState::kFree;
  const KidnapConfig& kidnap = kidnaps_.front();
  if (held_since_s_ < 0.0) {
    if (!kidnap.when.is_reached(moment)) return RobotState::kFree;
    held_since_s_ = moment.time_s;
    has_moved_ = false;
  }
  const double held_s = moment.time_s - held_since_s_;
  if (!has_moved_ && held_s >= kStandBefore_s) {
    physics.put_down(kidnap.world_from_there());
    has_moved_ = true;
  }
  if (held_s < kStandBefore_s + kStandAfter_s) return RobotState::kHeld;
  kidnaps_.erase(kidnaps_.begin());
  held_since_s_ = -1.0;
  return RobotState::kReleased;
}

}  // namespace waymark
