// SPDX-License-Identifier: BSD-3-Clause
// A sweep's folder: planned runs, their results, and statistics per scenario and estimator.
#pragma once

#include "evaluate/files/text_file.hpp"
#include "evaluate/trajectory/consistency.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace waymark::evaluate {

/// One line of plan/runs.tsv, which deploy/sweep.sh writes: an estimator on a recorded log.
struct PlannedRun {
  std::string scenario{};  ///< with "+VARIANT" for a log with faults
  std::string seed{};
  std::string folder{};          ///< folder of the run, relative to the sweep's
  std::string estimator{};       ///< folder of the estimator, relative to `folder`
  std::string repeat_command{};  ///< command that repeats this run alone
};

/// @throws SetupError if the plan cannot be read or a line is not five fields separated by tabs.
std::vector<PlannedRun> read_plan(const std::filesystem::path& sweep_dir);

struct SweptRun {
  PlannedRun plan{};
  nlohmann::ordered_json metrics{};  ///< content of metrics.json; null if the run failed
  std::string failure{};             ///< why there are no metrics; empty = success
  std::vector<Station> stations{};
  SkippedLines skipped{};  ///< lines of stations.csv that were left out

  bool has_failed() const { return !failure.empty(); }

  /// True if an expectation of the scenario was not met.
  bool misses() const;

  /// Why figures are missing or not those of the whole run; empty if nothing is wrong.
  std::vector<std::string> problems() const;

  /// A limit in [expect] on all seeds together (seeds_share or nees_in_band_share); 0 = none.
  double sweep_limit(const std::string& key) const;

  /// A number in metrics.json; nullopt if there is none.
  std::optional<double> figure(const std::string& key) const;
};

/// A run has failed if its folder or its row has a file `failed`, which says why, or if
/// metrics.json is missing, is not as `run` writes it, or has no ATE.
std::vector<SweptRun> read_runs(const std::filesystem::path& sweep_dir);

/// One figure over the seeds that did not fail; worst = largest, or smallest if higher is better.
struct Figures {
  std::optional<double> median{};  ///< over the seeds that have the figure
  std::optional<double> worst{};   ///< nullopt if a seed (perhaps the worst) does not have it
  std::size_t count{};             ///< number of seeds that have the figure
  std::size_t seeds{};

  bool is_partial() const { return count > 0 && count < seeds; }
};

/// All seeds of one scenario and estimator.
struct SweepRow {
  std::string scenario{};
  std::string estimator{};
  std::vector<SweptRun> runs{};
  std::vector<StationConsistency> stations{};
  std::size_t stations_left_out{};  ///< stations without a usable covariance, over all runs

  std::size_t failures() const;
  std::size_t misses() const;
  std::size_t with_problems() const;
  Figures figures(const std::string& key) const;

  bool expects_anything() const;

  /// True if enough seeds are good (not failed, no missed expectation, no problem), and enough
  /// stations have their mean NEES in its band. [expect] says what is enough; default: all seeds
  /// must be good, and any share of the stations.
  bool meets_expectations() const;

  /// The seed with the largest ATE, among those that missed expectations if there are any; null if
  /// every seed failed.
  const SweptRun* worst_run() const;

  /// The largest sweep_limit() of the runs; 0 = none.
  double limit(const std::string& key) const;
};

/// Rows in the order of the plan, with `length_error_percent` and `ate_over_odometry` added to the
/// metrics.
std::vector<SweepRow> sweep_rows(std::vector<SweptRun> runs);

}  // namespace waymark::evaluate
