// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/run/run_evaluation.hpp"

#include "common/config/config.hpp"
#include "evaluate/map/wall_thickness.hpp"
#include "evaluate/run/loaded_map.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <sstream>

namespace waymark::evaluate {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> text_if_there(const fs::path& file) {
  if (!fs::exists(file)) return std::nullopt;
  return read_text(file);
}

constexpr const char* kOneCorridor = "straight";

/// The part of a scenario that the evaluation reads.
struct ScenarioPart {
  struct World {
    std::string layout{kOneCorridor};
    double length_m{50.0};  ///< as in WorldConfig

    void describe(Fields& fields) {
      fields.field("layout", layout, "only a straight corridor has a length");
      fields.field("length_m", length_m, kPositive, "between the inner faces of the end walls");
    }
  };

  World world{};
  ExpectConfig expect{};

  void describe(Fields& fields) {
    fields.section("world", world);
    fields.section("expect", expect);
  }
};

/// Reads expect.toml, in which (unlike in a scenario) unknown keys are errors.
ExpectConfig read_expectations(const fs::path& file) {
  return load_config<ExpectFile>({{file}, {}}).expect;
}

/// The part of slam's configuration that the evaluation reads. Defaults are slam's.
struct SlamPart {
  static constexpr const char* kWaymark = "waymark";
  static constexpr const char* kNewMap = "map";

  struct Slam {
    std::string estimator{kWaymark};
    std::string mode{kNewMap};

    void describe(Fields& fields) {
      fields.field("estimator", estimator, "only one of them uses a survey");
      fields.field("mode", mode, "in the others the frame is that of the loaded map");
    }
  };

  struct Robot {
    struct Markers {
      std::string survey_file{};

      void describe(Fields& fields) {
        fields.field("survey_file", survey_file, "a survey defines the map's frame");
      }
    };

    Markers markers{};

    void describe(Fields& fields) { fields.section("markers", markers); }
  };

  Robot robot{};
  Slam slam{};

  void describe(Fields& fields) {
    fields.section("robot", robot);
    fields.section("slam", slam);
  }

