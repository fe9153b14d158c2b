// SPDX-License-Identifier: BSD-3-Clause
// One run folder: what is known of the truth, and every estimator's files against it.
#pragma once

#include "common/corridor/corridor_length.hpp"
#include "evaluate/map/marker_error.hpp"
#include "evaluate/run/expectation.hpp"
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
  std::optional<Se2> world_from_map{};    ///< of that map
  std::optional<double> true_length_m{};  ///< wins over the scenario's
  double marker_gate_m{5.0};              ///< an estimate further from its marker is another one
};

/// What the simulator knows; each part only if the run folder has it.
struct RunTruth {
  std::optional<std::string> scenario_toml{};
  std::optional<std::string> faults_toml{};  ///< that waymark-faults put into its messages
  std::optional<double> length_m{};
  bool is_one_corridor{true};  ///< an L or a ring has no length from end wall to end wall
  ExpectConfig expect{};
  std::optional<Trajectory> trajectory{};
  std::optional<std::vector<Marker>> markers{};
  std::optional<double> lifted_t_s{};  ///< when the robot was lifted and put down elsewhere
  std::vector<double> sightings_s{};   ///< times of frames with a marker; only if it was lifted
  Skipped skipped{};
};

/// Everything about one estimator; absent = could not be had, and `problems` or the run's missing
/// truth says why.
struct EstimatorResult {
  std::string name{};
  std::optional<corridor::CorridorLength> length{};
  std::optional<double> true_length_m{};
  std::optional<int> wall_cells{};                    ///< thickness
  std::optional<TrajectoryError> trajectory{};        ///< poses as given during the run
  std::optional<TrajectoryError> final_trajectory{};  ///< as corrected until its end, if it was
  std::size_t poses_outside_truth{};
  std::optional<MarkerError> markers{};
  std::optional<Nees> nees{};
  std::vector<Station> stations{};
  std::optional<Timeline> timeline{};
  std::optional<double> driven_m{};         ///< by the true robot
  std::optional<double> sigma_growth{};     ///< between the stations that the scenario names
  std::optional<double> memory_mb_per_m{};  ///< peak of the process over `driven_m`
  std::vector<ExpectedFigure> expectations{};
  ExpectConfig expect{};  ///< of this row; all zero if nothing is expected of it
  std::optional<std::string> config_toml{};
  std::optional<std::string> timings_json{};
  std::vector<std::string> changes{};  ///< lines of changes.csv behind its header
  std::optional<std::string> findings_json{};
  std::vector<std::string> problems{};  ///< figures that should be there and are not
  Skipped skipped{};                    ///< lines that were left out
};

/// Reads scenario.toml (world.layout, length_m, 50 if it does not say, and [expect], which an
/// expect.toml beside it replaces), truth.tum and truth_markers.csv; with --mapped-in, the truth of
/// that run, too; and run.lcm for the times at which a robot was lifted.
/// @throws InputError for files that are there and cannot be understood.
RunTruth read_truth(const std::filesystem::path& run_dir, const EvaluationOptions& options);

/// Names of the sub-folders with a trajectory.tum, in the table's order: odometry, gmapping,
/// gmapping_turtlebot3, marker_matching, its variants, waymark, others.
std::vector<std::string> estimators_in(const std::filesystem::path& run_dir);

/// Never throws for what is wrong inside the folder: that is a problem of this estimator.
EstimatorResult evaluate_estimator(const std::filesystem::path& estimator_dir,
                                   const RunTruth& truth, const EvaluationOptions& options);

}  // namespace waymark::evaluate
