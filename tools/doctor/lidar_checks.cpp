// SPDX-License-Identifier: BSD-3-Clause
// Checks of the LiDAR alone.
#include "doctor/checks.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace waymark {
namespace {

constexpr double kNoiseRatio = 2.0;  // measured / configured noise, or the inverse: warning
constexpr double kFewLost = 0.02;    // share of scans that do not fit the one before: pass
constexpr double kManyLost = 0.2;    // up to here a warning, above a failure
constexpr std::size_t kMinScans = 30;

}  // namespace

Check check_no_return(const DoctorInput& input, RobotConfig& robot) {
  const std::vector<double>& codes_m = input.log.no_return_codes_m;
  if (codes_m.empty()) {
    return {
        "no_return", Verdict::kPass, "ranges pile up nowhere: none stands for no return", "", {}};
  }
  const double from_m = input.log.robot.lidar.range_max_m;
  const bool is_described = input.described && input.described->lidar.range_max_m < codes_m.front();
  std::string finding = fmt::format("ranges pile up at {:.2f} m", codes_m.front());
  if (codes_m.size() > 1) finding += fmt::format(" (and up to {:.2f} m)", codes_m.back());
  finding += ": that is no return";
  if (is_described) {
    return {"no_return", Verdict::kPass,
            fmt::format("{}, and robot.lidar.range_max_m is {:.2f} m, below it", finding,
                        input.described->lidar.range_max_m),
            "", codes_m.front()};
  }
  robot.lidar.range_max_m = std::min(robot.lidar.range_max_m, from_m);
  if (!input.described) {
    return {"no_return", Verdict::kWarn, finding,
            fmt::format("say so to every program: robot.lidar.range_max_m = {:.4g} (waymark-import "
                        "does it)",
                        from_m),
            codes_m.front()};
  }
  return {"no_return", Verdict::kFail,
          fmt::format("{}, but by robot.lidar.range_max_m ({:.2f} m) it is a wall", finding,
                      input.described->lidar.range_max_m),
          fmt::format("robot.lidar.range_max_m = {:.4g}, or let the driver send +inf", from_m),
          codes_m.front()};
}

Check check_range_noise(const DoctorInput& input, RobotConfig& robot) {
  const double sigma_m = input.log.robot.lidar.range_sigma_m;
  if (!input.noise_is_estimated) {
    return unchecked("range_noise", "too few neighbouring beams lie on straight walls",
                     "record a longer log between walls");
  }
  const double described_m = robot.lidar.range_sigma_m;
  const std::string finding =
      fmt::format("ranges scatter by {:.4f} m about straight walls", sigma_m);
  if (!input.described) return {"range_noise", Verdict::kPass, finding, "", sigma_m};
  const bool is_as_described =
      sigma_m < kNoiseRatio * described_m && described_m < kNoiseRatio * sigma_m;
  if (!is_as_described) robot.lidar.range_sigma_m = sigma_m;
  return {"range_noise", is_as_described ? Verdict::kPass : Verdict::kWarn,
          fmt::format("{}, robot.lidar.range_sigma_m is {:.4f} m", finding, described_m),
          is_as_described ? "" : fmt::format("robot.lidar.range_sigma_m = {:.4f}", sigma_m),
          sigma_m};
}

Check check_scans_fit(const ImportedLog& log, const LidarMotions& motions) {
  if (log.scans.size() < kMinScans) {
    return unchecked("scans_fit", fmt::format("{} scans are too few", log.scans.size()),
                     "record a longer log");
  }
  const double share =
      static_cast<double>(motions.num_lost) / static_cast<double>(log.scans.size());
  const auto complete = std::ranges::count_if(motions.motions, &LidarMotion::is_complete);
  return {
      "scans_fit",
      share <= kFewLost    ? Verdict::kPass
      : share <= kManyLost ? Verdict::kWarn
                           : Verdict::kFail,
      fmt::format("{:.1f} % of the scans do not fit the one before; {} motions of the LiDAR, {} of "
                  "them seen in all directions",
                  100.0 * share, motions.motions.size(), complete),
      "check that ranges are in metres and angles right, that the LiDAR is level, and that "
      "scans are not dropped",
      100.0 * share};
}

}  // namespace waymark
