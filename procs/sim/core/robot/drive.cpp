// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/robot/drive.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace waymark {
namespace {

// Steering onto a line at speed v: turn rate = -v (kOffsetGain * offset + kHeadingGain * heading
// error). kHeadingGain = 2 sqrt(kOffsetGain) is critical damping: offsets decay within about 1 m.
constexpr double kOffsetGain_per_m2 = 4.0;
constexpr double kHeadingGain_per_m = 4.0;
constexpr double kAligned_rad = 0.002;           // heading error at which a turn on the spot ends
constexpr double kTurnAcceleration_per_m = 5.0;  // turn acceleration / forward acceleration
constexpr double kArrived_m = 0.001;
constexpr double kSlowestShare = 0.1;  // least share of the speed, so that a braking robot arrives
constexpr double kSteeringReserve = 0.8;  // arcs use this share of the turn speed
constexpr std::size_t kMaxPendingCommands = 10'000;
constexpr double kTimeLimitFactor = 3.0;
constexpr double kTimeReserve_s = 60.0;

/// Upper bound of the time from rest to rest over a distance or an angle. The second term is the
/// time that RouteFollower needs for a turn without a limit of the speed; driving needs less.
double longest_time_s(double way, double speed, double acceleration) {
  return way / speed + std::sqrt(6.0 * way / acceleration);
}

}  // namespace

WheelPair wheel_speeds(const BaseConfig& base, const Velocity& velocity) {
  const double half_separation = 0.5 * base.wheel_separation_m;
  return {(velocity.forward_mps - half_separation * velocity.turn_radps) / base.wheel_radius_m,
          (velocity.forward_mps + half_separation * velocity.turn_radps) / base.wheel_radius_m};
}

void Waypoint::describe(Fields& fields) {
  fields.field("x_m", x_m, kAnyNumber, "world frame");
  fields.field("y_m", y_m, kAnyNumber, "world frame");
}

void RouteConfig::describe(Fields& fields) {
  fields.choice("source", source,
                {{"route", DriveSource::kRoute}, {"command", DriveSource::kCommand}},
                "who drives: the route below, or DRIVE_COMMAND messages");
  fields.field("start_x_m", start_x_m, kAnyNumber, "where the base begins, world frame");
  fields.field("start_y_m", start_y_m, kAnyNumber, "where the base begins");
  fields.field("start_yaw_rad", start_yaw_rad, {-7.0, 7.0}, "heading at the beginning");
  fields.field("end_x_m", end_x_m, kAnyNumber, "drive straight to this x; unless waypoints");
  fields.field("speed_mps", speed_mps, {0.01, 2.0}, "the real robot tops out at 0.26");
  fields.field("acceleration_mps2", acceleration_mps2, {0.01, 10.0}, "speeding up, slowing down");
  fields.field("turn_speed_radps", turn_speed_radps, {0.01, 2.0}, "greatest turn rate");
  fields.field("corner_radius_m", corner_radius_m, {0.0, 100.0},
               "of the arcs around corners; 0 = stop and turn on the spot");
  fields.field("settle_s", settle_s, {0.0, 60.0}, "time that the robot stands at the end");
  fields.field("duration_s", duration_s, {0.0, 86400.0},
               "with source = command: length of the run; else 0 or the time limit of the route");
  fields.field("command_delay_ticks", command_delay_ticks, {1, 1000},
               "a DRIVE_COMMAND acts this many ticks after its time; more than run.window_ticks");
  fields.field("laps", laps, {1, 1000}, "how often the waypoints are visited, all in turn");
  fields.list("waypoints", waypoints, "points to visit in turn instead of end_x_m");
}

std::vector<Eigen::Vector2d> RouteConfig::points() const {
  if (waypoints.empty()) return {{end_x_m, start_y_m}};
  std::vector<Eigen::Vector2d> points_m;
  for (int lap = 0; lap < laps; ++lap)
    for (const Waypoint& waypoint : waypoints)
      points_m.emplace_back(waypoint.x_m, waypoint.y_m);
  return points_m;
}

std::vector<Eigen::Vector2d> RouteConfig::corners() const {
  std::vector<Eigen::Vector2d> corners_m = points();
  corners_m.insert(corners_m.begin(), Eigen::Vector2d{start_x_m, start_y_m});
  return corners_m;
}

RouteFollower::RouteFollower(const RouteConfig& config, double period_s)
    : config_{config}, period_s_{period_s} {
  path_ = path_through(config.corners(), config.corner_radius_m);
  for (const PathPiece& piece : path_)
    route_length_m_ += piece.length_m;
  time_limit_s_ = config.duration_s > 0.0 ? config.duration_s
                                          : kTimeReserve_s + kTimeLimitFactor * travel_time_s();
}

/// Upper bound of the time for the route, from its speeds and accelerations.
double RouteFollower::travel_time_s() const {
  double travel_s = 0.0;
  double heading_rad = config_.start_yaw_rad;
  for (const PathPiece& piece : path_) {
    const double turn_rad = angle_difference(piece.world_from_start.theta(), heading_rad);
    travel_s += longest_time_s(std::abs(turn_rad), config_.turn_speed_radps,
                               kTurnAcceleration_per_m * config_.acceleration_mps2);
    travel_s +=
        longest_time_s(piece.length_m, greatest_speed_mps(piece), config_.acceleration_mps2);
    heading_rad = piece.world_from(piece.length_m).theta();
  }
  return travel_s;
}

