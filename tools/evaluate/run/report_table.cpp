// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/run/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark::evaluate {
namespace {

using Row = std::vector<std::string>;

/// A Markdown table with aligned columns; empty without rows.
/// @param names  one per column.
std::string table_of(const Row& names, const std::vector<Row>& rows) {
  if (rows.empty()) return "";
  std::vector<std::size_t> widths;
  for (std::size_t i = 0; i < names.size(); ++i) {
    widths.push_back(names[i].size());
    for (const Row& row : rows)
      widths[i] = std::max(widths[i], row[i].size());
  }
  const auto line = [&widths](const Row& row) {
    std::string text = "|";
    for (std::size_t i = 0; i < row.size(); ++i)
      text += fmt::format(" {:<{}} |", row[i], widths[i]);
    return text + "\n";
  };
  std::string text = line(names) + "|";
  for (const std::size_t width : widths)
    text += std::string(width + 2, '-') + "|";
  text += "\n";
  for (const Row& row : rows)
    text += line(row);
  return text;
}

/// The value with its unit, or a dash.
std::string cell(const std::optional<double>& value, int decimals, std::string_view unit = "") {
  if (!value || !std::isfinite(*value)) return "-";
  return fmt::format("{:.{}f}{}", *value, decimals, unit);
}

/// Mean NEES with two decimals; from 1000 on with one significant digit ("3e+03"); "-" if not
/// finite.
std::string nees_cell(double nees) {
  return nees < 1000.0 || !std::isfinite(nees) ? cell(nees, 2) : fmt::format("{:.0e}", nees);
}

/// Whole numbers without decimals, as in the paper.
std::string pixel_count(double pixels) {
  const bool whole = std::abs(pixels - std::round(pixels)) < 0.05;
  return fmt::format("{:.{}f} pixel", pixels, whole ? 0 : 1);
}

/// True if slam's counters in timings.json have one of a kind ("loss", "rejection").
bool has_counted(const EstimatorResult& result, std::string_view kind) {
  if (!result.timings_json) return false;
  const Json timings = Json::parse(*result.timings_json);
  const auto counters = Json::json_pointer{"/slam/counters"};
  if (!timings.contains(counters)) return false;
  const Json& list = timings.at(counters);
  return std::any_of(list.begin(), list.end(),
                     [kind](const Json& counter) { return counter.value("kind", "") == kind; });
}

constexpr const char* kPartOfRun = "part_of_run";

/// True if the errors of a trajectory are not those of the whole run.
bool is_partial(const std::optional<Overlap>& overlap) {
  return overlap && !problems_of(*overlap, "truth").empty();
}

std::string flags_of(const EstimatorResult& result) {
  std::vector<std::string> flags =
      result.length ? result.length->flags : std::vector<std::string>{};
  if (!result.problems.empty()) flags.emplace_back("incomplete");
  if (is_partial(result.overlap)) flags.emplace_back(kPartOfRun);
  if (!result.skipped.empty()) flags.emplace_back("lines_skipped");
  if (has_counted(result, "loss")) flags.emplace_back("messages_lost");
  if (has_counted(result, "rejection")) flags.emplace_back("messages_rejected");
  return flags.empty() ? "-" : fmt::format("{}", fmt::join(flags, " "));
}

/// A row of the table of corridor lengths, like Table I of the marker-matching paper (README.md).
Row length_row(const EstimatorResult& result) {
  Row row{result.name, "-", cell(result.true_length_m, 1, " m"), "-", "-", "-"};
  if (!result.length) return row;
  const corridor::CorridorLength& length = *result.length;
  row[1] = fmt::format("{:.4g} m/pixel", length.length_m / length.length_px);
  row[3] = pixel_count(length.length_px);
  row[4] = cell(length.length_m, 2, " m");
  if (result.true_length_m)
    row[5] = cell(corridor::accuracy_percent(length.length_m, *result.true_length_m), 2, " %");
  return row;
}

const Row kErrorColumns{"Row",         "along [m]",     "x odometry",
                        "across [m]",  "heading [deg]", "ate_origin [m]",
                        "ate_se2 [m]", "markers [m]",   "missing/spurious",
                        "NEES",        "flags"};

/// A row with the errors of a trajectory, and dashes in the other columns.
Row error_row(const std::string& name, const TrajectoryError& error,
              std::optional<double> odometry_along_m) {
  const std::optional<double> along_m = rms_of(error.along_m);
  std::optional<double> ratio;
  if (along_m && odometry_along_m.value_or(0.0) > 0.0) ratio = *along_m / *odometry_along_m;
  return {name,
          cell(along_m, 3),
          cell(ratio, 2),
          cell(rms_of(error.across_m), 3),
          cell(error.heading_deg.rms, 2),
          cell(error.ate_origin_m, 3),
          cell(error.ate_se2_m, 3),
          "-",
          "-",
          "-",
          "-"};
}

Row error_row(const EstimatorResult& result, std::optional<double> odometry_along_m) {
  Row row(kErrorColumns.size(), "-");
  if (result.trajectory) row = error_row(result.name, *result.trajectory, odometry_along_m);
  row[0] = result.name;
  if (result.markers) {
    row[7] = cell(result.markers->mean_position_m, 3);
    row[8] = fmt::format("{}/{}", result.markers->missing, result.markers->spurious);
  }
  if (result.nees) row[9] = nees_cell(result.nees->mean);
  row[10] = flags_of(result);
  return row;
}

/// The alignment of the first row, and the rows with another one.
std::string alignments(const std::vector<EstimatorResult>& results) {
  if (results.empty() || !results.front().trajectory) return "";
  const Alignment first = results.front().trajectory->alignment;
  std::string text = fmt::format(", aligned by `{}`", name_of(first));
  for (const EstimatorResult& result : results) {
    if (result.trajectory && result.trajectory->alignment != first)
      text += fmt::format(", of {} by `{}`", result.name, name_of(result.trajectory->alignment));
  }
  return text;
}

std::string explanation(const std::vector<EstimatorResult>& results) {
  std::string text =
      "Length: measured on the map image from end wall to end wall. Errors: RMSE of the base's "
      "position and heading against the truth";
  return text + alignments(results) +
         "; `x odometry`: along RMSE over that of the row `odometry`. Markers: mean distance "
         "over all true markers that were mapped. NEES: 3 is right, far more is a covariance that "
         "is far too small. Trajectories are the poses given during the run; `final`: corrected "
         "until its end.\n";
}

}  // namespace

