// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/http/health_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark::viewer {
namespace {

// Twice the period of a camera with one frame per second.
constexpr double kCameraSilent_s = 2.0;
// Longer than a robot at walking pace takes between markers 4 m apart.
constexpr double kMarkerOverdue_s = 5.0;

// Ten periods of slam's estimates, which come at the LiDAR's rate; two of its statuses.
constexpr double kSlamSilent_s = 2.0;
constexpr double kSensorSilent_s = 2.0;

bool is_above(const std::optional<double>& silence_s, double limit_s) {
  return silence_s && *silence_s > limit_s;
}

bool is_silent(const LiveView& view) {
  return is_above(view.silences.estimate_s, kSlamSilent_s);
}

/// Slam has ended or hangs, or it has no input from which to estimate.
std::string silence_sentence(const Silences& silences) {
  if (is_above(silences.slam_s, kSlamSilent_s))
    return fmt::format("Slam has been silent for {:.0f} s: it has ended, or hangs.",
                       *silences.slam_s);
  return fmt::format("Slam has sent no pose for {:.0f} s.", *silences.estimate_s);
}

std::string silent_sensors_sentence(const Silences& silences) {
  std::string text;
  for (const auto& [name, silence_s] :
       {std::pair{"LIDAR", silences.lidar_s}, std::pair{"ODOMETRY", silences.odometry_s}}) {
    if (is_above(silence_s, kSensorSilent_s))
      text += fmt::format(" {} has been silent for {:.0f} s.", name, *silence_s);
  }
  return text;
}

bool is_turn(const WeakAxis& axis) {
  return std::abs(axis.direction.z()) > axis.direction.head<2>().norm();
}

std::string weak_axis_sentence(const WeakAxis& axis) {
  const std::string_view where = is_turn(axis) ? "how the robot is turned" : "one direction";
  const auto sentence = [&](std::string_view rest) {
    return fmt::format("The walls say little about {}; {}.", where, rest);
  };
  switch (axis.source) {
    case WeakAxisSource::kMarkers:
      return sentence("markers measure it");
    case WeakAxisSource::kOdometry:
      return sentence("only odometry measures it, so its error grows with the distance");
    case WeakAxisSource::kNothing:
      return sentence("nothing else measures it");
    case WeakAxisSource::kUnknown:
      break;
  }
  return sentence("what else measures it is not known");
}

std::string_view state_sentence(Health health) {
  switch (health) {
    case Health::kLost:
      return "What the sensors see does not fit the map at this place.";
    case Health::kInitialising:
      return "Slam has not found its place in the map yet.";
    case Health::kUnknown:
      return "Slam does not say how sure it is.";
    case Health::kTracking:
    case Health::kDegenerate:
      break;
  }
  return "The walls fix the position in every direction.";
}

std::string state_sentence(const EstimatedPose& estimate) {
  const bool is_placed =
      estimate.health == Health::kTracking || estimate.health == Health::kDegenerate;
  if (is_placed && estimate.weak_axis) return weak_axis_sentence(*estimate.weak_axis);
  return std::string{state_sentence(estimate.health)};
}

std::string findings_sentence(const std::vector<Finding>& findings) {
  std::string list;
  for (const Finding& finding : findings)
    list += fmt::format("{}{}", list.empty() ? " Found: " : "; ", finding.text);
  return list.empty() ? list : list + ".";
}

}  // namespace

std::string_view health_name(const LiveView& view) {
  if (is_silent(view)) return "silent";
  if (view.estimate) return name_of(view.estimate->health);
  return view.is_unplaced ? name_of(Health::kInitialising) : "waiting";
}

std::string_view source_name(WeakAxisSource source) {
  switch (source) {
    case WeakAxisSource::kOdometry:
      return "odometry";
    case WeakAxisSource::kMarkers:
      return "markers";
    case WeakAxisSource::kNothing:
      return "nothing";
    case WeakAxisSource::kUnknown:
      break;
  }
  return "unknown";
}

std::optional<double> seconds_since(const std::optional<Timestamp>& then, Timestamp now) {
  if (!then) return std::nullopt;
  return std::max(0.0, to_seconds(now - *then));
}

std::string health_reason(const LiveView& view) {
  std::string reason{"Nothing has come from slam yet."};
  if (is_silent(view))
    reason = silence_sentence(view.silences);
  else if (view.estimate)
    reason = state_sentence(*view.estimate);
  else if (view.is_unplaced)
    reason = state_sentence(Health::kInitialising);
  reason += silent_sensors_sentence(view.silences);
  if (!view.estimate && !view.is_unplaced) return reason;
  const auto since_camera_s = seconds_since(view.last_camera, view.time);
  const auto since_marker_s = seconds_since(view.last_marker, view.time);
  if (since_camera_s && *since_camera_s > kCameraSilent_s) {
    reason += fmt::format(" The camera has been silent for {:.0f} s.", *since_camera_s);
  } else if (since_marker_s && *since_marker_s > kMarkerOverdue_s) {
    reason += fmt::format(" No marker for {:.0f} s.", *since_marker_s);
  } else if (!since_marker_s) {
    reason += " No marker so far.";
  }
  return reason + findings_sentence(view.findings);
}

}  // namespace waymark::viewer
