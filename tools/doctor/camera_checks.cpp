// SPDX-License-Identifier: BSD-3-Clause
// Checks of camera and markers.
#include "common/geometry/median.hpp"
#include "common/markers/marker_dictionary.hpp"
#include "doctor/checks.hpp"
#include "doctor/verdict.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace waymark {
namespace {

constexpr DeviationLimits kFocal{0.01, 0.05};
constexpr DeviationLimits kSize{0.01, 0.03};
constexpr DeviationLimits kYaw_rad{0.0087, 0.035};  // 0.5 and 2 degrees
constexpr DeviationLimits kLate_s{0.01, 0.05};
// The modules of a marker that is just large enough to be found have three to four pixels: a blur
// whose sigma is half of that hides them, and one with twice that sigma those of a marker half as
// far.
constexpr DeviationLimits kBlur_px{1.5, 3.0};
constexpr DeviationLimits kUnreadable{0.01, 0.1};  // share of the frames
constexpr std::size_t kMinMarkers = 20;
constexpr double kSigmaOfMedian = 1.2533;  // sigma of a normal's median, in sigma / sqrt(n)

Measured median_of(const std::vector<double>& values) {
  const double value = upper_median(values);
  std::vector<double> deviations;
  for (const double other : values)
    deviations.push_back(std::abs(other - value));
  return {value, kSigmaOfMedian * kSigmaOfMad * upper_median(std::move(deviations)) /
                     std::sqrt(static_cast<double>(values.size()))};
}

/// The smallest dictionary of the family of `largest` that contains `id`.
std::string smallest_dictionary(const std::string& largest, int id) {
  const std::string family = largest.substr(0, largest.rfind('_') + 1);
  if (!largest.ends_with("_1000")) return largest;
  for (const std::string& name : dictionary_names()) {
    if (name.starts_with(family) && size_of(*find_dictionary(name)) > id) return name;
  }
  return largest;
}

Check frames_check(const CameraRecord& camera, const RobotConfig& robot) {
  std::int64_t bad = 0;
  std::string reasons;
  for (const auto& [reason, count] : camera.problems) {
    bad += count;
    reasons += fmt::format(", {} {}", count, reason);
  }
  const double share = static_cast<double>(bad) /
                       static_cast<double>(std::max<std::int64_t>(1, camera.num_examined));
  return {"camera_frames", verdict_of(share, 0.0, kUnreadable),
          fmt::format("{} of {} frames cannot be used{}", bad, camera.num_examined, reasons),
          fmt::format("send images of {}x{} (robot.camera.width_px, height_px), whole and as JPEG "
                      "or grey",
                      robot.camera.width_px, robot.camera.height_px),
          100.0 * share};
}

Check dictionary_check(const CameraRecord& camera, RobotConfig& robot) {
  const std::int64_t described = camera.markers_of_described;
  const std::string name = robot.markers.dictionary;
  std::string best;
  std::int64_t most = 0;
  for (const auto& [other, count] : camera.markers_by_dictionary) {
    if (count <= most) continue;
    most = count;
    best = other;
  }
  // Counts are Poisson: the variance of their difference is their sum.
  const double surplus = static_cast<double>(most - described);
  const bool is_other =
      most > 2 * described && surplus > kSigmas * std::sqrt(static_cast<double>(most + described));
  if (is_other) {
    const std::string found = smallest_dictionary(best, camera.largest_id.at(best));
    robot.markers.dictionary = found;
    return {"marker_dictionary", Verdict::kFail,
            fmt::format("{} markers are read with {}, {} with {}", most, found, described, name),
            fmt::format("robot.markers.dictionary = \"{}\", or print markers of {}", found, name),
            static_cast<double>(described)};
  }
  if (described == 0) {
    return unchecked("marker_dictionary", "no frame shows a marker of any dictionary",
                     "drive past markers; look whether they are in view, sharp, and lit");
  }
  return {"marker_dictionary", Verdict::kPass,
          fmt::format("{} markers are read with {}", described, name), "",
          static_cast<double>(described)};
}

Check blur_check(const CameraRecord& camera) {
  if (camera.blurs_px.size() < kMinMarkers) {
    return unchecked("blur", fmt::format("{} markers are too few", camera.blurs_px.size()),
                     "drive past markers");
  }
  const Measured blur = median_of(camera.blurs_px);
  const Verdict verdict = verdict_of(blur.value, blur.sigma, kBlur_px);
  return {"blur", verdict,
          fmt::format("edges of markers are blurred by {:.2f} +- {:.2f} px (standard deviation); a "
                      "module has {:.1f} px",
                      blur.value, blur.sigma, upper_median(camera.modules_px)),
          verdict == Verdict::kPass ? "" : "focus the camera, expose shorter, or light the way",
          blur.value};
}

Check no_sightings(const char* name) {
  return unchecked(name, "too little of it shows in the markers that were seen",
                   "drive past several markers, in a room rather than a bare corridor, with turns "
                   "that start and stop while one is in view");
}

/// The checks that compare the camera with the motion, where the stamps of the two do not fit.
std::vector<Check> checks_with_wrong_clocks(const ClockFindings& clocks, const RobotConfig& robot,
                                            const DoctorInput& input) {
  const char* const cause = clocks.camera_late_s ? "camera_time_offset" : "time_offset";
  std::vector<Check> checks;
  for (const char* name : {"focal_length", "marker_size", "camera_yaw"}) {
    checks.push_back(unchecked(name, "the stamps of the sensors do not fit",
                               fmt::format("first see {}", cause)));
  }
  if (!clocks.camera_late_s) {
    checks.push_back(unchecked("camera_time_offset", "the stamps of the sensors do not fit",
                               "first see time_offset"));
    return checks;
  }
  const double late_s = robot.camera.late_s + *clocks.camera_late_s;
  checks.push_back({"camera_time_offset", Verdict::kFail,
                    "the stamps of the camera are " + later_than_odometry(late_s, input),
                    "stamp both with one clock, frames when they are exposed", 1e3 * late_s});
  return checks;
}

}  // namespace