std::string length_table(const std::vector<EstimatorResult>& results) {
  std::vector<Row> rows;
  for (const EstimatorResult& result : results)
    rows.push_back(length_row(result));
  return table_of(
      {"Case", "Pixel Length", "Corridor Length", "Pixel Count", "Map Length", "Accuracy"}, rows);
}

std::string error_table(const std::vector<EstimatorResult>& results) {
  std::optional<double> odometry_along_m;
  for (const EstimatorResult& result : results) {
    if (result.name == "odometry" && result.trajectory)
      odometry_along_m = rms_of(result.trajectory->along_m);
  }
  std::vector<Row> rows;
  for (const EstimatorResult& result : results) {
    rows.push_back(error_row(result, odometry_along_m));
    if (!result.final_trajectory) continue;
    rows.push_back(error_row(result.name + ", final", *result.final_trajectory, odometry_along_m));
    if (is_partial(result.final_overlap)) rows.back().back() = kPartOfRun;
  }
  return table_of(kErrorColumns, rows);
}

std::string expectation_table(const std::vector<EstimatorResult>& results) {
  std::vector<Row> rows;
  for (const EstimatorResult& result : results) {
    for (const ExpectedFigure& figure : result.expectations)
      rows.push_back(
          {result.name, figure.key,
           fmt::format("{} {}", figure.kind == Limit::kAtMost ? "<=" : ">=", figure.limit),
           figure.got ? fmt::format("{:.3g}", *figure.got) : "none",
           figure.is_hit ? "hit" : "MISS"});
  }
  return table_of({"Row", "figure", "expected", "got", ""}, rows);
}

std::string results_markdown(const RunTruth& truth, const std::vector<EstimatorResult>& results) {
  std::string text = "# Results\n\n" + length_table(results) + "\n" + error_table(results) + "\n";
  if (const std::string expected = expectation_table(results); !expected.empty())
    text += expected + "\n";
  text += explanation(results);
  if (truth.faults_toml)
    text += "\nFaults were put into the messages of this run: variant_applied.toml says which.\n";
  if (!truth.is_one_corridor)
    text += "\nNot one straight corridor: no length.\n";
  else if (!truth.length_m)
    text += "\nNo scenario.toml: the true length is not known, so no accuracy.\n";
  if (!truth.trajectory) text += "\nNo truth.tum: lengths only, no trajectory error.\n";
  if (!truth.markers) text += "\nNo truth_markers.csv: no marker error.\n";
  for (const EstimatorResult& result : results) {
    if (!result.changes.empty())
      text +=
          fmt::format("\n* {}: {} things are not as the map or the survey has them (changes.csv)",
                      result.name, result.changes.size());
    for (const auto* lines : {&result.problems, &result.notes}) {
      for (const std::string& line : *lines)
        text += fmt::format("\n* {}: {}", result.name, line);
    }
    if (!result.skipped.empty())
      text += fmt::format("\n* {}: {} lines skipped, first: {}", result.name, result.skipped.size(),
                          result.skipped.front());
  }
  return text.ends_with('\n') ? text : text + "\n";
}

}  // namespace waymark::evaluate
