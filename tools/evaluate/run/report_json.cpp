// SPDX-License-Identifier: BSD-3-Clause
#include "common/geometry/rounded.hpp"
#include "evaluate/run/report.hpp"

#include <cmath>

namespace waymark::evaluate {
namespace {

/// The number with six decimals; null for NaN and infinity, which JSON does not have.
Json number(double value) {
  return std::isfinite(value) ? Json(rounded(value, 1e6)) : Json{};
}

Json number(const std::optional<double>& value) {
  return value ? number(*value) : Json{};
}

Json max_of(const std::optional<Spread>& spread) {
  return spread ? number(spread->max) : Json{};
}

/// @param text  valid JSON.
Json parsed(const std::optional<std::string>& text) {
  return text ? Json::parse(*text) : Json{};
}

Json text_or_null(const std::optional<std::string>& text) {
  return text ? Json(*text) : Json{};
}

Json json_of(const std::optional<MarkerError>& error) {
  Json json;
  json["markers_matched"] = error ? Json(error->matched) : Json{};
  json["markers_missing"] = error ? Json(error->missing) : Json{};
  json["markers_spurious"] = error ? Json(error->spurious) : Json{};
  json["markers_tentative"] = error ? Json(error->tentative) : Json{};
  json["marker_map_share"] = error ? number(error->right_share) : Json{};
  json["moved_named_share"] = error ? number(error->moved_named_share) : Json{};
  json["marker_error_mean_m"] = error ? number(error->mean_position_m) : Json{};
  json["marker_error_max_m"] = error ? number(error->max_position_m) : Json{};
  json["marker_yaw_error_mean_deg"] = error ? number(error->mean_yaw_deg) : Json{};
  json["marker_yaw_error_max_deg"] = error ? number(error->max_yaw_deg) : Json{};
  return json;
}

Json json_of(const std::optional<Nees>& nees) {
  Json json;
  json["nees_mean"] = nees ? number(nees->mean) : Json{};
  json["nees_share_in_95_band"] = nees ? number(nees->share_in_band) : Json{};
  json["nees_poses"] = nees ? Json(nees->poses) : Json{};
  json["nees_missing"] = nees ? Json(nees->missing) : Json{};
  json["nees_invalid"] = nees ? Json(nees->invalid) : Json{};
  json["nees_singular"] = nees ? Json(nees->singular) : Json{};
  return json;
}

Json json_of(const std::optional<Overlap>& overlap) {
  Json json;
  json["poses_outside_truth"] = overlap ? Json(overlap->outside) : Json{};
  json["first_pose_s"] = overlap ? number(overlap->first_pose_s) : Json{};
  json["truth_covered_share"] = overlap ? number(overlap->covered_share) : Json{};
  return json;
}

Json json_of(const std::optional<HealthSummary>& health_summary) {
  const Kidnap* const kidnap =
      health_summary && health_summary->kidnap ? &*health_summary->kidnap : nullptr;
  Json json;
  json["max_jump_m"] = health_summary ? number(health_summary->max_jump_m) : Json{};
  json["share_tracking"] = health_summary ? number(health_summary->share_tracking) : Json{};
  json["share_degenerate"] = health_summary ? number(health_summary->share_degenerate) : Json{};
  json["share_lost"] = health_summary ? number(health_summary->share_lost) : Json{};
  json["lifted_at_s"] = kidnap ? number(kidnap->lifted_t_s) : Json{};
  json["first_sighting_at_s"] = kidnap ? number(kidnap->sighting_t_s) : Json{};
  json["says_lost_s"] = kidnap ? number(kidnap->says_lost_s) : Json{};
  json["found_again_s"] = kidnap ? number(kidnap->found_again_s) : Json{};
  json["confident_wrong_s"] = kidnap ? number(kidnap->confident_wrong_s) : Json{};
  return json;
}

Json json_of(const std::vector<ExpectedFigure>& figures) {
  Json json = Json::array();
  for (const ExpectedFigure& figure : figures)
    json.push_back({{"figure", figure.key},
                    {"limit", number(figure.limit)},
                    {"got", number(figure.got)},
                    {"hit", figure.is_hit}});
  return json;
}

/// The object with all values null.
Json nulls_like(Json json) {
  for (auto& value : json)
    value = nullptr;
  return json;
}

/// The object with "final_" before each key.
Json as_final(const Json& json) {
  Json renamed;
  for (const auto& [key, value] : json.items())
    renamed["final_" + key] = value;
  return renamed;
}

}  // namespace

Json json_of(const corridor::CorridorLength& length, std::optional<double> true_length_m) {
  Json json;
  json["length_px"] = number(length.length_px);
  json["pixel_length_m"] = number(length.length_m / length.length_px);
  json["length_m"] = number(length.length_m);
  json["width_px"] = number(length.width_px);
  json["length_method"] = name_of(length.method);
  json["length_flags"] = length.flags;
  json["true_length_m"] = number(true_length_m);
  json["accuracy_percent"] =
      true_length_m ? number(corridor::accuracy_percent(length.length_m, *true_length_m)) : Json{};
  return json;
}

Json json_of(const TrajectoryError& error) {
  Json json;
  json["poses"] = error.poses;
  json["duration_s"] = number(error.duration_s);
  json["ate_origin_m"] = number(error.ate_origin_m);
  json["ate_se2_m"] = number(error.ate_se2_m);
  if (error.ate_frame_m) json["ate_frame_m"] = number(*error.ate_frame_m);
  json["alignment"] = name_of(error.alignment);  // applies to the keys below, except RPE
  json["along_rmse_m"] = number(rms_of(error.along_m));
  json["along_max_m"] = max_of(error.along_m);
  json["across_rmse_m"] = number(rms_of(error.across_m));
  json["across_max_m"] = max_of(error.across_m);
  json["heading_rmse_deg"] = number(error.heading_deg.rms);
  json["heading_max_deg"] = number(error.heading_deg.max);
  json["distance_max_m"] = number(error.distance_m.max);
  json["end_distance_m"] = number(error.end_distance_m);
  json["end_heading_deg"] = number(error.end_heading_deg);
  json["rpe_pairs_1m"] = error.rpe_pairs;
  json["rpe_translation_rmse_m"] = number(rms_of(error.rpe_translation_m));
  json["rpe_translation_max_m"] = max_of(error.rpe_translation_m);
  json["rpe_rotation_rmse_deg"] = number(rms_of(error.rpe_rotation_deg));
  json["rpe_rotation_max_deg"] = max_of(error.rpe_rotation_deg);
  return json;
}

Json json_of(const RelationsError& error) {
  Json json;
  const auto add = [&json](const std::string& prefix, const RelationsSummary& summary) {
    json[prefix + "count"] = summary.count;
    json[prefix + "translation_mean_m"] = number(summary.translation_m.mean);
    json[prefix + "translation_sigma_m"] = number(summary.translation_m.sigma);
    json[prefix + "rotation_mean_deg"] = number(summary.rotation_deg.mean);
    json[prefix + "rotation_sigma_deg"] = number(summary.rotation_deg.sigma);
  };
  add("", error.all);
  add("near_", error.near);
  add("far_", error.far);
  return json;
}

Json metrics_json(const EstimatorResult& result) {
  Json json;
  json["estimator"] = result.name;
  json.update(result.length ? json_of(*result.length, result.true_length_m)
                            : nulls_like(json_of(corridor::CorridorLength{}, std::nullopt)));
  json["true_length_m"] = number(result.true_length_m);
  json.update(result.trajectory ? json_of(*result.trajectory)
                                : nulls_like(json_of(TrajectoryError{})));
  json.update(as_final(result.final_trajectory ? json_of(*result.final_trajectory)
                                               : nulls_like(json_of(TrajectoryError{}))));
  json.update(json_of(result.overlap));
  json.update(as_final(json_of(result.final_overlap)));
  json.update(json_of(result.markers));
  json.update(json_of(result.nees));
  json["wall_cells"] = result.wall_cells ? Json(*result.wall_cells) : Json{};
  json.update(json_of(result.health_summary));
  json["driven_m"] = number(result.driven_m);
  json["memory_mb_per_m"] = number(result.memory_mb_per_m);
  json["sigma_growth"] = number(result.sigma_growth);
  json["expectations"] = json_of(result.expectations);
  json["expected_of_seeds"] = {{"nees_in_band_share", number(result.expect.nees_in_band_share)},
                               {"seeds_share", number(result.expect.seeds_share)}};
  json["timings"] = parsed(result.timings_json);
  json["changes"] = result.changes;
  json["findings"] = parsed(result.findings_json);
  json["problems"] = result.problems;
  json["notes"] = result.notes;
  json["skipped"] = result.skipped;
  return json;
}

Json results_json(const RunTruth& truth, const std::vector<EstimatorResult>& results) {
  Json json;
  json["true_length_m"] = number(truth.length_m);
  json["true_trajectory"] = truth.trajectory.has_value();
  json["true_markers"] = truth.markers ? Json(truth.markers->size()) : Json{};
  json["scenario_toml"] = text_or_null(truth.scenario_toml);
  json["faults_toml"] = text_or_null(truth.faults_toml);
  json["skipped"] = truth.skipped;
  json["estimators"] = Json::array();
  for (const EstimatorResult& result : results) {
    Json metrics = metrics_json(result);
    metrics["config_toml"] = text_or_null(result.config_toml);
    json["estimators"].push_back(metrics);
  }
  return json;
}

}  // namespace waymark::evaluate
