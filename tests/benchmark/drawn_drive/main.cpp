// SPDX-License-Identifier: BSD-3-Clause
// Drives a robot through a building that is drawn at random, and writes what it measured as a
// CARMEN log with true relations: for deploy/real_logs.sh. Plane geometry, no physics: odometry
// with wrong scales and noise, a LiDAR of 180 degrees, people who walk about the robot.
#include "common/geometry/se2.hpp"
#include "drawn_drive/routes.hpp"

#include <CLI/CLI.hpp>
#include <fmt/os.h>

#include <cmath>
#include <filesystem>
#include <numbers>
#include <optional>

namespace waymark::drawn {
namespace {

using Eigen::Vector2d;

struct Options {
  std::string kind{"office"};
  std::uint64_t seed{1};
  std::filesystem::path out{"."};
  double length_m{400.0};
  double speed_mps{0.5};
  double period_s{0.25};
  double range_m{30.0};
  double range_sigma_m{0.015};
  double odometry_noise{1.0};
  int beams{181};
  int people{0};
};

constexpr double kStep_s = 0.05;
constexpr double kNoReturn_m = 81.83;
constexpr double kAhead_m = 0.5;  // of the point that is driven to
constexpr double kPerson_m = 0.22;
constexpr double kPersonSpeed_mps = 1.0;
constexpr double kPersonKeeps_m = 0.7;  // from the robot

/// Follows ways.
class Mover {
 public:
  explicit Mover(const Vector2d& place) : pose_{place, 0.0} {}

  bool has_arrived() const { return next_ >= way_.size(); }

  void follow(std::vector<Vector2d> way) {
    way_ = std::move(way);
    next_ = 0;
  }

  void step(double speed_mps, const Routes& routes) {
    while (!has_arrived() && (way_[next_] - pose_.translation()).norm() < kAhead_m)
      ++next_;
    const Vector2d target =
        way_.empty() ? pose_.translation() : way_[std::min(next_, way_.size() - 1)];
    const Vector2d towards = pose_.inverse() * target;
    const double off_rad = std::atan2(towards.y(), towards.x());
    const double wanted_mps = std::abs(off_rad) > 0.7 ? 0.0 : speed_mps * (1.0 - std::abs(off_rad));
    speed_mps_ += std::clamp(wanted_mps - speed_mps_, -kStep_s, kStep_s);
    turn_rad_s_ += std::clamp(std::clamp(2.0 * off_rad, -1.2, 1.2) - turn_rad_s_, -3.0 * kStep_s,
                              3.0 * kStep_s);
    last_step_ = {kStep_s * speed_mps_, 0.0, kStep_s * turn_rad_s_};
    const Se2 there = pose_ * last_step_;
    if (routes.clearance_m(there.translation()) < 0.1) {
      speed_mps_ = 0.0;
      last_step_ = {0.0, 0.0, last_step_.theta()};
    }
    pose_ = pose_ * last_step_;
  }

  const Se2& pose() const { return pose_; }

  const Se2& last_step() const { return last_step_; }

 private:
  Se2 pose_;
  Se2 last_step_{};
  std::vector<Vector2d> way_{};
  std::size_t next_{0};
  double speed_mps_{0.0};
  double turn_rad_s_{0.0};
};

class Odometry {
 public:
  Odometry(double noise, Random& random)
      : noise_{noise},
        scale_{1.0 + noise * random.normal(0.0, 0.01)},
        turn_scale_{1.0 + noise * random.normal(0.0, 0.02)},
        drift_rad_per_m_{noise * random.normal(0.0, 0.002)} {}

  void add(const Se2& step, Random& random) {
    const double way_m = std::abs(step.x());
    const double rolled_m =
        scale_ * step.x() + noise_ * random.normal(0.0, 0.02 * std::sqrt(way_m));
    const double turn_sigma_rad =
        std::hypot(0.012 * std::sqrt(way_m), 0.02 * std::sqrt(std::abs(step.theta())));
    const double turned_rad = turn_scale_ * step.theta() + drift_rad_per_m_ * way_m +
                              noise_ * random.normal(0.0, turn_sigma_rad);
    pose_ = pose_ * Se2{rolled_m, 0.0, turned_rad};
  }

  const Se2& pose() const { return pose_; }

 private:
  double noise_;
  double scale_;
  double turn_scale_;
  double drift_rad_per_m_;
  Se2 pose_{};
};

/// To a person; nothing where the ray passes.
std::optional<double> range_to(const Vector2d& person, const Vector2d& from, double direction_rad) {
  const Vector2d ray{std::cos(direction_rad), std::sin(direction_rad)};
  const Vector2d away = person - from;
  const double along_m = away.dot(ray);
  const double aside2_m2 = away.squaredNorm() - along_m * along_m;
  if (along_m <= 0.0 || aside2_m2 > kPerson_m * kPerson_m) return std::nullopt;
  return along_m - std::sqrt(kPerson_m * kPerson_m - aside2_m2);
}

struct TruePose {
  double time_s{0.0};
  Se2 pose{};
};

class Drive {
 public:
  Drive(const Options& options, Random& random)
      : options_{options},
        random_{random},
        building_{Building::draw(options.kind, random)},
        routes_{building_},
        robot_{routes_.place(random)},
        odometry_{options.odometry_noise, random} {
    for (int i = 0; i < options.people; ++i)
      people_.push_back(routes_.place(random));
  }

