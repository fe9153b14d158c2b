// SPDX-License-Identifier: BSD-3-Clause
// Prints how well the data of a recorded run determine its trajectory: the best that any method
// could do, by least squares over all of the log at once, or on line over what came before each
// pose. The truth is used only to measure that.
#include "batch_limit/least_squares.hpp"
#include "common/files/whole_file.hpp"
#include "evaluate/map/marker_error.hpp"
#include "evaluate/trajectory/trajectory_error.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>

namespace {

using namespace waymark;
namespace fs = std::filesystem;
using evaluate::Alignment;
using evaluate::SkippedLines;
using evaluate::Trajectory;
using evaluate::TrajectoryError;

constexpr int kFine = 0;
constexpr int kFailed = 1;
constexpr int kUsage = 2;

struct Arguments {
  fs::path run_dir{};
  fs::path estimate{};
  fs::path out{};
  double straight_over_m{benchmark::BatchModel{}.straight_over_m};
  bool is_on_line{false};
  std::vector<std::string> settings{};
};

SlamConfig configuration(const Arguments& arguments) {
  ConfigSources sources{{arguments.run_dir / "robot.toml"}, arguments.settings};
  return load_config<SlamConfig>(sources);
}

Trajectory trajectory_of(const benchmark::Scene& scene, const std::vector<benchmark::Stop>& stops) {
  Trajectory trajectory;
  for (std::size_t i = 0; i < stops.size(); ++i)
    trajectory.push_back({to_seconds(stops[i].time), scene.map_from_base[i]});
  return trajectory;
}

benchmark::BatchModel model_of(const SlamConfig& config, const Arguments& arguments) {
  const WaymarkConfig& waymark = config.slam.waymark;
  return {waymark.odometry, estimator_setup(config).sighting_noise, waymark.same_marker_within_m,
          arguments.straight_over_m};
}

constexpr std::size_t kOnLineEvery = 10;  // poses

/// The newest pose of all that came so far, at the first pose and at every tenth.
/// @param[out] has_converged  false when one of them has not.
Trajectory newest_poses(const std::vector<benchmark::Stop>& stops,
                        const benchmark::BatchModel& model, bool& has_converged) {
  Trajectory trajectory{{to_seconds(stops.front().time), Se2{}}};
  for (std::size_t count = kOnLineEvery; count <= stops.size(); count += kOnLineEvery) {
    const auto solution = benchmark::solve(std::span{stops}.first(count), model);
    has_converged = has_converged && solution.has_converged;
    trajectory.push_back({to_seconds(stops[count - 1].time), solution.scene.map_from_base.back()});
  }
  return trajectory;
}

void write_tum(const fs::path& file, const Trajectory& trajectory) {
  std::string text;
  for (const auto& [t_s, pose] : trajectory)
    text += fmt::format("{:.6f} {:.6f} {:.6f} 0 0 0 {:.9f} {:.9f}\n", t_s, pose.x(), pose.y(),
                        std::sin(0.5 * pose.theta()), std::cos(0.5 * pose.theta()));
  write_whole_file(file, text);
}

std::vector<evaluate::PosePair> pairs_of(const Trajectory& trajectory, const Trajectory& truth,
                                         const std::string& name) {
  auto pairs = evaluate::associate(trajectory, truth);
  if (pairs.empty()) throw SetupError{name + ": no pose within the time span of the truth"};
  return pairs;
}

void print_error(const char* name, const TrajectoryError& error) {
  fmt::print("{:9} ate_origin {:.4f} m  along {:.4f} m  across {:.4f} m  heading {:.4f} deg\n",
             name, error.ate_origin_m, error.along_m ? error.along_m->rms : 0.0,
             error.across_m ? error.across_m->rms : 0.0, error.heading_deg.rms);
}

void print_markers(const benchmark::Scene& scene, const fs::path& truth_file,
                   const Se2& world_from_map) {
  if (!fs::exists(truth_file)) return;
  SkippedLines skipped;
  std::vector<evaluate::Marker> in_map;
  for (const benchmark::Marker& marker : scene.markers)
    in_map.push_back({marker.id, marker.map_from_marker});
  const auto error = evaluate::marker_error(in_map, evaluate::read_markers(truth_file, skipped),
                                            world_from_map, 5.0);
  fmt::print("markers   mean {:.4f} m  worst {:.4f} m  matched {}  missing {}  spurious {}\n",
             error.mean_position_m.value_or(0.0), error.max_position_m.value_or(0.0), error.matched,
             error.missing, error.spurious);
}

void print_errors_found(const benchmark::BatchSolution& solution) {
  fmt::print("odometry  scale {:+.3f} %  drift {:+.4f} deg/m  turn scale {:+.3f} %\n",
             100.0 * solution.odometry_errors[0], degrees(solution.odometry_errors[1]),
             100.0 * solution.odometry_errors[2]);
  fmt::print("camera    yaw {:+.4f} deg  focal length {:+.3f} %  markers stand off {:.1f} mm\n",
             degrees(solution.camera_errors[0]), 100.0 * solution.camera_errors[1],
             1e3 * solution.standoff_m);
}

void print_solution(const benchmark::BatchSolution& solution) {
  const benchmark::Scene& scene = solution.scene;
  fmt::print("{} poses, {} walls seen {} times, {} markers seen {} times; chi2 {:.0f} of {}; {}\n",
             scene.map_from_base.size(), scene.walls.size(), scene.wall_links.size(),
             scene.markers.size(), scene.marker_links.size(), solution.chi2, solution.residuals,
             solution.report);
  print_errors_found(solution);
}

/// Prints the error of a trajectory. Returns its ATE [m].
double print_against(const Trajectory& truth, const Trajectory& trajectory, const char* name) {
  const TrajectoryError error =
      evaluate::trajectory_error(pairs_of(trajectory, truth, name), Alignment::kOrigin);
  print_error(name, error);
  return error.ate_origin_m;
}

int run(const Arguments& arguments) {
  const SlamConfig config = configuration(arguments);
  SkippedLines skipped;
  const auto drive = benchmark::recorded_drive(arguments.run_dir / "run.lcm", config);
  const Trajectory truth = evaluate::read_tum(arguments.run_dir / "truth.tum", skipped);
  const benchmark::BatchModel model = model_of(config, arguments);
  const auto solution = benchmark::solve(drive.stops, model);
  bool has_converged = solution.has_converged;
  print_solution(solution);

  const Trajectory limit = trajectory_of(solution.scene, drive.stops);
  const double limit_m = print_against(truth, limit, "limit");
  print_markers(solution.scene, arguments.run_dir / "truth_markers.csv",
                evaluate::align(pairs_of(limit, truth, "limit"), Alignment::kOrigin));
  if (!arguments.out.empty()) write_tum(arguments.out, limit);
  if (arguments.is_on_line)
    print_against(truth, newest_poses(drive.stops, model, has_converged), "on_line");
  if (!arguments.estimate.empty()) {
    const Trajectory estimate = evaluate::read_tum(arguments.estimate, skipped);
    fmt::print("ratio     {:.3f}\n", print_against(truth, estimate, "estimate") / limit_m);
  }

  for (const std::string& line : skipped)
    fmt::print(stderr, "skipped: {}\n", line);
  if (drive.skipped_bytes > 0)
    fmt::print(stderr, "batch_limit: the log is damaged, {} bytes of it are no event\n",
               drive.skipped_bytes);
  if (!has_converged) fmt::print(stderr, "batch_limit: has not converged\n");
  return has_converged && skipped.empty() && drive.skipped_bytes == 0 ? kFine : kFailed;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  CLI::App program{
      "The best trajectory that the data of a run allow, against the truth.\n"
      "Exit code: 0 fine; 1 not converged, or parts of files were skipped; 2 wrong usage or "
      "files."};
  program.add_option("RUN_DIR", arguments.run_dir, "with run.lcm, robot.toml, truth.tum")
      ->required()
      ->check(CLI::ExistingDirectory);
  program
      .add_option("--estimate", arguments.estimate,
                  "trajectory.tum of an estimator: prints its ATE over the limit's")
      ->check(CLI::ExistingFile);
  program.add_option("--out", arguments.out, "write the limit's trajectory there (TUM)");
  program
      .add_option("--straight-over", arguments.straight_over_m,
                  "walls may bend every so many metres; 1000 = straight all the way")
      ->check(CLI::Range(0.1, 1e6))
      ->capture_default_str();
  program.add_flag("--on-line", arguments.is_on_line,
                   "print also the error of the newest pose of all that came before it, every ten "
                   "poses: what a perfect filter would say");
  program.add_option("--set", arguments.settings,
                     "key=value, as waymark-slam's; the noise is that of [slam.waymark]");
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? kFine : kUsage;
  }
  try {
    return run(arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "batch_limit: {}\n", error.what());
    return kUsage;
  }
}