  bool uses_survey() const {
    return slam.estimator == kWaymark && slam.mode == kNewMap && !robot.markers.survey_file.empty();
  }
};

/// True if slam drew its map in a survey's frame, which is the world frame.
bool is_surveyed(const fs::path& config_file) {
  return fs::exists(config_file) && load_part<SlamPart>(config_file).uses_survey();
}

/// @throws SetupError if the file exists and is not JSON.
std::optional<std::string> json_if_there(const fs::path& file) {
  std::optional<std::string> text = text_if_there(file);
  if (text && !nlohmann::json::accept(*text)) throw SetupError{file.string() + ": not JSON"};
  return text;
}

/// Content of timings.json, if the file exists.
/// @throws SetupError if it has no counters of slam in the expected form.
std::optional<std::string> timings_if_there(const fs::path& file) {
  std::optional<std::string> text = json_if_there(file);
  if (!text) return std::nullopt;
  const auto timings = nlohmann::json::parse(*text);
  const auto pointer = nlohmann::json::json_pointer{"/slam/counters"};
  if (!timings.contains(pointer)) return text;
  const auto is_counter = [](const nlohmann::json& counter) {
    return counter.is_object() && counter.value("kind", nlohmann::json("")).is_string();
  };
  const auto& counters = timings.at(pointer);
  if (!counters.is_array() || !std::all_of(counters.begin(), counters.end(), is_counter))
    throw SetupError{file.string() + ": slam.counters is not a list of objects with a kind"};
  return text;
}

/// Lines of changes.csv after its header; empty without the file.
std::vector<std::string> changes_in(const fs::path& file) {
  std::vector<std::string> lines;
  std::istringstream text{text_if_there(file).value_or("")};
  for (std::string line; std::getline(text, line);)
    lines.push_back(line);
  if (!lines.empty()) lines.erase(lines.begin());
  return lines;
}

/// Runs one part of the evaluation; a SetupError is added to the problems.
void attempt(std::vector<std::string>& problems, const std::function<void()>& part) {
  try {
    part();
  } catch (const SetupError& error) {
    problems.emplace_back(error.what());
  }
}

/// A trajectory with the truth at its times.
struct Compared {
  std::vector<PosePair> pairs{};  ///< at least two
  Overlap overlap{};
};

/// Adds what is wrong with the overlap to the problems.
/// @throws SetupError when fewer than two poses lie within the truth's times.
Compared compare(const fs::path& file, const Trajectory& truth, EstimatorResult& result) {
  const Trajectory estimate = read_tum(file, result.skipped);
  Compared compared{associate(estimate, truth), {}};
  if (compared.pairs.size() < 2)
    throw SetupError{file.string() + ": fewer than two poses within the truth's time span"};
  compared.overlap = overlap_of(estimate, truth, compared.pairs);
  for (const std::string& problem : problems_of(compared.overlap, "truth"))
    result.problems.push_back(fmt::format("{}: {}", file.string(), problem));
  if (const auto late = late_start_of(compared.overlap, "truth"))
    result.notes.push_back(fmt::format("{} {}", file.filename().string(), *late));
  return compared;
}

void add_nees(const fs::path& covariance_file, const std::vector<PosePair>& pairs,
              const std::vector<StampedCovariance>& covariances, const Se2& world_from_map,
              EstimatorResult& result) {
  const Nees& nees = result.nees.emplace(evaluate::nees(pairs, covariances, world_from_map));
  if (leaves_out_too_many(nees, nees.missing + nees.invalid))
    result.problems.push_back(
        fmt::format("{}: of {} poses, {} have no covariance and {} an invalid one",
                    covariance_file.string(), pairs.size(), nees.missing, nees.invalid));
  if (leaves_out_too_many(nees, nees.singular))
    result.notes.push_back(fmt::format("{} of {} covariances are singular, and left out of NEES",
                                       nees.singular, pairs.size()));
}

void add_trajectory(const fs::path& dir, const RunTruth& truth, const EvaluationOptions& options,
                    EstimatorResult& result, Se2& world_from_map) {
  const auto [pairs, overlap] = compare(dir / "trajectory.tum", *truth.trajectory, result);
  result.overlap = overlap;
  result.trajectory = trajectory_error(pairs, options.alignment, options.world_from_map);
  world_from_map =
      options.world_from_map ? *options.world_from_map : align(pairs, Alignment::kOrigin);
  const fs::path covariance_file = dir / "covariance.csv";
  std::vector<StampedCovariance> covariances;
  if (fs::exists(covariance_file)) {
    covariances = read_covariances(covariance_file, result.skipped);
    add_nees(covariance_file, pairs, covariances, world_from_map, result);
  }
  result.driven_m = driven_m(pairs);
  result.stations = stations(pairs, covariances, world_from_map);
  result.health_summary =
      health_summary(pairs, covariances, world_from_map, truth.lifted_t_s, truth.sightings_s);
}

void add_final_trajectory(const fs::path& dir, const Trajectory& truth,
                          const EvaluationOptions& options, EstimatorResult& result) {
  const fs::path file = dir / "trajectory_final.tum";
  if (!fs::exists(file)) return;
  const auto [pairs, overlap] = compare(file, truth, result);
  result.final_overlap = overlap;
  result.final_trajectory = trajectory_error(pairs, options.alignment, options.world_from_map);
}

/// slam.peak_memory_mb of timings.json.
std::optional<double> peak_memory_mb(const std::optional<std::string>& timings_json) {
  if (!timings_json) return std::nullopt;
  const auto timings = nlohmann::json::parse(*timings_json);
  const auto pointer = nlohmann::json::json_pointer{"/slam/peak_memory_mb"};
  if (!timings.contains(pointer) || !timings.at(pointer).is_number()) return std::nullopt;
  return timings.at(pointer).get<double>();
}

/// Adds figures that depend on the scenario's expectations, and checks them.
void add_figures_of_scenario(const ExpectConfig& expect, EstimatorResult& result) {
  const auto memory_mb = peak_memory_mb(result.timings_json);
  if (memory_mb && result.driven_m.value_or(0.0) > 0.0)
    result.memory_mb_per_m = *memory_mb / *result.driven_m;
  if (expect.sigma_growth_to_m > expect.sigma_growth_from_m)
    result.sigma_growth =
        sigma_growth(result.stations, expect.sigma_growth_from_m, expect.sigma_growth_to_m);
  if (is_expected_of(expect, result.name)) result.expect = expect;
  result.expectations = check_expectations(expect, result);
}

/// Position of an estimator in the table, see estimators_in().
std::size_t rank_of(const std::string& name) {
  constexpr std::array<std::string_view, 4> kFirst{"odometry", "gmapping", "gmapping_turtlebot3",
                                                   "marker_matching"};
  const auto found = std::find(kFirst.begin(), kFirst.end(), name);
  if (found != kFirst.end()) return static_cast<std::size_t>(found - kFirst.begin());
  if (name.starts_with("marker_matching_")) return kFirst.size();
  return name == "waymark" ? kFirst.size() + 1 : kFirst.size() + 2;
}

}  // namespace

