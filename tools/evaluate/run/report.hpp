// SPDX-License-Identifier: BSD-3-Clause
// Results as JSON and as tables.
#pragma once

#include "evaluate/run/run_evaluation.hpp"
#include "evaluate/trajectory/relations.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace waymark::evaluate {

/// Keys keep the order in which they are written. Unknown values are null.
using Json = nlohmann::ordered_json;

Json json_of(const corridor::CorridorLength& length, std::optional<double> true_length_m);
Json json_of(const TrajectoryError& error);
Json json_of(const RelationsError& error);

/// Content of metrics.json: one object, always with all keys.
Json metrics_json(const EstimatorResult& result);

/// Content of results.json: the truth, and each estimator's metrics with its configuration.
Json results_json(const RunTruth& truth, const std::vector<EstimatorResult>& results);

/// Corridor lengths like Table I of the marker-matching paper, as Markdown.
std::string length_table(const std::vector<EstimatorResult>& results);

/// Errors of trajectory and markers, NEES, and warnings such as lost messages. The trajectory as
/// corrected by the end of the run has a row of its own.
std::string error_table(const std::vector<EstimatorResult>& results);

/// One row per figure that the scenario expects; empty if it expects none.
std::string expectation_table(const std::vector<EstimatorResult>& results);

/// Content of results.md: the three tables with explanations and problems.
std::string results_markdown(const RunTruth& truth, const std::vector<EstimatorResult>& results);

}  // namespace waymark::evaluate
