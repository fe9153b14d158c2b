// SPDX-License-Identifier: BSD-3-Clause
// Sub-commands for many runs.
#include "common/files/whole_file.hpp"
#include "evaluate/commands.hpp"
#include "evaluate/sweep/sweep_report.hpp"

#include <fmt/format.h>

namespace waymark::evaluate {
namespace {

namespace fs = std::filesystem;

nlohmann::ordered_json json_of(const std::vector<StationConsistency>& stations) {
  auto json = nlohmann::ordered_json::array();
  for (const StationConsistency& station : stations)
    json.push_back({{"travel_m", station.travel_m},
                    {"runs", station.runs},
                    {"mean_nees", station.mean_nees},
                    {"band_low", station.band_low},
                    {"band_high", station.band_high},
                    {"in_band", station.in_band()},
                    {"rms_along_m", station.rms_along_m},
                    {"rms_heading_rad", station.rms_heading_rad}});
  return json;
}

}  // namespace

int run_sweep(const fs::path& sweep_dir, const Output& output) {
  const std::vector<SweepRow> rows = sweep_rows(read_runs(sweep_dir));
  const PlotFiles plots = sweep_plots(rows);
  fs::create_directories(sweep_dir / "plots");
  write_whole_file(sweep_dir / "plots/errors.dat", plots.errors_dat);
  write_whole_file(sweep_dir / "plots/stations.dat", plots.stations_dat);
  write_whole_file(sweep_dir / "plots/plots.gp", plots.program);
  write_whole_file(sweep_dir / "results.csv", sweep_csv(rows));
  write_whole_file(sweep_dir / "runs.csv", sweep_runs_csv(rows));
  write_whole_file(sweep_dir / "index.html", sweep_page(rows));
  const std::string markdown = sweep_markdown(rows);
  write_whole_file(sweep_dir / "results.md", markdown);
  SkippedLines skipped;
  for (const SweepRow& row : rows) {
    for (const SweptRun& run : row.runs)
      skipped.insert(skipped.end(), run.skipped.begin(), run.skipped.end());
  }
  if (!output.json) {
    fmt::print("{}", markdown);
    return report_skipped(skipped, output);
  }
  auto json = nlohmann::ordered_json::array();
  for (const SweepRow& row : rows)
    json.push_back({{"scenario", row.scenario},
                    {"estimator", row.estimator},
                    {"failures", row.failures()},
                    {"misses", row.misses()},
                    {"problems", row.with_problems()},
                    {"stations_left_out", row.stations_left_out},
                    {"stations", json_of(row.stations)}});
  fmt::print("{}\n", json.dump(2));
  return report_skipped(skipped, output);
}

int run_consistency(const std::vector<fs::path>& row_dirs, const Output& output) {
  SkippedLines skipped;
  std::vector<std::vector<Station>> runs;
  for (const fs::path& dir : row_dirs)
    runs.push_back(read_stations(dir / "stations.csv", skipped));
  const std::vector<StationConsistency> stations = consistency(runs);
  const std::size_t left_out = count_without_covariance(runs);
  if (output.json) {
    fmt::print("{}\n", json_of(stations).dump(2));
  } else {
    fmt::print("driven   runs  mean NEES  95 % band        RMS along\n");
    for (const StationConsistency& station : stations)
      fmt::print("{:4.0f} m  {:6}  {:9.2f}  {:6.2f} .. {:6.2f}  {:7.3f} m{}\n", station.travel_m,
                 station.runs, station.mean_nees, station.band_low, station.band_high,
                 station.rms_along_m, station.in_band() ? "" : "  outside");
    const NeesPerAxis nees = nees_per_axis(runs);
    fmt::print(
        "squared errors over variances: along {:.2f}, across {:.2f}, heading {:.2f}; 1 is right\n",
        nees.along, nees.across, nees.heading);
    fmt::print("in the band: {:.1f} % of {} stations\n", 100.0 * share_in_band(stations),
               stations.size());
  }
  if (left_out > 0)
    fmt::print(stderr, "left out: {} stations of single runs, without a usable covariance\n",
               left_out);
  const int skipped_code = report_skipped(skipped, output);
  return stations.empty() || left_out > 0 ? kExitFailed : skipped_code;
}

}  // namespace waymark::evaluate
