// SPDX-License-Identifier: BSD-3-Clause
// Evaluation of a run folder: ground truth, and each estimator's files compared with it.
#pragma once

#include "common/corridor/corridor_length.hpp"
#include "evaluate/map/marker_error.hpp"
#include "evaluate/run/expectation.hpp"
#include "evaluate/trajectory/overlap.hpp"
#include "evaluate/trajectory/stations.hpp"
#include "evaluate/trajectory/timeline.hpp"
#include "evaluate/trajectory/trajectory_error.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace waymark::evaluate {

struct EvaluationOptions {
  Alignment alignment{Alignment::kOrigin};
  std::filesystem::path mapped_in{};  ///< run that made the map; its first true pose is the origin
  std::optional<Se2> world_from_map{};    ///< of the map made in `mapped_in`
  std::optional<double> true_length_m{};  ///< overrides the scenario's
  double marker_gate_m{5.0};              ///< largest distance between an estimate and its marker
};

/// Ground truth and expectations; each part only if the run folder has it.
struct RunTruth {
  std::optional<std::string> scenario_toml{};
  std::optional<std::string> faults_toml{};  ///< variant applied by waymark-faults
  std::optional<double> length_m{};
  bool is_one_corridor{true};  ///< an L or a ring has no length from end wall to end wall
  ExpectConfig expect{};
  std::optional<Trajectory> trajectory{};
  std::optional<std::vector<Marker>> markers{};
  std::optional<double> lifted_t_s{};  ///< when the robot was lifted and put down elsewhere
  std::vector<double> sightings_s{};   ///< times of frames with a marker; only if it was lifted
  SkippedLines skipped{};
};

/// All results of one estimator. nullopt = not available: see `problems`, or the truth is missing.
struct EstimatorResult {
  std::string name{};
  std::optional<corridor::CorridorLength> length{};
  std::optional<double> true_length_m{};
  std::optional<int> wall_cells{};                    ///< wall thickness [cells]
  std::optional<TrajectoryError> trajectory{};        ///< errors of the poses published in the run
  std::optional<TrajectoryError> final_trajectory{};  ///< errors of the poses corrected at the end
  std::optional<Overlap> overlap{};                   ///< of the published poses with the truth
  std::optional<Overlap> final_overlap{};             ///< of the corrected poses with the truth
  std::optional<MarkerError> markers{};
  std::optional<Nees> nees{};
  std::vector<Station> stations{};
  std::optional<HealthSummary> health_summary{};
  std::optional<double> driven_m{};         ///< distance that the true robot drove
  std::optional<double> sigma_growth{};     ///< between the stations given in [expect]
  std::optional<double> memory_mb_per_m{};  ///< peak memory of the process / driven_m
  std::vector<ExpectedFigure> expectations{};
  ExpectConfig expect{};  ///< all zero if nothing is expected of this estimator
  std::optional<std::string> config_toml{};
  std::optional<std::string> timings_json{};
  std::vector<std::string> changes{};  ///< lines of changes.csv after its header
  std::optional<std::string> findings_json{};
  std::vector<std::string> problems{};  ///< why figures are missing, or are not those of the run
  std::vector<std::string> notes{};     ///< omissions that do not make a figure wrong
  SkippedLines skipped{};               ///< lines that were left out
};

/// Reads scenario.toml ([world] layout and length_m, default 50, and [expect], which an expect.toml
/// replaces), truth.tum, truth_markers.csv and truth_marker_moves.csv; and, if the robot was
/// lifted, the times of frames with markers from run.lcm.
/// @throws SetupError for existing files that cannot be read.
RunTruth read_truth(const std::filesystem::path& run_dir, const EvaluationOptions& options);

/// Names of the sub-folders with a trajectory.tum, in the table's order: odometry, gmapping,
/// gmapping_turtlebot3, marker_matching, its variants, waymark, others.
std::vector<std::string> estimators_in(const std::filesystem::path& run_dir);

/// Errors in the estimator's files become `problems` of the result, not exceptions.
EstimatorResult evaluate_estimator(const std::filesystem::path& estimator_dir,
                                   const RunTruth& truth, const EvaluationOptions& options);

}  // namespace waymark::evaluate