Velocity RouteFollower::next(const Se2& world_from_base) {
  while (!arrived()) {
    const PathPiece& piece = path_[target_];
    const PathPlace place = locate(piece, world_from_base);
    if (std::abs(place.heading_error_rad) <= kAligned_rad) turning_ = false;
    if (turning_) return turn(place.heading_error_rad);
    progress_m_ = finished_pieces_m_ + std::clamp(place.along_m, 0.0, piece.length_m);
    const double to_go_m = piece.length_m - place.along_m;
    if (to_go_m > (piece.is_smooth_end ? 0.0 : kArrived_m)) return drive(place);
    const bool stops = !piece.is_smooth_end;
    begin_next_piece();
    if (stops) return {};
  }
  return {};
}

Velocity RouteFollower::turn(double heading_error_rad) {
  // The fastest turn that can still stop in time at this acceleration.
  const double acceleration_radps2 = kTurnAcceleration_per_m * config_.acceleration_mps2;
  const double wanted_radps = std::min(
      config_.turn_speed_radps, std::sqrt(acceleration_radps2 * std::abs(heading_error_rad)));
  turn_speed_radps_ = std::min(wanted_radps, turn_speed_radps_ + acceleration_radps2 * period_s_);
  return {0.0, std::copysign(turn_speed_radps_, -heading_error_rad)};
}

double RouteFollower::greatest_speed_mps(const PathPiece& piece) const {
  if (piece.curvature_per_m == 0.0) return config_.speed_mps;
  return std::min(config_.speed_mps,
                  kSteeringReserve * config_.turn_speed_radps / std::abs(piece.curvature_per_m));
}

Velocity RouteFollower::drive(const PathPlace& place) {
  turn_speed_radps_ = 0.0;
  const PathPiece& piece = path_[target_];
  const double exit_mps = piece.is_smooth_end ? greatest_speed_mps(path_[target_ + 1]) : 0.0;
  const double to_go_m = piece.length_m - place.along_m;
  const double braking_mps =
      std::sqrt(exit_mps * exit_mps + 2.0 * config_.acceleration_mps2 * to_go_m);
  const double greatest_mps = greatest_speed_mps(piece);
  const double wanted_mps = std::clamp(braking_mps, kSlowestShare * greatest_mps, greatest_mps);
  speed_mps_ = std::min(wanted_mps, speed_mps_ + config_.acceleration_mps2 * period_s_);
  const double wanted_radps = speed_mps_ * piece.curvature_per_m -
                              speed_mps_ * (kOffsetGain_per_m2 * place.offset_m +
                                            kHeadingGain_per_m * place.heading_error_rad);
  const double limited_radps =
      std::clamp(wanted_radps, -config_.turn_speed_radps, config_.turn_speed_radps);
  const double max_change_radps = kTurnAcceleration_per_m * config_.acceleration_mps2 * period_s_;
  steer_radps_ =
      std::clamp(limited_radps, steer_radps_ - max_change_radps, steer_radps_ + max_change_radps);
  return {speed_mps_, steer_radps_};
}

void RouteFollower::begin_next_piece() {
  finished_pieces_m_ += path_[target_].length_m;
  const bool stops = !path_[target_].is_smooth_end;
  ++target_;
  if (stops) begin_anew();
}

void RouteFollower::begin_anew() {
  speed_mps_ = 0.0;
  turn_speed_radps_ = 0.0;
  steer_radps_ = 0.0;
  turning_ = true;
}

CommandFollower::CommandFollower(const RouteConfig& config, Duration delay, double period_s)
    : config_{config}, delay_{delay}, period_s_{period_s} {}

CommandOutcome CommandFollower::receive(Timestamp stamp, const Velocity& velocity) {
  const Timestamp acts_at = stamp + delay_;
  if (acts_at < wanted_since_) return CommandOutcome::kOutdated;
  if (pending_.size() >= kMaxPendingCommands) return CommandOutcome::kTooMany;
  pending_[acts_at] = velocity;
  return acts_at > now_ ? CommandOutcome::kInTime : CommandOutcome::kLate;
}

Velocity CommandFollower::next(Timestamp now) {
  now_ = now;
  while (!pending_.empty() && pending_.begin()->first <= now) {
    std::tie(wanted_since_, wanted_) = *pending_.begin();
    pending_.erase(pending_.begin());
  }
  const double max_change_mps = config_.acceleration_mps2 * period_s_;
  const double max_change_radps = kTurnAcceleration_per_m * max_change_mps;
  current_.forward_mps +=
      std::clamp(wanted_.forward_mps - current_.forward_mps, -max_change_mps, max_change_mps);
  current_.turn_radps +=
      std::clamp(wanted_.turn_radps - current_.turn_radps, -max_change_radps, max_change_radps);
  return current_;
}

}  // namespace waymark
