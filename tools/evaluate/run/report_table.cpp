// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/run/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace waymark::evaluate {
namespace {

constexpr std::array<std::string_view, 17> kColumns{
    "Case",      "Pixel Length", "Corridor Length", "Pixel Count",      "Map Length",
    "Accuracy",  "along RMSE",   "x odometry",      "across RMSE",      "ate_origin_m",
    "ate_se2_m", "heading RMSE", "marker error",    "missing/spurious", "NEES",
    "expected",  "flags"};

using Row = std::array<std::string, kColumns.size()>;

/// The value in a unit, or a dash.
std::string cell(const std::optional<double>& value, int decimals, std::string_view unit) {
  if (!value || !std::isfinite(*value)) return "-";
  return fmt::format("{:.{}f}{}", *value, decimals, unit);
}

/// Two decimals; from 1000 on, where only the size tells anything, a power of ten.
std::string nees_cell(double nees) {
  return nees < 1000.0 || !std::isfinite(nees) ? cell(nees, 2, "") : fmt::format("{:.0e}", nees);
}

/// Whole numbers bare, as the paper writes them.
std::string pixel_count(double pixels) {
  const bool whole = std::abs(pixels - std::round(pixels)) < 0.05;
  return fmt::format("{:.{}f} pixel", pixels, whole ? 0 : 1);
}

std::optional<double> along_rmse_m(const EstimatorResult& result) {
  if (!result.trajectory || !result.trajectory->along_m) return std::nullopt;
  return result.trajectory->along_m->rms;
}

std::string flags_of(const EstimatorResult& result) {
  std::vector<std::string> flags =
      result.length ? result.length->flags : std::vector<std::string>{};
  if (!result.problems.empty()) flags.emplace_back("incomplete");
  if (!result.skipped.empty()) flags.emplace_back("lines_skipped");
  return flags.empty() ? "-" : fmt::format("{}", fmt::join(flags, " "));
}

void add_length(const EstimatorResult& result, Row& row) {
  row[2] = cell(result.true_length_m, 1, " m");
  if (!result.length) return;
  const CorridorLength& length = *result.length;
  row[1] = fmt::format("{:.4g} m/pixel", length.length_m / length.length_px);
  row[3] = pixel_count(length.length_px);
  row[4] = cell(length.length_m, 2, " m");
  if (result.true_length_m)
    row[5] = cell(accuracy_percent(length.length_m, *result.true_length_m), 2, " %");
}

void add_trajectory(const TrajectoryError& error, std::optional<double> odometry_m, Row& row) {
  if (error.along_m) {
    row[6] = cell(error.along_m->rms, 3, " m");
    if (odometry_m && *odometry_m > 0.0) row[7] = cell(error.along_m->rms / *odometry_m, 2, "");
  }
  if (error.across_m) row[8] = cell(error.across_m->rms, 3, " m");
  row[9] = cell(error.ate_origin_m, 3, " m");
  row[10] = cell(error.ate_se2_m, 3, " m");
  row[11] = cell(error.heading_deg.rms, 2, " deg");
}

Row row_of(const EstimatorResult& result, std::optional<double> odometry_m) {
  Row row;
  row.fill("-");
  row[0] = result.name;
  add_length(result, row);
  if (result.trajectory) add_trajectory(*result.trajectory, odometry_m, row);
  if (result.markers) {
    row[12] = cell(result.markers->mean_position_m, 3, " m");
    row[13] = fmt::format("{}/{}", result.markers->missing, result.markers->spurious);
  }
  if (result.nees) row[14] = nees_cell(result.nees->mean);
  row[15] = text_of(result.expectations);
  row[16] = flags_of(result);
  return row;
}

/// The way as corrected until the end of the run.
Row final_row_of(const std::string& name, const TrajectoryError& error,
                 std::optional<double> odometry_m) {
  Row row;
  row.fill("-");
  row[0] = name + ", final";
  add_trajectory(error, odometry_m, row);
  return row;
}

std::string line_of(const Row& row, const std::array<std::size_t, kColumns.size()>& widths) {
  std::string line = "|";
  for (std::size_t i = 0; i < row.size(); ++i)
    line += fmt::format(" {:<{}} |", row[i], widths[i]);
  return line + "\n";
}

}  // namespace

std::string results_table(const std::vector<EstimatorResult>& results) {
  std::optional<double> odometry_m;
  for (const EstimatorResult& result : results) {
    if (result.name == "odometry") odometry_m = along_rmse_m(result);
  }
  Row names;
  std::copy(kColumns.begin(), kColumns.end(), names.begin());
  std::vector<Row> rows{names};
  for (const EstimatorResult& result : results) {
    rows.push_back(row_of(result, odometry_m));
    if (result.final_trajectory)
      rows.push_back(final_row_of(result.name, *result.final_trajectory, odometry_m));
  }

  std::array<std::size_t, kColumns.size()> widths{};
  for (const Row& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i)
      widths[i] = std::max(widths[i], row[i].size());
  }
  Row rule;
  for (std::size_t i = 0; i < rule.size(); ++i)
    rule[i] = std::string(widths[i], '-');
  rows.insert(rows.begin() + 1, rule);
  std::string table;
  for (const Row& row : rows)
    table += line_of(row, widths);
  return table;
}

std::string results_markdown(const RunTruth& truth, const std::vector<EstimatorResult>& results) {
  std::string text = "# Results\n\n" + results_table(results) + "\n";
  text +=
      "Length: measured on the map image from end wall to end wall. RMSE: position of the base "
      "against the truth";
  if (!results.empty() && results.front().trajectory)
    text += fmt::format(", aligned by `{}`", name_of(results.front().trajectory->alignment));
  text +=
      "; `x odometry`: along RMSE over that of the row `odometry`. Marker error: mean distance "
      "over "
      "all true markers that were mapped. NEES: 3 is right, far more is a "
      "covariance that is far too small. Expected: by the scenario, its limit "
      "in parentheses. "
      "Trajectories are the poses given during the run; `final`: corrected until its end.\n";
  if (truth.faults_toml)
    text += "\nFaults were put into the messages of this run: variant_applied.toml says which.\n";
  if (!truth.is_one_corridor)
    text += "\nNot one straight corridor: no length.\n";
  else if (!truth.length_m)
    text += "\nNo scenario.toml: the true length is not known, so no accuracy.\n";
  if (!truth.trajectory) text += "\nNo truth.tum: lengths only, no trajectory error.\n";
  if (!truth.markers) text += "\nNo truth_markers.csv: no marker error.\n";
  for (const EstimatorResult& result : results) {
    for (const std::string& problem : result.problems)
      text += fmt::format("\n* {}: {}", result.name, problem);
    if (!result.skipped.empty())
      text += fmt::format("\n* {}: {} lines skipped, first: {}", result.name, result.skipped.size(),
                          result.skipped.front());
  }
  return text.ends_with('\n') ? text : text + "\n";
}

}  // namespace waymark::evaluate
