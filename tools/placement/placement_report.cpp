// SPDX-License-Identifier: BSD-3-Clause
#include "placement/placement_report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace waymark::placement {
namespace {

using Json = nlohmann::ordered_json;

std::string verdict(const Placement& placement) {
  if (placement.is_model_refuted()) {
    return fmt::format(
        "By the model the target is met as it is, but not in the run, whose sigma was {:.4f} m: "
        "the model does not hold for this log, so that it cannot say where markers would help.\n",
        *placement.worst_run_m);
  }
  if (placement.worst_now_m() <= placement.target_m)
    return "The target is met as it is: no new marker is needed.\n";
  if (placement.is_met())
    return fmt::format("{} new marker{} bring{} the worst sigma from {:.4f} to {:.4f} m.\n",
                       placement.markers.size(), placement.markers.size() == 1 ? "" : "s",
                       placement.markers.size() == 1 ? "s" : "", placement.worst_now_m(),
                       placement.worst_then_m());
  if (placement.free_places == 0)
    return "The target cannot be met: there is no bare, straight piece of wall wide enough for a "
           "marker.\n";
  if (placement.markers.size() == placement.free_ids)
    return fmt::format("The target is not met with the {} ids that are free.\n",
                       placement.free_ids);
  if (placement.advice.everywhere_m <= placement.target_m)
    return "No few markers were found with which the target is met; with one about every 2 m along "
           "every wall it would be.\n";
  return fmt::format(
      "No markers were found with which the target is met: with one about every 2 m along every "
      "wall the worst sigma is {:.4f} m.\n",
      placement.advice.everywhere_m);
}

Json json_of(const Stretch& stretch, const std::vector<Step>& steps) {
  const auto place = [](const Step& step) {
    return Json{{"travel_m", step.travel_m},
                {"x_m", step.map_from_base.x()},
                {"y_m", step.map_from_base.y()}};
  };
  return {{"from", place(steps[stretch.first])},
          {"to", place(steps[stretch.last])},
          {"worst_sigma_m", stretch.worst_m}};
}

template <class Number>
Json or_null(const std::optional<Number>& value) {
  return value ? Json(*value) : Json();
}

}  // namespace

std::string placement_text(const PlacementInput& input, const Placement& placement) {
  std::string text;
  text += fmt::format("{}: {} markers, {:.1f} m driven; target {} m\n", input.source.string(),
                      input.markers.size(), placement.steps.back().travel_m, placement.target_m);
  for (const std::string& note : input.notes)
    text += fmt::format("note: {}\n", note);
  text += fmt::format(
      "sigma of the position along the axis that the walls do not show: {:.4f} m at "
      "worst by the model",
      placement.worst_now_m());
  if (placement.worst_run_m) {
    text += fmt::format(", {:.4f} m in the run at {:.1f} m", *placement.worst_run_m,
                        placement.steps[*placement.worst_run_at].travel_m);
  }
  if (placement.model_over_run)
    text += fmt::format("; model / run {:.2f} (median)", *placement.model_over_run);
  text += "\n";
  if (placement.across_m > placement.target_m) {
    text += fmt::format(
        "In its worst direction the position has {:.4f} m: what grows across the walls "
        "is the heading's drift, which markers hardly change.\n",
        placement.across_m);
  }
  if (!placement.stretches.empty())
    text +=
        "\nabove the target\n  from [m]    to [m]   from (x, y)         to (x, y)           "
        "worst [m]\n";
  for (const Stretch& stretch : placement.stretches) {
    const Step& from = placement.steps[stretch.first];
    const Step& to = placement.steps[stretch.last];
    text += fmt::format("{:10.1f}{:10.1f}   ({:7.2f},{:7.2f})   ({:7.2f},{:7.2f})   {:9.4f}\n",
                        from.travel_m, to.travel_m, from.map_from_base.x(), from.map_from_base.y(),
                        to.map_from_base.x(), to.map_from_base.y(), stretch.worst_m);
  }
  if (!placement.markers.empty())
    text +=
        "\nhang, in this order\n  id  wall    passed at [m]      x [m]      y [m]  yaw [deg]  "
        "worst sigma then [m]\n";
  for (const NewMarker& marker : placement.markers) {
    const Se2& pose = marker.place.map_from_marker;
    text += fmt::format("{:4}  {:6}{:15.1f}{:11.2f}{:11.2f}{:11.1f}{:22.4f}\n", marker.id,
                        marker.place.wall, marker.place.travel_m, pose.x(), pose.y(),
                        degrees(pose.theta()), marker.worst_after_m);
  }
  text += "\n";
  text += verdict(placement);
  for (const Limit& limit : placement.limits)
    text += fmt::format("It is limited by {}: {:.4f} m without that.\n", limit.cause,
                        limit.without_it_m);
  return text;
}

std::string placement_json(const PlacementInput& input, const Placement& placement) {
  Json json{{"source", input.source.string()},
            {"target_sigma_m", placement.target_m},
            {"driven_m", placement.steps.back().travel_m},
            {"markers", input.markers.size()},
            {"met", placement.is_met()},
            {"worst_sigma_now_m", placement.worst_now_m()},
            {"worst_sigma_run_m", or_null(placement.worst_run_m)},
            {"model_over_run", or_null(placement.model_over_run)},
            {"worst_sigma_any_direction_m", placement.across_m},
            {"worst_sigma_then_m", placement.worst_then_m()},
            {"reachable_sigma_m", placement.reachable_m()}};
  json["stretches"] = Json::array();
  for (const Stretch& stretch : placement.stretches)
    json["stretches"].push_back(json_of(stretch, placement.steps));
  json["places"] = Json::array();
  for (const NewMarker& marker : placement.markers) {
    const Se2& pose = marker.place.map_from_marker;
    json["places"].push_back({{"id", marker.id},
                              {"wall", marker.place.wall},
                              {"travel_m", marker.place.travel_m},
                              {"x_m", pose.x()},
                              {"y_m", pose.y()},
                              {"yaw_rad", pose.theta()},
                              {"worst_sigma_then_m", marker.worst_after_m}});
  }
  json["limits"] = Json::array();
  for (const Limit& limit : placement.limits)
    json["limits"].push_back(
        {{"cause", limit.cause}, {"worst_sigma_without_m", limit.without_it_m}});
  json["notes"] = input.notes;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string placement_csv(const Placement& placement) {
  std::string text =
      "id,instance,x_m,y_m,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad,sightings,state\n";
  for (const NewMarker& marker : placement.markers) {
    const Se2& pose = marker.place.map_from_marker;
    text += fmt::format("{},0,{:.6f},{:.6f},{:.6f},0,0,0,0,0\n", marker.id, pose.x(), pose.y(),
                        pose.theta());
  }
  return text;
}

}  // namespace waymark::placement
