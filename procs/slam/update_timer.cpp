// SPDX-License-Identifier: BSD-3-Clause
#include "slam/update_timer.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace waymark {
namespace {

double seconds(std::clock_t ticks) {
  return static_cast<double>(ticks) / CLOCKS_PER_SEC;
}

}  // namespace

void UpdateTimer::stop(bool updated) {
  const std::clock_t elapsed = std::clock() - started_;
  total_ += elapsed;
  worst_ = std::max(worst_, elapsed);
  ++observations_;
  if (updated) ++updates_;
}

std::string UpdateTimer::summary() const {
  constexpr double kMs_per_s = 1e3;
  return fmt::format(
      "estimator: {} observations, {} updates, {:.3f} s of processor time, worst {:.1f} ms, "
      "process {:.2f} s",
      observations_, updates_, seconds(total_), kMs_per_s * seconds(worst_), seconds(std::clock()));
}

}  // namespace waymark
