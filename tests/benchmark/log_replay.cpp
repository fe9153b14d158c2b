// SPDX-License-Identifier: BSD-3-Clause
// Runs the configured estimator over a recorded log in one thread and nothing else, and prints what
// it costs.
//
// usage: log_replay LOG ROBOT.toml OUT [KEY=VALUE...]
// Writes OUT.online.tum and OUT.final.tum. Prints the numbers of scans and updates; processor time
// of everything, of the estimator, of its longest scan, and at the end of the trajectory and the
// map; scans for which it was lost, and the largest step of the pose beyond what odometry said.
#include "benchmark/deliver.hpp"
#include "common/config/config.hpp"
#include "common/log/log_file.hpp"
#include "slam/estimator_factory.hpp"
#include "slam/slam_config.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <string>
#include <vector>

namespace waymark {
namespace {

double seconds_since(std::clock_t start) {
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

void write(const std::string& path, const std::vector<TimedPose>& poses) {
  std::FILE* file = std::fopen(path.c_str(), "w");
  for (const TimedPose& pose : poses) {
    const Se2& p = pose.map_from_base;
    std::fprintf(file, "%.6f %.6f %.6f 0 0 0 %.9f %.9f\n", to_seconds(pose.time), p.x(), p.y(),
                 std::sin(0.5 * p.theta()), std::cos(0.5 * p.theta()));
  }
  std::fclose(file);
}

int replay(int argc, char** argv) {
  ConfigSources sources;
  sources.files = {argv[2]};
  for (int i = 4; i < argc; ++i)
    sources.overrides.push_back(argv[i]);
  const SlamConfig config = load_config<SlamConfig>(sources);
  LogReader reader{argv[1]};
  SensorQueue queue{sensor_setup(config)};
  const auto estimator = make_estimator(config, nullptr);
  double worst_s = 0.0, busy_s = 0.0, jump_m = 0.0;
  int scans = 0, updates = 0, lost = 0;
  std::vector<TimedPose> online;
  const std::clock_t start = std::clock();
  const auto take_ready = [&] {
    while (const auto ready = queue.next()) {
      const std::clock_t begin = std::clock();
      const Estimate estimate = estimator->update(ready->observation);
      const double took_s = seconds_since(begin);
      busy_s += took_s;
      worst_s = std::max(worst_s, took_s);
      ++scans;
      updates += estimate.updated;
      lost += estimate.health == Health::kLost;
      if (!online.empty())
        jump_m = std::max(
            jump_m,
            ((online.back().map_from_base.inverse() * estimate.map_from_base).translation() -
             ready->observation.motion.start_from_end.translation())
                .norm());
      online.push_back({estimate.time, estimate.map_from_base});
    }
  };
  while (const auto message = reader.next([](std::string_view) { return true; })) {
    benchmark::deliver(*message, queue);
    take_ready();
  }
  queue.finish();
  take_ready();
  const double drive_s = seconds_since(start);
  const std::clock_t end = std::clock();
  const auto final = estimator->trajectory();
  const double solved_s = seconds_since(end);
  const GridMap map = estimator->redrawn_map();
  std::printf(
      "scans %d updates %d cpu %.2f busy %.2f worst_ms %.0f end %.2f+%.2f lost %d jump %.2f\n",
      scans, updates, drive_s, busy_s, 1e3 * worst_s, solved_s, seconds_since(end) - solved_s, lost,
      jump_m);
  write(std::string{argv[3]} + ".online.tum", online);
  write(std::string{argv[3]} + ".final.tum", final);
  return 0;
}

}  // namespace
}  // namespace waymark

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: log_replay LOG ROBOT.toml OUT [KEY=VALUE...]\n");
    return 2;
  }
  try {
    return waymark::replay(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
