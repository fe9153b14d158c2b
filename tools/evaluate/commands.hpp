// SPDX-License-Identifier: BSD-3-Clause
// The sub-commands: read, compute, print. Each returns the program's exit code, and throws
// SetupError for unusable input.
#pragma once

#include "common/errors/exit_codes.hpp"
#include "evaluate/run/run_evaluation.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace waymark::evaluate {

struct Output {
  bool json{};      ///< print JSON instead of text
  bool tolerant{};  ///< neither skipped lines nor a partly covered reference fail the program
};

/// Prints the first skipped lines on standard error. @return the exit code.
int report_skipped(const SkippedLines& skipped, const Output& output);

int run_length(const std::filesystem::path& map_yaml, std::optional<double> true_length_m,
               const Output& output);

/// @return kExitFailed also if problems_of() finds a problem with the overlap: see overlap.hpp.
int run_trajectory(const std::filesystem::path& estimate, const std::filesystem::path& reference,
                   Alignment alignment, const Output& output);

int run_relations(const std::filesystem::path& trajectory, const std::filesystem::path& relations,
                  const Output& output);

/// Writes metrics.json into each estimator's folder, results.json and results.md into the run's.
/// @param estimators  names of sub-folders; empty = all that have a trajectory.tum.
/// @return kExitFailed if a row has problems, an expected figure is missing or lines were skipped.
int run_run(const std::filesystem::path& run_dir, const std::vector<std::string>& estimators,
            const EvaluationOptions& options, const Output& output);

/// Writes results.md, results.csv, runs.csv, index.html and plots/ into a sweep's folder.
/// @return kExitOk also when runs failed or missed their expectations; the table shows them.
///         kExitFailed if lines were skipped.
int run_sweep(const std::filesystem::path& sweep_dir, const Output& output);

/// Mean NEES per station over estimator folders with a stations.csv.
/// @return kExitFailed if a station has no usable covariance, there is none, or lines were skipped.
int run_consistency(const std::vector<std::filesystem::path>& row_dirs, const Output& output);

}  // namespace waymark::evaluate