RunTruth read_truth(const fs::path& run_dir, const EvaluationOptions& options) {
  RunTruth truth{};
  truth.scenario_toml = text_if_there(run_dir / "scenario.toml");
  if (truth.scenario_toml) {
    const ScenarioPart scenario = load_part<ScenarioPart>(run_dir / "scenario.toml");
    truth.is_one_corridor = scenario.world.layout == kOneCorridor;
    if (truth.is_one_corridor) truth.length_m = scenario.world.length_m;
    truth.expect = scenario.expect;
  }
  truth.faults_toml = text_if_there(run_dir / "variant_applied.toml");
  if (fs::exists(run_dir / "expect.toml"))
    truth.expect = read_expectations(run_dir / "expect.toml");
  if (options.true_length_m) {
    truth.length_m = options.true_length_m;
    truth.is_one_corridor = true;
  }
  if (fs::exists(run_dir / "truth.tum"))
    truth.trajectory = read_tum(run_dir / "truth.tum", truth.skipped);
  if (truth.trajectory) truth.lifted_t_s = lifted_t_s(*truth.trajectory);
  if (truth.lifted_t_s && fs::exists(run_dir / "run.lcm"))
    truth.sightings_s = sighting_times(run_dir / "run.lcm");
  if (fs::exists(run_dir / "truth_markers.csv"))
    truth.markers = read_markers(run_dir / "truth_markers.csv", truth.skipped);
  if (truth.markers && fs::exists(run_dir / "truth_marker_moves.csv"))
    truth.markers = with_moves(*truth.markers, run_dir / "truth_marker_moves.csv", truth.skipped);
  return truth;
}

std::vector<std::string> estimators_in(const fs::path& run_dir) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator{run_dir}) {
    if (fs::exists(entry.path() / "trajectory.tum"))
      names.push_back(entry.path().filename().string());
  }
  std::sort(names.begin(), names.end(), [](const std::string& a, const std::string& b) {
    return std::pair{rank_of(a), a} < std::pair{rank_of(b), b};
  });
  return names;
}

EstimatorResult evaluate_estimator(const fs::path& dir, const RunTruth& truth,
                                   const EvaluationOptions& run_options) {
  EstimatorResult result{};
  EvaluationOptions options = run_options;
  attempt(result.problems, [&] {
    if (!options.world_from_map && is_surveyed(dir / "config.toml")) options.world_from_map = Se2{};
    result.changes = changes_in(dir / "changes.csv");
  });
  attempt(result.problems, [&] {
    if (options.mapped_in.empty()) return;
    const auto foreign = foreign_map(dir / "markers.csv", options.mapped_in, result.skipped);
    if (!foreign) return;
    options.world_from_map.reset();
    result.problems.push_back(*foreign);
  });
  result.name = dir.filename().string();
  result.true_length_m = truth.length_m;
  attempt(result.problems, [&] {
    const fs::path map_file = dir / "map.yaml";
    const MapImage map = read_map(map_file);
    result.wall_cells = wall_thickness_cells(map);
    if (!truth.is_one_corridor) return;
    try {
      result.length = corridor::measure_corridor(map);
    } catch (const corridor::NotACorridor& error) {
      throw SetupError{fmt::format("{}: {}", map_file.string(), error.what())};
    }
  });
  std::optional<Se2> world_from_map;
  if (truth.trajectory) {
    attempt(result.problems, [&] {
      Se2 aligned;
      add_trajectory(dir, truth, options, result, aligned);
      world_from_map = aligned;
    });
    attempt(result.problems,
            [&] { add_final_trajectory(dir, *truth.trajectory, options, result); });
  }
  if (truth.markers && world_from_map && fs::exists(dir / "markers.csv")) {
    attempt(result.problems, [&] {
      result.markers = marker_error(read_markers(dir / "markers.csv", result.skipped),
                                    *truth.markers, *world_from_map, options.marker_gate_m);
    });
  }
  attempt(result.problems, [&] { result.config_toml = text_if_there(dir / "config.toml"); });
  attempt(result.problems, [&] { result.timings_json = timings_if_there(dir / "timings.json"); });
  attempt(result.problems, [&] { result.findings_json = json_if_there(dir / "findings.json"); });
  add_figures_of_scenario(truth.expect, result);
  return result;
}

}  // namespace waymark::evaluate
