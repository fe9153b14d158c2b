// SPDX-License-Identifier: BSD-3-Clause
// The sub-commands: read, compute, print. Each returns the program's exit code and throws
// InputError for what makes it impossible.
#pragma once

#include "evaluate/run/run_evaluation.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark::evaluate {

inline constexpr int kFine = 0;
inline constexpr int kFailed = 1;
inline constexpr int kUsage = 2;

struct Output {
  bool json{};      ///< print JSON instead of text
  bool tolerant{};  ///< skipped lines do not fail the program
};

/// What the program returns of a sub-command; where input is unusable kUsage, and one sentence on
/// standard error.
int run_command(std::string_view program, const std::function<int()>& command);

int run_length(const std::filesystem::path& map_yaml, std::optional<double> true_length_m,
               const Output& output);

int run_trajectory(const std::filesystem::path& estimate, const std::filesystem::path& reference,
                   Alignment alignment, const Output& output);

int run_relations(const std::filesystem::path& trajectory, const std::filesystem::path& relations,
                  const Output& output);

/// Writes metrics.json into each estimator's folder, results.json and results.md into the run's.
/// @param estimators  names of sub-folders; empty = all that have a trajectory.tum.
int run_run(const std::filesystem::path& run_dir, const std::vector<std::string>& estimators,
            const EvaluationOptions& options, const Output& output);

/// Writes results.md, results.csv, runs.csv, index.html and plots/ into a sweep's folder.
/// @return kFine also where runs failed or missed: the table says so.
int run_sweep(const std::filesystem::path& sweep_dir, const Output& output);

/// Mean NEES per station over estimator folders with a stations.csv.
int run_consistency(const std::vector<std::filesystem::path>& row_dirs, const Output& output);

}  // namespace waymark::evaluate
