// SPDX-License-Identifier: BSD-3-Clause
// Drives a robot through a building that is drawn at random, and writes what it measured as a
// CARMEN log with true relations: for deploy/real_logs.sh. Plane geometry, no physics: odometry
// with wrong scales and noise, a LiDAR, people who walk about the robot.
#include "common/command_line/command_line.hpp"
#include "common/errors/exit_codes.hpp"
#include "drawn_drive/drive.hpp"

#include <fmt/os.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace waymark::drawn {
namespace {

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

void run(const DriveOptions& options, std::uint64_t seed, const std::filesystem::path& out) {
  Random random{{seed}};
  const auto name = (out / fmt::format("{}_{}", options.kind, seed)).string();
  std::filesystem::create_directories(out);
  auto log = fmt::output_file(name + ".clf");
  log.print("PARAM robot_frontlaser_offset 0.0 nohost 0\n");
  Drive drive{options, random};
  const std::vector<TruePose> truth = drive.write(log);
  auto relations = fmt::output_file(name + ".relations");
  write_relations(truth, relations, options.period_s, random);
  fmt::print("{}.clf: {} scans in {:.0f} s\n", name, truth.size(), truth.back().time_s);
}

}  // namespace
}  // namespace waymark::drawn

int main(int argc, char** argv) {
  using namespace waymark;
  drawn::DriveOptions options;
  std::uint64_t seed = 1;
  std::filesystem::path out{"."};
  Program program{
      "Writes the CARMEN log of a drive through a building that is drawn at random, with true "
      "relations",
      "drawn_drive"};
  program.add_option("kind", options.kind, "of building")
      .one_of(drawn::Building::kinds())
      .show_default();
  program.add_option("--seed", seed, "other building, way and noise").show_default();
  program.add_option("--out", out, "folder for KIND_SEED.clf and .relations").show_default();
  program.add_option("--length-m", options.length_m, "of the way")
      .check(positive_number())
      .show_default();
  program.add_option("--speed-mps", options.speed_mps, "of the robot")
      .check(positive_number())
      .show_default();
  program.add_option("--period-s", options.period_s, "of scans")
      .check(positive_number())
      .show_default();
  program.add_option("--range-m", options.range_m, "of the LiDAR")
      .check(positive_number())
      .show_default();
  program.add_option("--range-sigma-m", options.range_sigma_m, "noise")
      .check(nonnegative_number())
      .show_default();
  program.add_option("--beams", options.beams, "of a scan")
      .check({[](double beams) { return beams >= 2.0 && beams <= 2000.0; }, "2 to 2000 beams",
              "INT in [2 - 2000]"})
      .show_default();
  program.add_option("--view-deg", options.view_deg, "angle of view")
      .check({[](double view) { return view > 0.0 && view < 360.0; }, "less than 360",
              "FLOAT in (0 - 360)"})
      .show_default();
  program.add_option("--odometry-noise", options.odometry_noise, "times that of a good robot")
      .check(nonnegative_number())
      .show_default();
  program.add_option("--people", options.people, "about the robot")
      .check({[](double people) { return people >= 0.0 && people <= 50.0; }, "0 to 50 people",
              "INT in [0 - 50]"})
      .show_default();
  if (const auto exit_code = program.parse(argc, argv)) return *exit_code;
  try {
    drawn::run(options, seed, out);
    return kExitOk;
  } catch (const std::exception& error) {
    fmt::print(stderr, "drawn_drive: {}\n", error.what());
    return kExitUsage;
  }
}
