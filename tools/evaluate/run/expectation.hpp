// SPDX-License-Identifier: BSD-3-Clause
// What a scenario expects, against what came out.
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
  std::optional<double> got{};  ///< absent = could not be had, or never happened
  bool is_hit{};
};

/// True if the expectations are about this row and there are any.
bool is_expected_of(const ExpectConfig& expect, const std::string& row);

/// One entry for each figure that is expected, in the order of the section; empty for other rows.
std::vector<ExpectedFigure> check_expectations(const ExpectConfig& expect,
                                               const EstimatorResult& result);

}  // namespace waymark::evaluate
