// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/range_noise.hpp"

#include "import/findings/wall_fit.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace waymark {
namespace {

constexpr std::size_t kBeams = 9;    // beams of a wall: 7 degrees of freedom about a line
constexpr double kWidest_rad = 0.4;  // largest angle from the first to the last of them
constexpr std::size_t kMinWalls = 100;
// Width of the mode, in the logarithm of the scatter: its spread with 7 degrees of freedom.
constexpr double kModeWidth = 0.3;
// A scatter up to this many times the mode is of a straight wall; 2 of 10,000 walls exceed it.
constexpr double kStraight = 2.0;
constexpr double kSigmaOfStep = 0.2887;    // standard deviation of rounding, in steps: 1 / sqrt(12)
constexpr double kFloatRounding_m = 1e-4;  // rounding error of a float
// This quantile of neighbours' differences is the step; so single garbled ranges are ignored.
constexpr double kSmallStepQuantile = 0.05;

/// True if all are returns, with monotonic angles within kWidest_rad.
bool is_one_sweep(std::span<const double> ranges_m, std::span<const double> angles_rad) {
  const double turn_rad = angle_difference(angles_rad.back(), angles_rad.front());
  if (std::abs(turn_rad) > kWidest_rad) return false;
  for (std::size_t i = 0; i < ranges_m.size(); ++i) {
    if (!std::isfinite(ranges_m[i]) || ranges_m[i] <= 0.0) return false;
    if (i > 0 && angle_difference(angles_rad[i], angles_rad[i - 1]) * turn_rad <= 0.0) return false;
  }
  return true;
}

/// Median of the values in that interval of the given width which has most values.
double mode(std::vector<double> values, double width) {
  std::ranges::sort(values);
  std::size_t low = 0;
  std::size_t most = 0;
  double middle = values.front();
  for (std::size_t high = 0; high < values.size(); ++high) {
    while (values[high] - values[low] > width)
      ++low;
    if (high - low + 1 <= most) continue;
    most = high - low + 1;
    middle = values[low + (high - low) / 2];
  }
  return middle;
}

}  // namespace

void WallScatter::add(const LidarScan& scan) {
  const std::span<const double> ranges_m{scan.ranges_m};
  const std::span<const double> angles_rad{scan.angles_rad};
  for (std::size_t i = 1; i < ranges_m.size(); ++i) {
    const double difference_m = std::abs(ranges_m[i] - ranges_m[i - 1]);
    if (std::isfinite(difference_m) && difference_m > kFloatRounding_m)
      differences_m_.push_back(difference_m);
  }
  for (std::size_t i = 0; i + kBeams <= ranges_m.size();) {
    const auto wall_m = ranges_m.subspan(i, kBeams);
    const auto wall_rad = angles_rad.subspan(i, kBeams);
    if (!is_one_sweep(wall_m, wall_rad)) {
      ++i;
      continue;
    }
    if (const auto scatter = scatter_about_wall_m(wall_m, wall_rad))
      scatters_m_.push_back(*scatter);
    i += kBeams;
  }
}

double WallScatter::step_m() const {
  if (differences_m_.empty()) return kFloatRounding_m;
  std::vector<double> differences_m = differences_m_;
  const auto place =
      differences_m.begin() +
      static_cast<std::ptrdiff_t>(kSmallStepQuantile * static_cast<double>(differences_m.size()));
  std::ranges::nth_element(differences_m, place);
  return *place;
}

std::optional<double> WallScatter::sigma_m() const {
  if (scatters_m_.size() < kMinWalls) return std::nullopt;
  const double floor_m = kSigmaOfStep * step_m();
  std::vector<double> logarithms;
  for (const double scatter_m : scatters_m_)
    logarithms.push_back(std::log(std::max(scatter_m, floor_m)));
  const double limit_m = kStraight * std::exp(mode(std::move(logarithms), kModeWidth));
  double sum = 0.0;
  double count = 0.0;
  for (const double scatter_m : scatters_m_) {
    if (scatter_m > limit_m) continue;
    sum += scatter_m * scatter_m;
    count += 1.0;
  }
  return std::max(std::sqrt(sum / count), floor_m);
}

}  // namespace waymark
