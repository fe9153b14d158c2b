// SPDX-License-Identifier: BSD-3-Clause
// What other people do in the robot's world during the run.
#pragma once

#include "common/config/config.hpp"
#include "common/geometry/se2.hpp"
#include "common/time/time.hpp"
#include "sim/core/robot/physics.hpp"
#include "sim/core/span.hpp"
#include "sim/core/world/world.hpp"

#include <vector>

namespace waymark {

/// Somebody stops the robot, lifts it and puts it down elsewhere; its wheels do not notice. It then
/// turns to its route and goes on from there, so the place should be beside the same line.
struct KidnapConfig {
  Trigger when{};
  double to_x_m{0.0};
  double to_y_m{0.0};
  double to_yaw_rad{0.0};

  Se2 world_from_there() const { return {to_x_m, to_y_m, to_yaw_rad}; }

  void describe(Fields& fields);
};

/// A marker hangs elsewhere from now on.
struct MovedMarker {
  Timestamp time{};
  MarkerPlate marker{};
};

/// Boxes that come and go, markers that move.
class SceneDynamics {
 public:
  explicit SceneDynamics(const World& world);

  /// Brings the model up to date. Returns the markers that have just moved, as they hang now.
  std::vector<MovedMarker> update(Timestamp time, const Moment& moment, Physics& physics);

 private:
  std::vector<MarkerPlate> markers_;
  std::vector<Eigen::Vector2d> moved_by_m_;  ///< each marker so far
  std::vector<MarkerMove> moves_;            ///< still to come
  std::vector<BoxConfig> boxes_;
  std::vector<bool> is_shown_;
};

/// Stops the robot, moves it, lets it go: one kidnap after the other.
class Kidnapper {
 public:
  explicit Kidnapper(const std::vector<KidnapConfig>& kidnaps) : kidnaps_{kidnaps} {}

  enum class Grip { kNone, kHeld, kReleased };

  /// Call at every step. While held the robot must stand; released comes once, when it may go on.
  Grip update(const Moment& moment, Physics& physics);

 private:
  std::vector<KidnapConfig> kidnaps_;  ///< the first one is the next
  double held_since_s_{-1.0};
  bool has_moved_{false};
};

}  // namespace waymark
