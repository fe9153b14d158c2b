// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/sweep/sweep_report.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <string_view>

namespace waymark::evaluate {
namespace {

struct Column {
  std::string_view name;
  const char* key;  ///< in metrics.json
  int decimals;
};

constexpr std::array kColumns{Column{"length error [%]", "length_error_percent", 2},
                              Column{"ATE [m]", "ate_origin_m", 3},
                              Column{"along [m]", "along_rmse_m", 3},
                              Column{"heading [deg]", "heading_rmse_deg", 3},
                              Column{"markers [m]", "marker_error_mean_m", 3},
                              Column{"x odometry", "ate_over_odometry", 2},
                              Column{"mean NEES", "nees_mean", 1}};

/// Figures of metrics.json that are columns of results.csv and runs.csv, but not of results.md.
constexpr std::array kMoreKeys{
    "length_px",     "marker_map_share", "moved_named_share", "max_jump_m",       "wall_cells",
    "found_again_s", "says_lost_s",      "confident_wrong_s", "share_degenerate", "share_lost",
    "sigma_growth",  "memory_mb_per_m",  "across_rmse_m",     "distance_max_m"};

std::string shown(const std::optional<double>& value, int decimals) {
  return value && std::isfinite(*value) ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

std::string for_csv(const std::optional<double>& value) {
  return value && std::isfinite(*value) ? fmt::format("{:.6g}", *value) : "";
}

/// Median and worst value; the number of seeds with the figure if some do not have it.
std::string shown(const Figures& figures, int decimals) {
  if (figures.is_partial())
    return fmt::format("{} / none ({} of {})", shown(figures.median, decimals), figures.count,
                       figures.seeds);
  return fmt::format("{} / {}", shown(figures.median, decimals), shown(figures.worst, decimals));
}

std::string label_of(const SweepRow& row) {
  return row.scenario + ", " + row.estimator;
}

std::string with(std::string text, std::string_view key, double limit) {
  return limit <= 0.0 ? text
                      : fmt::format("{}{}{} {:g}", text, text.empty() ? "" : ", ", key, limit);
}

/// Adds the limits that hold over all seeds.
std::string expected_of_seeds(const SweepRow& row, std::string text) {
  for (const char* key : {"nees_in_band_share", "seeds_share"})
    text = with(std::move(text), key, row.limit(key));
  return text;
}

/// The expectations of the first run that has any.
std::string expected_of(const SweepRow& row) {
  if (!row.expects_anything()) return "-";
  for (const SweptRun& run : row.runs) {
    if (run.has_failed() || run.metrics.value("expectations", nlohmann::ordered_json{}).empty())
      continue;
    std::string text;
    for (const auto& figure : run.metrics["expectations"])
      text =
          with(std::move(text), figure["figure"].get<std::string>(), figure["limit"].get<double>());
    return expected_of_seeds(row, text);
  }
  return expected_of_seeds(row, "");
}

std::string verdict_of(const SweepRow& row) {
  if (row.failures() > 0) return "FAIL";
  if (expected_of(row) == "-") return "-";
  return row.meets_expectations() ? "hit" : "MISS";
}

std::string row_line(const SweepRow& row) {
  std::string line = fmt::format("| {} | {} | {} |", row.scenario, row.estimator, row.runs.size());
  for (const Column& column : kColumns) {
    line += fmt::format(" {} |", shown(row.figures(column.key), column.decimals));
  }
  return line + fmt::format(" {} | {} | {} | {} | {} | {} |\n",
                            shown(100.0 * share_in_band(row.stations), 0), row.failures(),
                            row.misses(), row.with_problems(), expected_of(row), verdict_of(row));
}

std::string missed_of(const SweptRun& run) {
  std::string text;
  for (const auto& figure : run.metrics["expectations"]) {
    if (figure.value("hit", false)) continue;
    const auto& got = figure["got"];
    text += fmt::format("{}{} {} (limit {:g})", text.empty() ? "" : ", ",
                        figure["figure"].get<std::string>(),
                        got.is_number() ? fmt::format("{:.3g}", got.get<double>()) : "none",
                        figure["limit"].get<double>());
  }
  return text;
}

/// Why a run is not as it should be; empty if nothing is wrong.
std::string faults_of(const SweptRun& run) {
  if (run.has_failed()) return fmt::format("FAILED: {}", run.failure);
  std::vector<std::string> faults = run.problems();
  if (run.misses()) faults.insert(faults.begin(), missed_of(run));
  return fmt::format("{}", fmt::join(faults, "; "));
}

/// Lines of the list of what the statistics leave out; empty if that is nothing.
std::string left_out_of(const SweepRow& row) {
  std::string text;
  for (const SweptRun& run : row.runs) {
    if (!run.skipped.empty())
      text += fmt::format("* {}, seed {}: {} lines skipped, first: {}\n", label_of(row),
                          run.plan.seed, run.skipped.size(), run.skipped.front());
  }
  if (row.stations_left_out > 0)
    text += fmt::format("* {}: {} stations of single runs have no usable covariance\n",
                        label_of(row), row.stations_left_out);
  return text;
}

std::string page_of(const SweepRow& row) {
  std::string text = fmt::format("<section><h2>{} &mdash; {}</h2>\n", row.scenario, row.estimator);
  for (const SweptRun& run : row.runs) {
    if (run.has_failed())
      text += fmt::format("<p class=fail>seed {}: {}</p>\n", run.plan.seed, run.failure);
  }
  const SweptRun* const worst = row.worst_run();
  if (worst == nullptr) return text + "</section>\n";
  const std::string folder = worst->plan.folder + "/" + worst->plan.estimator;
  return text + fmt::format(
                    "<p>worst: seed {}, ATE {} m, length error {} %{}</p>\n"
                    "<a href=\"{}/map.png\"><img loading=lazy src=\"{}/map.png\"></a>\n"
                    "</section>\n",
                    worst->plan.seed, shown(worst->figure("ate_origin_m"), 3),
                    shown(worst->figure("length_error_percent"), 2),
                    worst->misses() ? fmt::format("; missed: {}", missed_of(*worst)) : "", folder,
                    folder);
}

}  // namespace

std::string sweep_markdown(const std::vector<SweepRow>& rows) {
  std::string text = "# Sweep\n\n| scenario | estimator | runs |";
  for (const Column& column : kColumns)
    text += fmt::format(" {} |", column.name);
  text += " NEES in band [%] | failures | misses | problems | expected | verdict |\n|---|---|---|";
  for (std::size_t i = 0; i < kColumns.size() + 6; ++i)
    text += "---|";
  text += "\n";
  for (const SweepRow& row : rows)
    text += row_line(row);
  text +=
      "\nTwo numbers: median / worst over the seeds; `none (2 of 3)`: the third seed does not have "
      "the figure, and may be the worst. Mean NEES: over the poses of a run; 3 is right, more a "
      "covariance that is too small. NEES in band: stations, one every metre, where the mean "
      "over the seeds lies in its 95 % band. Misses: seeds that do not reach what the scenario "
      "expects. Failures: runs without a result. Problems: runs with figures that are missing or "
      "of a part of the run; none of them is a hit.\n";
  std::string left_out;
  for (const SweepRow& row : rows)
    left_out += left_out_of(row);
  if (!left_out.empty()) text += "\nLeft out of the statistics:\n\n" + left_out;
  std::string commands;
  for (const SweepRow& row : rows) {
    for (const SweptRun& run : row.runs) {
      const std::string faults = faults_of(run);
      if (faults.empty()) continue;
      commands += fmt::format("\n# {}, seed {}: {}\n{}\n", label_of(row), run.plan.seed, faults,
                              run.plan.repeat_command);
    }
  }
  if (commands.empty()) return text;
  return text + "\nAgain, alone:\n\n```" + commands + "```\n";
}

std::string sweep_csv(const std::vector<SweepRow>& rows) {
  std::string text = "scenario,estimator,runs,failures,misses,problems,nees_in_band_share";
  for (const Column& column : kColumns)
    text += fmt::format(",{0}_median,{0}_worst", column.key);
  for (const char* key : kMoreKeys)
    text += fmt::format(",{0}_median,{0}_worst", key);
  text += "\n";
  for (const SweepRow& row : rows) {
    text += fmt::format("{},{},{},{},{},{},{}", row.scenario, row.estimator, row.runs.size(),
                        row.failures(), row.misses(), row.with_problems(),
                        for_csv(share_in_band(row.stations)));
    const auto add = [&](const char* key) {
      const Figures figures = row.figures(key);
      text += fmt::format(",{},{}", for_csv(figures.median),
                          figures.is_partial() ? "none" : for_csv(figures.worst));
    };
    for (const Column& column : kColumns)
      add(column.key);
    for (const char* key : kMoreKeys)
      add(key);
    text += "\n";
  }
  return text;
}

std::string sweep_runs_csv(const std::vector<SweepRow>& rows) {
  std::string text = "scenario,estimator,seed,folder,failed,missed";
  for (const Column& column : kColumns)
    text += fmt::format(",{}", column.key);
  for (const char* key : kMoreKeys)
    text += fmt::format(",{}", key);
  text += ",problems\n";
  for (const SweepRow& row : rows) {
    for (const SweptRun& run : row.runs) {
      text += fmt::format("{},{},{},{}/{},{},{}", row.scenario, row.estimator, run.plan.seed,
                          run.plan.folder, row.estimator, run.has_failed() ? 1 : 0,
                          run.misses() ? 1 : 0);
      for (const Column& column : kColumns)
        text += fmt::format(",{}", for_csv(run.figure(column.key)));
      for (const char* key : kMoreKeys)
        text += fmt::format(",{}", for_csv(run.figure(key)));
      text += fmt::format(",{}\n", run.problems().size());
    }
  }
  return text;
}

std::string sweep_page(const std::vector<SweepRow>& rows) {
  std::string text =
      "<!doctype html><html lang=en><meta charset=utf-8><title>Sweep</title>\n"
      "<style>body{font-family:sans-serif;max-width:1200px;margin:2em auto}img{max-width:100%}"
      ".fail{color:#a00}</style>\n<h1>Sweep: the worst map of every row</h1>\n"
      "<p>The table is in <a href=results.md>results.md</a>.</p>\n"
      "<img src=plots/errors.png>\n<img src=plots/along.png>\n<img src=plots/nees.png>\n";
  for (const SweepRow& row : rows)
    text += page_of(row);
  return text + "</html>\n";
}

PlotFiles sweep_plots(const std::vector<SweepRow>& rows) {
  PlotFiles files;
  std::string labels;
  std::string titles;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SweepRow& row = rows[i];
    const std::string comment = fmt::format("# {}\n", label_of(row));
    files.errors_dat += comment;
    files.stations_dat += comment;
    for (const SweptRun& run : row.runs) {
      if (const auto ate_m = run.figure("ate_origin_m"))
        files.errors_dat += fmt::format("{} {:.6f} {}\n", i, *ate_m, run.misses() ? 1 : 0);
    }
    for (const StationConsistency& station : row.stations)
      files.stations_dat +=
          fmt::format("{:.0f} {:.6f} {:.4f} {:.4f} {:.4f}\n", station.travel_m, station.rms_along_m,
                      station.mean_nees, station.band_low, station.band_high);
    if (row.stations.empty()) files.stations_dat += "nan nan nan nan nan\n";  // keeps the count
    files.errors_dat += "\n\n";
    files.stations_dat += "\n\n";
    titles += fmt::format("{}'{}'", i == 0 ? "" : ", ", label_of(row));
    labels += fmt::format("{}\"{}\" {}", i == 0 ? "" : ", ", label_of(row), i);
  }
  files.program = fmt::format(
      "set encoding utf8\nset grid\nset key noenhanced outside right top\n"
      "set terminal pngcairo size {0},{1} font 'sans,11'\n"
      "set output 'errors.png'\nset title 'ATE of every seed (crosses: expectation missed)'\n"
      "set ylabel 'ATE [m]'\nset logscale y\nset xrange [-0.5:{2}.5]\n"
      "set xtics rotate by -60 noenhanced ({3})\n"
      "plot 'errors.dat' using 1:($3==0 ? $2 : NaN) with points pt 7 notitle, "
      "'' using 1:($3==1 ? $2 : NaN) with points pt 2 ps 1.5 notitle\n"
      "unset logscale y\nset xrange [*:*]\nset xtics norotate autofreq\n"
      "set terminal pngcairo size 1400,700 font 'sans,11'\n"
      "set xlabel 'driven [m]'\narray titles[{4}] = [{5}]\n"
      "set output 'along.png'\nset title 'Error along the route, RMS over the seeds'\n"
      "set ylabel 'along [m]'\n"
      "plot for [i=0:{2}] 'stations.dat' index i using 1:2 with lines lw 2 title titles[i+1]\n"
      "set output 'nees.png'\nset title 'Mean NEES over the seeds'\n"
      "set ylabel 'NEES (3 is right)'\nset logscale y\n"
      "plot 'stations.dat' index 0 using 1:4:5 with filledcurves lc rgb '#dddddd' title '95 % "
      "band', "
      "for [i=0:{2}] '' index i using 1:3 with lines lw 2 title titles[i+1]\n",
      700 + 40 * rows.size(), 700, rows.size() - 1, labels, rows.size(), titles);
  return files;
}

}  // namespace waymark::evaluate
