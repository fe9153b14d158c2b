// SPDX-License-Identifier: BSD-3-Clause
#include "drawn_drive/drive.hpp"

#include "common/geometry/angle.hpp"
#include "common/geometry/squared.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace waymark::drawn {
namespace {

using Eigen::Vector2d;

constexpr double kNoReturn_m = 81.83;
constexpr double kPerson_m = 0.22;
constexpr double kPersonSpeed_mps = 1.0;
constexpr double kPersonKeeps_m = 0.7;  // from the robot

/// To a person; nothing where the ray passes.
std::optional<double> range_to(const Vector2d& person, const Vector2d& from, double direction_rad) {
  const Vector2d ray{std::cos(direction_rad), std::sin(direction_rad)};
  const Vector2d away = person - from;
  const double along_m = away.dot(ray);
  const double aside2_m2 = away.squaredNorm() - squared(along_m);
  if (along_m <= 0.0 || aside2_m2 > squared(kPerson_m)) return std::nullopt;
  return along_m - std::sqrt(squared(kPerson_m) - aside2_m2);
}

}  // namespace

Drive::Drive(const DriveOptions& options, Random& random)
    : options_{options},
      random_{random},
      building_{Building::draw(options.kind, random)},
      routes_{building_},
      robot_{routes_.place(random)},
      odometry_{options.odometry_noise, random} {
  for (int i = 0; i < options.people; ++i)
    people_.push_back(routes_.place(random));
}

std::vector<TruePose> Drive::write(fmt::ostream& log) {
  std::vector<TruePose> truth;
  double driven_m = 0.0;
  for (double time_s = 0.0; driven_m < options_.length_m; time_s += kStep_s) {
    if (robot_.has_arrived()) robot_.follow(routes_.way(robot_.pose().translation(), goal(truth)));
    robot_.step(options_.speed_mps, routes_);
    driven_m += robot_.last_step().x();
    odometry_.add(robot_.last_step(), random_);
    for (Vector2d& person : people_)
      walk(person);
    if (time_s < options_.period_s * static_cast<double>(truth.size())) continue;
    truth.push_back({time_s, robot_.pose()});
    write_scan(log, time_s);
  }
  return truth;
}

/// Mostly where it was not yet.
Vector2d Drive::goal(const std::vector<TruePose>& truth) {
  Vector2d best = routes_.place(random_);
  double best_m = 0.0;
  for (int i = 0; i < 12; ++i) {
    const Vector2d place = routes_.place(random_);
    double nearest_m = 1e6;
    for (const TruePose& seen : truth)
      nearest_m = std::min(nearest_m, (seen.pose.translation() - place).norm());
    if (nearest_m <= best_m) continue;
    best_m = nearest_m;
    best = place;
  }
  return random_.uniform() < 0.7 ? best : routes_.place(random_);
}

/// About the robot, and out of its way.
void Drive::walk(Vector2d& person) {
  const Vector2d away = person - robot_.pose().translation();
  const double wish_rad = random_.uniform(0.0, 2.0 * std::numbers::pi);
  const Vector2d wish = Vector2d{std::cos(wish_rad), std::sin(wish_rad)} - 0.3 * away;
  const Vector2d way = away.norm() < kPersonKeeps_m ? away : wish;
  const Vector2d there = person + kStep_s * kPersonSpeed_mps * way.normalized();
  if (routes_.clearance_m(there) > kPerson_m || away.norm() > 10.0) person = there;
}

void Drive::write_scan(fmt::ostream& log, double time_s) {
  const Se2& pose = robot_.pose();
  const double view_rad = radians(options_.view_deg);
  // The old format has no angles: 181 and 361 beams are over 180 degrees.
  const bool is_old =
      options_.view_deg == 180.0 && (options_.beams == 181 || options_.beams == 361);
  if (is_old) {
    log.print("FLASER {}", options_.beams);
  } else {
    log.print("ROBOTLASER1 0 {:.8f} {:.8f} {:.8f} {:.2f} 0.01 0 {}", -0.5 * view_rad, view_rad,
              view_rad / (options_.beams - 1), kNoReturn_m, options_.beams);
  }
  for (int i = 0; i < options_.beams; ++i) {
    const double direction_rad =
        pose.theta() + view_rad * (static_cast<double>(i) / (options_.beams - 1) - 0.5);
    double range_m = building_.range_m(pose.translation(), direction_rad, options_.range_m);
    for (const Vector2d& person : people_)
      if (const auto at = range_to(person, pose.translation(), direction_rad))
        range_m = std::min(range_m, *at);
    const double measured_m = std::max(0.05, range_m + random_.normal(0.0, options_.range_sigma_m));
    log.print(" {:.2f}", range_m < options_.range_m ? measured_m : kNoReturn_m);
  }
  const Se2& odom = odometry_.pose();
  if (!is_old) log.print(" 0");
  for (int i = 0; i < 2; ++i)
    log.print(" {:.6f} {:.6f} {:.6f}", odom.x(), odom.y(), odom.theta());
  if (!is_old) log.print(" 0 0 0 0 0");
  log.print(" {:.6f} nohost {:.6f}\n", 1000.0 + time_s, time_s);
}

}  // namespace waymark::drawn