  std::vector<TruePose> write(fmt::ostream& log) {
    std::vector<TruePose> truth;
    double driven_m = 0.0;
    for (double time_s = 0.0; driven_m < options_.length_m; time_s += kStep_s) {
      if (robot_.has_arrived())
        robot_.follow(routes_.way(robot_.pose().translation(), goal(truth)));
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

 private:
  /// Mostly where it was not yet.
  Vector2d goal(const std::vector<TruePose>& truth) {
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
  void walk(Vector2d& person) {
    const Vector2d away = person - robot_.pose().translation();
    const double wish_rad = random_.uniform(0.0, 2.0 * std::numbers::pi);
    const Vector2d wish = Vector2d{std::cos(wish_rad), std::sin(wish_rad)} - 0.3 * away;
    const double sign = away.norm() < kPersonKeeps_m ? -1.0 : 1.0;
    const Vector2d way = sign < 0.0 ? away : wish;
    const Vector2d there = person + kStep_s * kPersonSpeed_mps * way.normalized();
    if (routes_.clearance_m(there) > kPerson_m || away.norm() > 10.0) person = there;
  }

  void write_scan(fmt::ostream& log, double time_s) {
    const Se2& pose = robot_.pose();
    log.print("FLASER {}", options_.beams);
    for (int i = 0; i < options_.beams; ++i) {
      const double direction_rad =
          pose.theta() + std::numbers::pi * (static_cast<double>(i) / (options_.beams - 1) - 0.5);
      double range_m = building_.range_m(pose.translation(), direction_rad, options_.range_m);
      for (const Vector2d& person : people_)
        if (const auto at = range_to(person, pose.translation(), direction_rad))
          range_m = std::min(range_m, *at);
      const double measured_m =
          std::max(0.05, range_m + random_.normal(0.0, options_.range_sigma_m));
      log.print(" {:.2f}", range_m < options_.range_m ? measured_m : kNoReturn_m);
    }
    const Se2& odom = odometry_.pose();
    for (int i = 0; i < 2; ++i)
      log.print(" {:.6f} {:.6f} {:.6f}", odom.x(), odom.y(), odom.theta());
    log.print(" {:.6f} nohost {:.6f}\n", 1000.0 + time_s, time_s);
  }

  const Options& options_;
  Random& random_;
  Building building_;
  Routes routes_;
  Mover robot_;
  Odometry odometry_;
  std::vector<Vector2d> people_{};
};

/// Near ones, 2 s apart, and far ones.
void write_relations(const std::vector<TruePose>& truth, fmt::ostream& file, double period_s,
                     Random& random) {
  const auto write = [&file](const TruePose& a, const TruePose& b) {
    const Se2 relation = a.pose.inverse() * b.pose;
    file.print("{:.6f} {:.6f} {:.6f} {:.6f} 0 0 0 {:.6f}\n", 1000.0 + a.time_s, 1000.0 + b.time_s,
               relation.x(), relation.y(), relation.theta());
  };
  const auto apart = static_cast<std::size_t>(std::max(1.0, std::round(2.0 / period_s)));
  for (std::size_t i = 0; i + apart < truth.size(); i += 10)
    write(truth[i], truth[i + apart]);
  const auto any = [&] {
    return static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(truth.size())));
  };
  for (int i = 0; i < 600; ++i) {
    const auto [a, b] = std::minmax({any(), any()});
    if (truth[b].time_s - truth[a].time_s > 60.0) write(truth[a], truth[b]);
  }
}

int run(const Options& options) {
  Random random{{options.seed}};
  const auto name = (options.out / fmt::format("{}_{}", options.kind, options.seed)).string();
  std::filesystem::create_directories(options.out);
  auto log = fmt::output_file(name + ".clf");
  log.print("PARAM robot_frontlaser_offset 0.0 nohost 0\n");
  Drive drive{options, random};
  const std::vector<TruePose> truth = drive.write(log);
  auto relations = fmt::output_file(name + ".relations");
  write_relations(truth, relations, options.period_s, random);
  fmt::print("{}.clf: {} scans in {:.0f} s\n", name, truth.size(), truth.back().time_s);
  return 0;
}

}  // namespace
}  // namespace waymark::drawn

int main(int argc, char** argv) {
  waymark::drawn::Options options;
  CLI::App app{
      "Writes the CARMEN log of a drive through a building that is drawn at random, with true "
      "relations"};
  app.add_option("kind", options.kind, "of building")
      ->check(CLI::IsMember({"office", "grid", "long", "bare", "hall", "outdoors"}))
      ->capture_default_str();
  app.add_option("--seed", options.seed, "other building, way and noise")->capture_default_str();
  app.add_option("--out", options.out, "folder for KIND_SEED.clf and .relations")
      ->capture_default_str();
  app.add_option("--length-m", options.length_m, "of the way")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--speed-mps", options.speed_mps, "")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--period-s", options.period_s, "of scans")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--range-m", options.range_m, "of the LiDAR")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--range-sigma-m", options.range_sigma_m, "noise")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--beams", options.beams, "over 180 degrees")
      ->check(CLI::IsMember({181, 361}))
      ->capture_default_str();
  app.add_option("--odometry-noise", options.odometry_noise, "times that of a good robot")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--people", options.people, "about the robot")
      ->check(CLI::Range(0, 50))
      ->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    return waymark::drawn::run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "drawn_drive: {}\n", error.what());
    return 2;
  }
}
