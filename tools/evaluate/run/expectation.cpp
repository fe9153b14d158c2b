// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/run/expectation.hpp"

#include "evaluate/run/run_evaluation.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::evaluate {
namespace {

using Figure = std::optional<double>;

Figure length_error_percent(const EstimatorResult& result) {
  if (!result.length || !result.true_length_m) return std::nullopt;
  return std::abs(100.0 -
                  corridor::accuracy_percent(result.length->length_m, *result.true_length_m));
}

Figure ate_origin_m(const EstimatorResult& result) {
  return result.trajectory ? Figure{result.trajectory->ate_origin_m} : std::nullopt;
}

Figure along_rmse_m(const EstimatorResult& result) {
  return result.trajectory ? rms_of(result.trajectory->along_m) : std::nullopt;
}

Figure across_rmse_m(const EstimatorResult& result) {
  return result.trajectory ? rms_of(result.trajectory->across_m) : std::nullopt;
}

Figure heading_rmse_deg(const EstimatorResult& result) {
  return result.trajectory ? Figure{result.trajectory->heading_deg.rms} : std::nullopt;
}

Figure marker_error_mean_m(const EstimatorResult& result) {
  return result.markers ? result.markers->mean_position_m : std::nullopt;
}

Figure moved_named_share(const EstimatorResult& result) {
  return result.markers ? result.markers->moved_named_share : std::nullopt;
}

Figure marker_map_share(const EstimatorResult& result) {
  return result.markers ? Figure{result.markers->right_share} : std::nullopt;
}

Figure found_again_s(const EstimatorResult& result) {
  return result.health_summary && result.health_summary->kidnap
             ? result.health_summary->kidnap->found_again_s
             : std::nullopt;
}

/// The earlier of says_lost_s and found_again_s: an estimator that has found the pose again need
/// not report `lost`.
Figure says_lost_s(const EstimatorResult& result) {
  if (!result.health_summary || !result.health_summary->kidnap) return std::nullopt;
  const Kidnap& kidnap = *result.health_summary->kidnap;
  if (!kidnap.says_lost_s || !kidnap.found_again_s)
    return kidnap.says_lost_s ? kidnap.says_lost_s : kidnap.found_again_s;
  return std::min(*kidnap.says_lost_s, *kidnap.found_again_s);
}

Figure confident_wrong_s(const EstimatorResult& result) {
  return result.health_summary && result.health_summary->kidnap
             ? Figure{result.health_summary->kidnap->confident_wrong_s}
             : std::nullopt;
}

Figure max_jump_m(const EstimatorResult& result) {
  return result.health_summary ? Figure{result.health_summary->max_jump_m} : std::nullopt;
}

Figure max_wall_cells(const EstimatorResult& result) {
  return result.wall_cells ? Figure{*result.wall_cells} : std::nullopt;
}

Figure memory_mb_per_m(const EstimatorResult& result) {
  return result.memory_mb_per_m;
}

/// nullopt if the mean leaves out too many poses: the worst ones may be among them.
Figure nees_mean(const EstimatorResult& result) {
  if (!result.nees || leaves_out_too_many(*result.nees, result.nees->left_out()))
    return std::nullopt;
  return result.nees->mean;
}

Figure growth(const EstimatorResult& result) {
  return result.sigma_growth;
}

/// Tolerance for binary fractions, e.g. of 0.2 % for 998 pixels instead of 1000.
constexpr double kRounding = 1e-9;

struct Rule {
  const char* key;
  double ExpectConfig::*limit;
  Limit kind;
  Figure (*figure)(const EstimatorResult&);
};

constexpr Rule kRules[]{
    {"length_error_percent", &ExpectConfig::length_error_percent, Limit::kAtMost,
     length_error_percent},
    {"ate_origin_m", &ExpectConfig::ate_origin_m, Limit::kAtMost, ate_origin_m},
    {"along_rmse_m", &ExpectConfig::along_rmse_m, Limit::kAtMost, along_rmse_m},
    {"across_rmse_m", &ExpectConfig::across_rmse_m, Limit::kAtMost, across_rmse_m},
    {"heading_rmse_deg", &ExpectConfig::heading_rmse_deg, Limit::kAtMost, heading_rmse_deg},
    {"marker_error_mean_m", &ExpectConfig::marker_error_mean_m, Limit::kAtMost,
     marker_error_mean_m},
    {"marker_map_share", &ExpectConfig::marker_map_share, Limit::kAtLeast, marker_map_share},
    {"moved_named_share", &ExpectConfig::moved_named_share, Limit::kAtLeast, moved_named_share},
    {"found_again_s", &ExpectConfig::found_again_s, Limit::kAtMost, found_again_s},
    {"says_lost_s", &ExpectConfig::says_lost_s, Limit::kAtMost, says_lost_s},
    {"confident_wrong_s", &ExpectConfig::confident_wrong_s, Limit::kAtMost, confident_wrong_s},
    {"max_jump_m", &ExpectConfig::max_jump_m, Limit::kAtMost, max_jump_m},
    {"max_wall_cells", &ExpectConfig::max_wall_cells, Limit::kAtMost, max_wall_cells},
    {"memory_mb_per_m", &ExpectConfig::memory_mb_per_m, Limit::kAtMost, memory_mb_per_m},
    {"nees_mean", &ExpectConfig::nees_mean, Limit::kAtMost, nees_mean},
    {"sigma_growth", &ExpectConfig::sigma_growth, Limit::kAtLeast, growth}};

}  // namespace

bool is_expected_of(const ExpectConfig& expect, const std::string& row) {
  return (expect.estimator.empty() || expect.estimator == row) &&
         (expect.nees_in_band_share > 0.0 ||
          std::any_of(std::begin(kRules), std::end(kRules),
                      [&](const Rule& rule) { return expect.*rule.limit > 0.0; }));
}

bool misses_a_figure(const std::vector<ExpectedFigure>& figures) {
  return std::any_of(figures.begin(), figures.end(),
                     [](const ExpectedFigure& figure) { return !figure.got; });
}

std::vector<ExpectedFigure> check_expectations(const ExpectConfig& expect,
                                               const EstimatorResult& result) {
  std::vector<ExpectedFigure> figures;
  if (!is_expected_of(expect, result.name)) return figures;
  for (const Rule& rule : kRules) {
    const double limit = expect.*rule.limit;
    if (limit <= 0.0) continue;
    const Figure got = rule.figure(result);
    const bool is_hit = got && (rule.kind == Limit::kAtMost ? *got <= limit + kRounding
                                                            : *got >= limit - kRounding);
    figures.push_back({rule.key, limit, rule.kind, got, is_hit});
  }
  return figures;
}

}  // namespace waymark::evaluate
