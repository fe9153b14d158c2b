// SPDX-License-Identifier: BSD-3-Clause
// A sweep's folder: which runs were planned, what became of each, and what that says of each
// scenario and estimator.
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
  std::string scenario{};  ///< with "+VARIANT" where faults were put into the log
  std::string seed{};
  std::string folder{};  ///< of the run, within the sweep's
  std::string row{};     ///< folder of the estimator within that
  std::string again{};   ///< command that does it again alone
};

/// @throws InputError if the plan cannot be read or a line is not five words between tabs.
std::vector<PlannedRun> read_plan(const std::filesystem::path& sweep_dir);

struct SweptRun {
  PlannedRun plan{};
  nlohmann::ordered_json metrics{};  ///< of metrics.json; null if the run failed
  std::string failure{};             ///< why there are none, with the log's name; empty = fine
  std::vector<Station> stations{};

  bool has_failed() const { return !failure.empty(); }

  /// True if a figure that the scenario expects was not reached.
  bool misses() const;

  /// A limit that the scenario sets for all seeds together; 0 = none.
  double limit_of_seeds(const std::string& key) const;

  /// A number of metrics.json; absent if it has none.
  std::optional<double> figure(const std::string& key) const;
};

/// A run without metrics.json has failed; the file `failed` in its row or its folder says how.
std::vector<SweptRun> read_runs(const std::filesystem::path& sweep_dir);

/// Over the seeds that have the figure; worst = largest, smallest where more is better.
struct Figures {
  std::optional<double> median{};
  std::optional<double> worst{};
};

/// All seeds of one scenario and estimator.
struct SweepRow {
  std::string scenario{};
  std::string row{};
  std::vector<SweptRun> runs{};
  std::vector<StationConsistency> stations{};

  std::size_t failures() const;
  std::size_t misses() const;
  Figures figures(const std::string& key) const;

  bool expects_anything() const;

  /// True if as many seeds reach their figures, and as many stations have a mean NEES in its band,
  /// as the scenario wants; failures are no hits.
  bool is_hit() const;

  /// The seed to look at: one that failed to reach its expectations before others, then the one
  /// with the largest ATE; null if every seed failed.
  const SweptRun* worst_run() const;

  /// A limit for all seeds together, of any run that has it; 0 = none.
  double limit(const std::string& key) const;
};

/// In the order of the plan. Adds `length_error_percent` and `ate_over_odometry` to the metrics.
std::vector<SweepRow> sweep_rows(std::vector<SweptRun> runs);

}  // namespace waymark::evaluate
