// SPDX-License-Identifier: BSD-3-Clause
// A scenario's expectations, compared with the results.
#pragma once

#include "common/expect/expect_config.hpp"

#include <optional>
#include <string>
#include <vector>

namespace waymark::evaluate {

struct EstimatorResult;

enum class Limit { kAtMost, kAtLeast };

/// One figure of a scenario's section [expect].
struct ExpectedFigure {
  std::string key{};  ///< as in the scenario
  double limit{};
  Limit kind{};
  std::optional<double> got{};  ///< nullopt = not available, or never happened
  bool is_hit{};
};

/// True if there are expectations of this row.
bool is_expected_of(const ExpectConfig& expect, const std::string& row);

/// True if an expected figure is not available, or what it measures never happened.
bool misses_a_figure(const std::vector<ExpectedFigure>& figures);

/// One entry for each expected figure, in the order of the section; empty for other rows.
std::vector<ExpectedFigure> check_expectations(const ExpectConfig& expect,
                                               const EstimatorResult& result);

}  // namespace waymark::evaluate
