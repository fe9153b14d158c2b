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

/// The robot is stopped, lifted and put down elsewhere, without any turn of its wheels. It then
/// turns towards the line of the route that it was on and follows it, so the place should be near
/// that line.
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

  /// Updates the model. @return the markers that were moved since the last call.
  std::vector<MovedMarker> update(Timestamp time, const Moment& moment, Physics& physics);

 private:
  std::vector<MarkerPlate> markers_;
  std::vector<Eigen::Vector2d> moved_by_m_;  ///< displacement of each marker so far
  std::vector<MarkerMove> moves_;            ///< still to come
  std::vector<BoxConfig> boxes_;
  std::vector<bool> is_shown_;
};

/// Executes the kidnaps, one after the other.
class Kidnapper {
 public:
  explicit Kidnapper(const std::vector<KidnapConfig>& kidnaps) : kidnaps_{kidnaps} {}

  enum class Grip { kNone, kHeld, kReleased };

  /// Call at every step. While kHeld the robot must stand; kReleased is returned once, at the end.
  Grip update(const Moment& moment, Physics& physics);

 private:
  std::vector<KidnapConfig> kidnaps_;  ///< those to come, the next one first
  double held_since_s_{-1.0};
  bool has_moved_{false};
};

}  // namespace waymark
