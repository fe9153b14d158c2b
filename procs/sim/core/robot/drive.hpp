// SPDX-License-Identifier: BSD-3-Clause
// The robot's velocity: from following a route, or from DRIVE_COMMAND messages.
#pragma once

#include "common/config/config.hpp"
#include "common/geometry/se2.hpp"
#include "common/robot/robot_config.hpp"
#include "common/time/time.hpp"
#include "sim/core/robot/path.hpp"
#include "sim/core/robot/physics.hpp"

#include <map>
#include <vector>

namespace waymark {

struct Velocity {
  double forward_mps{0.0};
  double turn_radps{0.0};
};

/// Wheel speeds [rad/s] for a velocity of the base, without slip.
WheelPair wheel_speeds(const BaseConfig& base, const Velocity& velocity);

enum class DriveSource { kRoute, kCommand };

struct Waypoint {
  double x_m{0.0};
  double y_m{0.0};

  void describe(Fields& fields);
};

/// Start and path of the robot, world frame.
struct RouteConfig {
  DriveSource source{DriveSource::kRoute};
  double start_x_m{1.0};
  double start_y_m{0.0};
  double start_yaw_rad{0.0};
  double end_x_m{49.0};
  double speed_mps{0.1};
  double acceleration_mps2{0.2};
  double turn_speed_radps{0.5};
  double corner_radius_m{0.0};
  double settle_s{1.0};
  double duration_s{0.0};
  int command_delay_ticks{8};
  int laps{1};
  std::vector<Waypoint> waypoints{};

  Se2 world_from_start() const { return {start_x_m, start_y_m, start_yaw_rad}; }

  /// The points to visit after the start: the waypoints in every lap, or the end at end_x_m.
  std::vector<Eigen::Vector2d> points() const;
  /// The start of the route, followed by points().
  std::vector<Eigen::Vector2d> corners() const;
  void describe(Fields& fields);
};

/// Follows the route: turns on the spot at its start and at sharp corners, drives through rounded
/// corners, keeps to the path, and brakes before a stop.
class RouteFollower {
 public:
  RouteFollower(const RouteConfig& config, double period_s);

  /// The velocity for the next control period. Call once per period.
  /// @param world_from_base  the true pose.
  Velocity next(const Se2& world_from_base);

  /// Starts again from standstill, with a turn on the spot towards the present piece of the path.
  /// To be called after a kidnap.
  void begin_anew();

  /// True when the robot stands at the last point.
  bool arrived() const { return target_ >= path_.size(); }

  double route_length_m() const { return route_length_m_; }

  /// Time in which the robot must arrive: route.duration_s if it is set; else three times the time
  /// for driving and turning at the route's speeds and accelerations, plus a minute.
  double time_limit_s() const { return time_limit_s_; }

  /// Length of the route up to the robot's projection onto it.
  double progress_m() const { return progress_m_; }

 private:
  Velocity drive(const PathPlace& place);
  Velocity turn(double heading_error_rad);
  double greatest_speed_mps(const PathPiece& piece) const;
  double travel_time_s() const;
  void begin_next_piece();

  RouteConfig config_;
  double period_s_;
  std::vector<PathPiece> path_;
  std::size_t target_{0};
  bool turning_{true};
  double speed_mps_{0.0};
  double turn_speed_radps_{0.0};
  double steer_radps_{0.0};
  double route_length_m_{0.0};
  double time_limit_s_{0.0};
  double finished_pieces_m_{0.0};
  double progress_m_{0.0};
};

/// What happens to a velocity command.
enum class CommandOutcome {
  kInTime,
  kLate,      ///< received after the time at which it should act; acts at once
  kOutdated,  ///< ignored: a command with a newer stamp has acted already
  kTooMany,   ///< ignored: too many commands wait for their time to act
};

/// Lets each velocity command act a fixed delay after its stamp; the robot then approaches the
/// commanded velocity within its acceleration limit.
class CommandFollower {
 public:
  CommandFollower(const RouteConfig& config, Duration delay, double period_s);

  CommandOutcome receive(Timestamp stamp, const Velocity& velocity);

  /// The velocity at `now`. Call in order of time.
  Velocity next(Timestamp now);

 private:
  RouteConfig config_;
  Duration delay_;
  double period_s_;
  Timestamp now_{};
  std::map<Timestamp, Velocity> pending_;  ///< keyed by the time at which they act
  Timestamp wanted_since_{};               ///< time from which `wanted_` acts
  Velocity wanted_{};
  Velocity current_{};
};

}  // namespace waymark
