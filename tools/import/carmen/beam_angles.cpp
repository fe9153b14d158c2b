// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/beam_angles.hpp"

#include "common/geometry/angle.hpp"
#include "import/findings/wall_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace waymark {
namespace {

constexpr std::array kFields_deg{180.0, 270.0, 360.0, 240.0, 190.0, 100.0};  // the usual ones first
constexpr double kUrgStep_deg = 360.0 / 1024.0;
constexpr double kSameStep = 0.004;   // relative; 682 beams of an URG make nearly 240 degrees
constexpr std::size_t kWindows = 8;   // windows of neighbouring beams per scan
constexpr std::size_t kMinBeams = 9;  // beams in a window
constexpr std::size_t kMinWindows = 100;
constexpr double kFarthestWall_m = 30.0;
constexpr double kFloor_m = 0.003;  // smaller scatters are not distinguished
// Least decrease of the mean logarithm of the scatter; a wrong field of view increases it by 0.1.
constexpr double kClearly = 0.02;

constexpr double kRound = 0.004;  // smallest relative spread of a wall's ranges in a window

using Window = std::span<const double>;

/// True if all are ranges and they differ: equal ones are a driver's code for "no return".
bool may_be_wall(const Window& window) {
  const auto [least, most] = std::ranges::minmax(window);
  return std::ranges::all_of(window, [](double r) { return r > 0.0 && r < kFarthestWall_m; }) &&
         most - least > kRound * most;
}

bool is_usual_step(double step_deg) {
  const double quarters = 4.0 * step_deg;
  return std::abs(quarters - std::round(quarters)) < 1e-6 ||
         std::abs(step_deg - kUrgStep_deg) < kSameStep * kUrgStep_deg;
}

/// Steps of all fields of view, the usual ones first.
std::vector<double> possible_steps_rad(std::size_t num_beams) {
  std::vector<double> steps_deg;
  for (const double field_deg : kFields_deg)
    for (const std::size_t gaps : {num_beams - 1, num_beams})
      steps_deg.push_back(field_deg / static_cast<double>(gaps));
  std::ranges::stable_partition(steps_deg, is_usual_step);
  for (double& step : steps_deg)
    step = radians(step);
  return steps_deg;
}

std::vector<Window> windows_of(std::span<const std::span<const double>> scans,
                               std::size_t num_beams) {
  const std::size_t size = std::max(kMinBeams, num_beams / kWindows);
  std::vector<Window> windows;
  for (const std::span<const double> ranges_m : scans) {
    for (std::size_t i = 0; i + size <= ranges_m.size(); i += size) {
      const Window window = ranges_m.subspan(i, size);
      if (may_be_wall(window)) windows.push_back(window);
    }
  }
  return windows;
}

/// Mean logarithm of the windows' scatter [m] about straight walls.
double curvature_of_walls(std::span<const Window> windows, double step_rad) {
  std::vector<double> angles_rad(windows.front().size());
  for (std::size_t i = 0; i < angles_rad.size(); ++i)
    angles_rad[i] = step_rad * static_cast<double>(i);
  double sum = 0.0;
  for (const Window& window : windows)
    sum += std::log(std::max(kFloor_m, scatter_about_wall_m(window, angles_rad).value_or(0.0)));
  return sum / static_cast<double>(windows.size());
}

}  // namespace

std::optional<BeamAngles> conventional_angles(std::size_t num_beams) {
  if (num_beams == 180 || num_beams == 181) return BeamAngles{radians(-90.0), radians(1.0)};
  if (num_beams == 360 || num_beams == 361) return BeamAngles{radians(-90.0), radians(0.5)};
  return std::nullopt;
}

double first_angle_rad(std::size_t num_beams, double step_rad) {
  return radians(std::round(degrees(-0.5 * step_rad * static_cast<double>(num_beams - 1))));
}

std::optional<BeamAngles> straightest_angles(std::span<const std::span<const double>> scans,
                                             std::size_t num_beams) {
  const std::optional<BeamAngles> conventional = conventional_angles(num_beams);
  const std::vector<Window> windows = windows_of(scans, num_beams);
  if (windows.size() < kMinWindows) return conventional;
  std::optional<BeamAngles> best = conventional;
  double least = best ? curvature_of_walls(windows, best->step_rad) : 0.0;
  for (const double step_rad : possible_steps_rad(num_beams)) {
    const double curvature = curvature_of_walls(windows, step_rad);
    if (best && curvature > least - kClearly) continue;
    best = BeamAngles{first_angle_rad(num_beams, step_rad), step_rad};
    least = curvature;
  }
  return best;
}

}  // namespace waymark
