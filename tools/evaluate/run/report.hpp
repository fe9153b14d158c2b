// SPDX-License-Identifier: BSD-3-Clause
// Results as JSON for scripts and as a table for people.
#pragma once

#include "evaluate/run/run_evaluation.hpp"
#include "evaluate/trajectory/relations.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace waymark::evaluate {

/// Keys stay in the order in which they are written. What is unknown is null.
using Json = nlohmann::ordered_json;

Json json_of(const CorridorLength& length, std::optional<double> true_length_m);
Json json_of(const TrajectoryError& error);
Json json_of(const RelationsError& error);

/// Content of metrics.json: one flat object, every key always there.
Json metrics_json(const EstimatorResult& result);

/// Content of results.json: the truth, and each estimator's metrics with its configuration.
Json results_json(const RunTruth& truth, const std::vector<EstimatorResult>& results);

/// Table I of the paper with our columns beside it, as Markdown.
std::string results_table(const std::vector<EstimatorResult>& results);

/// Content of results.md: the table and what is to be said about it.
std::string results_markdown(const RunTruth& truth, const std::vector<EstimatorResult>& results);

}  // namespace waymark::evaluate
