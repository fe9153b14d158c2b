// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/files/text_files.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace waymark::viewer {
namespace {

/// Seconds with six decimals, exact, without floating point.
std::string seconds_text(Timestamp time) {
  const std::int64_t us = to_us(time);
  return fmt::format("{}{}.{:06d}", us < 0 ? "-" : "", std::abs(us / 1'000'000),
                     std::abs(us % 1'000'000));
}

void append_tum_line(std::string& text, Timestamp time, const Se2& frame_from_base) {
  text += fmt::format("{} {:.9f} {:.9f} 0 0 0 {:.12f} {:.12f}\n", seconds_text(time),
                      frame_from_base.x(), frame_from_base.y(),
                      std::sin(frame_from_base.theta() / 2), std::cos(frame_from_base.theta() / 2));
}

double sigma(double variance) {
  return std::sqrt(std::max(variance, 0.0));
}

}  // namespace

std::string tum_text(std::span<const TimedPose> path) {
  std::string text;
  for (const TimedPose& pose : path)
    append_tum_line(text, pose.time, pose.frame_from_base);
  return text;
}

std::string tum_text(std::span<const EstimatedPose> path) {
  std::string text;
  for (const EstimatedPose& pose : path)
    append_tum_line(text, pose.time, pose.map_from_base);
  return text;
}

std::string covariance_csv_text(std::span<const EstimatedPose> path) {
  std::string text = "t,cxx,cxy,cxt,cyy,cyt,ctt,health\n";
  for (const EstimatedPose& pose : path) {
    const Eigen::Matrix3d& c = pose.covariance;
    text += fmt::format("{},{:.9e},{:.9e},{:.9e},{:.9e},{:.9e},{:.9e},{}\n",
                        seconds_text(pose.time), c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2),
                        c(2, 2), static_cast<int>(pose.health));
  }
  return text;
}

std::string markers_csv_text(std::vector<Landmark> landmarks) {
  std::sort(landmarks.begin(), landmarks.end(), [](const Landmark& a, const Landmark& b) {
    return std::tie(a.id, a.instance) < std::tie(b.id, b.instance);
  });
  std::string text =
      "id,instance,x_m,y_m,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad,sightings,"
      "state\n";
  for (const Landmark& landmark : landmarks) {
    const Se2& pose = landmark.map_from_marker;
    const Eigen::Matrix3d& c = landmark.covariance;
    text += fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{},{}\n", landmark.id,
                        landmark.instance, pose.x(), pose.y(), pose.theta(), sigma(c(0, 0)),
                        sigma(c(1, 1)), sigma(c(2, 2)), landmark.sightings,
                        static_cast<int>(landmark.state));
  }
  return text;
}

std::string_view name_of(MapChange::Kind kind) {
  switch (kind) {
    case MapChange::Kind::kMoved:
      return "marker_moved";
    case MapChange::Kind::kMissing:
      return "marker_missing";
    case MapChange::Kind::kNew:
      return "marker_new";
    case MapChange::Kind::kWallNew:
      return "wall_new";
    case MapChange::Kind::kWallGone:
      return "wall_gone";
    case MapChange::Kind::kSurveyOff:
      return "survey_off";
    case MapChange::Kind::kNone:
      break;
  }
  return "none";
}

std::string findings_json_text(std::span<const Finding> findings) {
  auto json = nlohmann::ordered_json::object();
  for (const Finding& finding : findings) {
    auto& entry = json[finding.name];
    entry["value"] = finding.value;
    entry["share"] = finding.share ? nlohmann::ordered_json(*finding.share) : nullptr;
    entry["text"] = finding.text;
  }
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string changes_csv_text(std::span<const MapChange> changes) {
  std::string text = "change,id,instance,x_m,y_m,yaw_rad,was_x_m,was_y_m,size_m,sigmas,support\n";
  for (const MapChange& change : changes) {
    text += fmt::format("{},{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.3f},{:.1f},{}\n",
                        name_of(change.kind), change.id, change.instance, change.place.x(),
                        change.place.y(), change.place.theta(), change.was_at.x(),
                        change.was_at.y(), change.size_m, change.sigmas, change.support);
  }
  return text;
}

}  // namespace waymark::viewer
