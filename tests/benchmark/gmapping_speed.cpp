// SPDX-License-Identifier: BSD-3-Clause
// Prints how long gmapping takes per processed scan of a log, for each number of threads, and
// whether the results are the same. Processor time hardly depends on what else the machine does.
//
// usage: gmapping_speed LOG ROBOT_TOML [SCANS [KEY=VALUE ...]]
//   SCANS      how many scans of the log, 0 = all (default)
//   KEY=VALUE  as waymark-slam's --set
#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "common/messages/convert.hpp"
#include "slam/estimator_factory.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>

namespace waymark {
namespace {

/// Observations of at most `max_scans` scans, 0 = all.
std::vector<Observation> observations_in(const char* log, const SlamConfig& config,
                                         std::size_t max_scans) {
  SensorQueue queue{sensor_setup(config)};
  LogReader reader{log};
  std::vector<Observation> observations;
  while (const auto message = reader.next()) {
    if (message->channel == channels::kLidar.name) {
      if (const auto planar = decode<planar_lidar_t>(message->payload).message)
        queue.add(to_scan(*planar));
      else if (const auto rolling = decode<lidar_t>(message->payload).message)
        queue.add(to_scan(*rolling));
    } else if (message->channel == channels::kOdometry.name) {
      if (const auto pose = decode<pose2D_t>(message->payload).message)
        queue.add(to_odometry(*pose));
    }
    while (auto ready = queue.next()) {
      observations.push_back(std::move(ready->observation));
      if (observations.size() == max_scans) return observations;
    }
  }
  return observations;
}

struct Run {
  std::size_t processed{0};
  double wall_s{0.0};
  double processor_s{0.0};
  std::vector<TimedPose> trajectory{};
};

Run run(const SlamConfig& config, const std::vector<Observation>& observations) {
  const auto estimator = make_estimator(config);
  Run run;
  Motion since_update;
  Timestamp updated_at;
  const auto wall_start = std::chrono::steady_clock::now();
  const std::clock_t processor_start = std::clock();
  for (const Observation& observation : observations) {
    estimator->update(observation);
    since_update = since_update.then(observation.motion);
    if (run.processed > 0 &&
        !config.slam.gmapping.gate.is_open(since_update, observation.time - updated_at)) {
      continue;
    }
    ++run.processed;
    since_update = {};
    updated_at = observation.time;
  }
  run.processor_s = static_cast<double>(std::clock() - processor_start) / CLOCKS_PER_SEC;
  run.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_start).count();
  run.trajectory = estimator->trajectory();
  return run;
}

bool are_the_same(const std::vector<TimedPose>& a, const std::vector<TimedPose>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& p, const auto& q) {
    return p.map_from_base.translation() == q.map_from_base.translation() &&
           p.map_from_base.theta() == q.map_from_base.theta();
  });
}

void print_speed(const char* log, SlamConfig config, std::size_t max_scans) {
  const std::vector<Observation> observations = observations_in(log, config, max_scans);
  std::printf("threads  scans  processed  ms per processed scan  of the processor  faster  same\n");
  Run first;
  for (const int threads : {1, 2}) {
    config.slam.threads = threads;
    const Run now = run(config, observations);
    if (threads == 1) first = now;
    const double per_scan = 1e3 / static_cast<double>(now.processed);
    std::printf("%7d %6zu %10zu %22.2f %17.2f %7.2f  %s\n", threads, observations.size(),
                now.processed, now.wall_s * per_scan, now.processor_s * per_scan,
                first.wall_s / now.wall_s,
                are_the_same(first.trajectory, now.trajectory) ? "yes" : "NO");
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace waymark

int main(int argc, char** argv) {
  if (argc < 3) {
    std::fprintf(stderr, "usage: gmapping_speed LOG ROBOT_TOML [SCANS [KEY=VALUE ...]]\n");
    return 2;
  }
  try {
    waymark::ConfigSources sources{{argv[2]}, {"slam.estimator=gmapping"}};
    sources.overrides.insert(sources.overrides.end(), argv + std::min(argc, 4), argv + argc);
    const auto max_scans = argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 0;
    waymark::print_speed(argv[1], waymark::load_config<waymark::SlamConfig>(sources), max_scans);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gmapping_speed: %s\n", error.what());
    return 2;
  }
}
