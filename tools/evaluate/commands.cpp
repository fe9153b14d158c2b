// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/commands.hpp"

#include "common/config/config.hpp"
#include "common/errors/setup_error.hpp"
#include "common/files/whole_file.hpp"
#include "evaluate/files/map_image.hpp"
#include "evaluate/run/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>

namespace waymark::evaluate {
namespace {

namespace fs = std::filesystem;

/// Prints on standard error what part of the reference an estimate leaves out. @return the exit
/// code.
int report_overlap(const Overlap& overlap, const fs::path& estimate_file, const Output& output) {
  constexpr std::string_view kTruth = "reference";
  const std::vector<std::string> problems = problems_of(overlap, kTruth);
  for (const std::string& problem : problems)
    fmt::print(stderr, "{}: {}\n", estimate_file.string(), problem);
  if (const auto late = late_start_of(overlap, kTruth))
    fmt::print(stderr, "{}: {}\n", estimate_file.string(), *late);
  return problems.empty() || output.tolerant ? kExitOk : kExitFailed;
}

/// Prints JSON, or one `key: value` per line without null values.
void print(const Json& json, const Output& output) {
  if (output.json) {
    fmt::print("{}\n", json.dump(2));
    return;
  }
  for (const auto& [key, value] : json.items()) {
    if (!value.is_null())
      fmt::print("{}: {}\n", key, value.is_string() ? value.get<std::string>() : value.dump());
  }
}

std::string file_text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace

int report_skipped(const SkippedLines& skipped, const Output& output) {
  constexpr std::size_t kShown = 10;
  for (std::size_t i = 0; i < std::min(skipped.size(), kShown); ++i)
    fmt::print(stderr, "skipped: {}\n", skipped[i]);
  if (skipped.size() > kShown) fmt::print(stderr, "skipped: {} more\n", skipped.size() - kShown);
  return skipped.empty() || output.tolerant ? kExitOk : kExitFailed;
}

int run_length(const fs::path& map_yaml, std::optional<double> true_length_m,
               const Output& output) {
  const MapImage map = read_map(map_yaml);
  try {
    print(json_of(corridor::measure_corridor(map), true_length_m), output);
  } catch (const corridor::NotACorridor& error) {
    throw SetupError{fmt::format("{}: {}", map_yaml.string(), error.what())};
  }
  return kExitOk;
}

int run_trajectory(const fs::path& estimate_file, const fs::path& reference_file,
                   Alignment alignment, const Output& output) {
  SkippedLines skipped;
  const Trajectory estimate = read_tum(estimate_file, skipped);
  const Trajectory reference = read_tum(reference_file, skipped);
  const std::vector<PosePair> pairs = associate(estimate, reference);
  if (pairs.size() < 2)
    throw SetupError{
        fmt::format("{}: fewer than two poses within the time span of {}; are the two of one run?",
                    estimate_file.string(), reference_file.string())};
  const Overlap overlap = overlap_of(estimate, reference, pairs);
  Json json = json_of(trajectory_error(pairs, alignment));
  json["poses_outside_reference"] = overlap.outside;
  json["first_pose_s"] = overlap.first_pose_s;
  json["reference_covered_share"] = overlap.covered_share;
  json["skipped"] = skipped.size();
  print(json, output);
  const int overlap_code = report_overlap(overlap, estimate_file, output);
  const int skipped_code = report_skipped(skipped, output);
  return overlap_code == kExitOk ? skipped_code : overlap_code;
}

int run_relations(const fs::path& trajectory_file, const fs::path& relations_file,
                  const Output& output) {
  SkippedLines skipped;
  const Trajectory trajectory = read_tum(trajectory_file, skipped);
  const std::vector<Relation> relations = read_relations(relations_file, skipped);
  const RelationsError error = relations_error(trajectory, relations, relations_file, skipped);
  Json json = json_of(error);
  json["skipped"] = skipped.size();
  print(json, output);
  const int skipped_code = report_skipped(skipped, output);
  if (error.all.count > 0) return skipped_code;
  fmt::print(stderr, "{}: no relation lies within the trajectory\n", relations_file.string());
  return kExitFailed;
}

int run_run(const fs::path& run_dir, const std::vector<std::string>& wanted,
            const EvaluationOptions& given, const Output& output) {
  if (!fs::is_directory(run_dir))
    throw SetupError{run_dir.string() + ": not a folder; give the output folder of a run"};
  const std::vector<std::string> found = estimators_in(run_dir);
  if (found.empty())
    throw SetupError{run_dir.string() +
                     ": no sub-folder with a trajectory.tum; run an estimator on its log first"};
  for (const std::string& name : wanted) {
    if (std::find(found.begin(), found.end(), name) == found.end())
      throw SetupError{fmt::format("{}: no estimator '{}' (with a trajectory.tum); there are: {}",
                                   run_dir.string(), name, fmt::join(found, ", "))};
  }
  const RunTruth truth = read_truth(run_dir, given);
  std::vector<EstimatorResult> results;
  SkippedLines skipped = truth.skipped;
  EvaluationOptions options = given;
  if (!given.mapped_in.empty()) {
    const fs::path file = given.mapped_in / "truth.tum";
    const Trajectory mapping = read_tum(file, skipped);
    if (mapping.empty()) throw SetupError{file.string() + ": no pose, so no frame of the map"};
    options.world_from_map = mapping.front().parent_from_base;
  }
  bool complete = true;
  for (const std::string& name : found) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), name) == wanted.end()) continue;
    results.push_back(evaluate_estimator(run_dir / name, truth, options));
    const EstimatorResult& result = results.back();
    write_whole_file(run_dir / name / "metrics.json", file_text(metrics_json(result)));
    write_whole_file(run_dir / name / "stations.csv", stations_csv(result.stations));
    skipped.insert(skipped.end(), result.skipped.begin(), result.skipped.end());
    complete = complete && result.problems.empty() && !misses_a_figure(result.expectations);
  }
  const Json json = results_json(truth, results);
  const std::string markdown = results_markdown(truth, results);
  write_whole_file(run_dir / "results.json", file_text(json));
  write_whole_file(run_dir / "results.md", markdown);
  fmt::print("{}", output.json ? file_text(json) : markdown);
  const int skipped_code = report_skipped(skipped, output);
  return complete ? skipped_code : kExitFailed;
}

}  // namespace waymark::evaluate