std::vector<Check> check_camera(const DoctorInput& input,
                                const std::optional<CameraCalibration>& calibration,
                                const ClockFindings& clocks, RobotConfig& robot) {
  std::vector<Check> checks;
  if (!input.camera) {
    return {unchecked(
        "camera",
        input.described ? "the log has neither CAMERA nor MARKERS" : "no robot.toml describes it",
        input.described ? "record CAMERA, too (LCM logs only)" : "give --config robot.toml")};
  }
  const RobotConfig described = robot;
  checks.push_back(frames_check(*input.camera, robot));
  checks.push_back(check_camera_drops(input));
  if (input.camera->has_images) {
    checks.push_back(dictionary_check(*input.camera, robot));
    checks.push_back(blur_check(*input.camera));
  } else {
    for (const char* name : {"marker_dictionary", "blur"})
      checks.push_back(unchecked(name, "the log has MARKERS but no CAMERA", "record CAMERA, too"));
  }
  const auto add = [&](const char* name, const Measured& measured, double expected,
                       DeviationLimits limits, double unit, const std::string& finding,
                       const auto& write, const auto& remedy) {
    if (!is_known(measured, limits)) return checks.push_back(no_sightings(name));
    const double deviation = measured.value - expected;
    const Verdict verdict = verdict_of(deviation, measured.sigma, limits);
    const std::string to_do = verdict == Verdict::kPass ? "" : remedy();
    if (is_worth_writing(verdict, deviation, measured.sigma, limits)) write();
    checks.push_back({name, verdict, finding, to_do, unit * measured.value});
  };
  if (clocks.lidar_is_unrelated || clocks.camera_late_s) {
    std::ranges::move(checks_with_wrong_clocks(clocks, described, input),
                      std::back_inserter(checks));
    return checks;
  }
  if (!calibration) {
    for (const char* name : {"focal_length", "marker_size", "camera_yaw", "camera_time_offset"})
      checks.push_back(no_sightings(name));
    return checks;
  }
  const CameraCalibration& found = *calibration;
  const double fx_px = described.camera.fx_px * found.focal.value;
  const double fy_px = described.camera.fy_px * found.focal.value;
  add(
      "focal_length", found.focal, 1.0, kFocal, 1.0,
      fmt::format("the focal length is {:.4f} +- {:.4f} times robot.camera.fx_px",
                  found.focal.value, found.focal.sigma),
      [&] {
        robot.camera.fx_px = fx_px;
        robot.camera.fy_px = fy_px;
      },
      [&] {
        return fmt::format("robot.camera.fx_px = {:.2f}, fy_px = {:.2f}, or calibrate the lens",
                           fx_px, fy_px);
      });
  const double size_m = described.markers.size_m * found.marker_size.value;
  add(
      "marker_size", found.marker_size, 1.0, kSize, 1.0,
      fmt::format("markers are {:.4f} +- {:.4f} times as large as robot.markers.size_m",
                  found.marker_size.value, found.marker_size.sigma),
      [&] { robot.markers.size_m = size_m; },
      [&] {
        return fmt::format("measure one; robot.markers.size_m = {:.4f}, or print them at 100 %",
                           size_m);
      });
  const double yaw_rad = wrap_angle(described.camera.yaw_rad + found.yaw_rad.value);
  add(
      "camera_yaw", found.yaw_rad, 0.0, kYaw_rad, degrees(1.0),
      fmt::format("the camera looks {:.2f} +- {:.2f} deg to the {} of its description",
                  degrees(std::abs(found.yaw_rad.value)), degrees(found.yaw_rad.sigma),
                  found.yaw_rad.value >= 0.0 ? "left" : "right"),
      [&] { robot.camera.yaw_rad = yaw_rad; },
      [&] { return fmt::format("robot.camera.yaw_rad = {:.4f}", yaw_rad); });
  const double late_s = described.camera.late_s + found.late_s.value;
  const Measured total{late_s, found.late_s.sigma};
  add(
      "camera_time_offset", total, described.camera.late_s, kLate_s, 1e3,
      fmt::format(
          "the camera's stamps are {:.0f} +- {:.0f} ms {} odometry's, described is {:.0f} ms",
          1e3 * std::abs(late_s), 1e3 * total.sigma, late_s >= 0.0 ? "behind" : "ahead of",
          1e3 * described.camera.late_s),
      [&] { robot.camera.late_s = late_s; },
      [&] {
        return fmt::format("robot.camera.late_s = {:.4f}, or stamp frames when they are exposed",
                           late_s);
      });
  return checks;
}

}  // namespace waymark
