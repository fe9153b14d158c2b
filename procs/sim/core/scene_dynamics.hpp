// SPDX-License-Identifier: BSD-3-Clause
// Changes of the world during a run: boxes, moved markers, kidnaps.
#pragma once

#include "common/config/config.hpp"
#include "common/geometry/se2.hpp"
#include "common/time/time.hpp"
#include "sim/core/robot/physics.hpp"
#include "sim/core/span.hpp"
#include "sim/core/world/world.hpp"

#include <vector>

namespace waymark {

/// A kidnap: the robot is stopped, lifted and put down elsewhere, its wheels standing still. It
/// then turns towards the piece of the route that it was following and follows that piece again, so
/// it should be put down near that piece.
struct KidnapConfig {
  Trigger when{};
  double to_x_m{0.0};
  double to_y_m{0.0};
  double to_yaw_rad{0.0};

  Se2 world_from_there() const { return {to_x_m, to_y_m, to_yaw_rad}; }

  void describe(Fields& fields);
};

/// A marker that has been moved, with its new place.
struct MovedMarker {
  Timestamp time{};
  MarkerPlate marker{};
};

/// Boxes that appear and disappear, markers that are moved.
class SceneDynamics {
 public:
  explicit SceneDynamics(const World& world);

  /// Shows and hides boxes and moves markers in the physics model.
  /// @return the markers moved by this call.
  std::vector<MovedMarker> update(Timestamp time, const Moment& moment, Physics& physics);

 private:
  std::vector<MarkerPlate> markers_;
  std::vector<Eigen::Vector2d> moved_by_m_;  ///< displacement of each marker so far
  std::vector<MarkerMove> moves_;            ///< moves still to come
  std::vector<BoxConfig> boxes_;
  std::vector<bool> is_shown_;
};

/// Executes the kidnaps, one after the other.
class Kidnapper {
 public:
  explicit Kidnapper(const std::vector<KidnapConfig>& kidnaps) : kidnaps_{kidnaps} {}

  enum class RobotState { kFree, kHeld, kReleased };

  /// Call at every physics step.
  /// @return kHeld: the robot must be commanded to stand; kReleased: once, at the end of a kidnap.
  RobotState update(const Moment& moment, Physics& physics);

 private:
  std::vector<KidnapConfig> kidnaps_;  ///< kidnaps still to come, in order
  double held_since_s_{-1.0};
  bool has_moved_{false};
};

}  // namespace waymark
