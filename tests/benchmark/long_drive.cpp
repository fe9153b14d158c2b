// SPDX-License-Identifier: BSD-3-Clause
// Prints what waymark costs on a long drive down a synthetic corridor with markers, kilometre by
// kilometre.
//
// usage: long_drive [KILOMETRES [SPACING_M]]
//   KILOMETRES  default: 5
//   SPACING_M   of the pairs of markers, 0 = none; default: 10
// Columns: driven [km], processor time per scan and per update [ms], worst scan [ms], memory of the
// process beyond that of the drive's sensor values [MB], and its growth per keyframe since the line
// before [kB].
#include "property/slam/estimator_run.hpp"
#include "slam/core/estimators/waymark.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>

namespace waymark {
namespace {

double resident_mb() {
  std::ifstream statm{"/proc/self/statm"};
  long all_pages = 0;
  long resident_pages = 0;
  statm >> all_pages >> resident_pages;
  return 1e-6 * static_cast<double>(resident_pages) * static_cast<double>(sysconf(_SC_PAGESIZE));
}

struct Kilometre {
  int scans{0};
  int updates{0};
  double busy_ms{0.0};
  double worst_ms{0.0};
};

void drive_far(double kilometres, double spacing_m) {
  test::SyntheticCorridor corridor;
  corridor.drive_m = 1000.0 * kilometres;
  corridor.length_m = corridor.drive_m + 10.0;
  corridor.speed_m_s = 1.0;
  if (spacing_m > 0.0) corridor.markers = test::opposite_markers(corridor, 4.0, spacing_m);
  WaymarkEstimator estimator{test::estimator_setup_of(corridor, 1), {}};
  const test::SensorLog log = test::drive(corridor);
  const double before_mb = resident_mb();
  double last_mb = 0.0;
  double driven_m = 0.0;
  int kilometre = 1;
  Kilometre sum;
  SensorQueue queue{test::setup_of(corridor)};
  test::feed(queue, log, [&](const SensorQueue::Ready& ready) {
    const std::clock_t start = std::clock();
    const Estimate estimate = estimator.update(ready.observation);
    const double took_ms = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    ++sum.scans;
    sum.updates += estimate.updated;
    sum.busy_ms += took_ms;
    sum.worst_ms = std::max(sum.worst_ms, took_ms);
    driven_m += ready.observation.motion.distance_m;
    if (driven_m < 1000.0 * kilometre) return;
    const double now_mb = resident_mb() - before_mb;
    std::printf("%2d %7.3f %7.3f %8.1f %8.1f %8.2f\n", kilometre++, sum.busy_ms / sum.scans,
                sum.busy_ms / sum.updates, sum.worst_ms, now_mb,
                1e3 * (now_mb - last_mb) / sum.updates);
    std::fflush(stdout);
    last_mb = now_mb;
    sum = {};
  });
}

}  // namespace
}  // namespace waymark

int main(int argc, char** argv) {
  const double kilometres = argc > 1 ? std::atof(argv[1]) : 5.0;
  const double spacing_m = argc > 2 ? std::atof(argv[2]) : 10.0;
  if (kilometres < 1.0 || spacing_m < 0.0 || argc > 3) {
    std::fprintf(stderr, "usage: long_drive [KILOMETRES [SPACING_M]]\n");
    return 2;
  }
  waymark::drive_far(kilometres, spacing_m);
}
