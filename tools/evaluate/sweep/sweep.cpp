// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/sweep/sweep.hpp"

#include "common/geometry/median.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string_view>
#include <utility>

namespace waymark::evaluate {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

std::vector<std::string> split_at_tabs(const std::string& line) {
  std::vector<std::string> words{""};
  for (const char c : line) {
    if (c == '\t')
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

std::string first_line(const fs::path& file) {
  const std::vector<std::string> lines = read_lines(file);
  return lines.empty() ? file.string() + ": empty" : lines.front();
}

/// True if all parts of metrics.json that are read here have the form in which `run` writes them.
bool is_as_written(const Json& metrics) {
  if (!metrics.is_object()) return false;
  const auto all_of = [&metrics](const char* key, const std::function<bool(const Json&)>& is_good) {
    const Json list = metrics.value(key, Json::array());
    return list.is_array() && std::all_of(list.begin(), list.end(), is_good);
  };
  const auto has_all_keys = [](const Json& figure) {
    return figure.is_object() && figure.contains("got") &&
           figure.value("figure", Json{}).is_string() &&
           figure.value("limit", Json{}).is_number() && figure.value("hit", Json{}).is_boolean();
  };
  return all_of("expectations", has_all_keys) &&
         all_of("problems", [](const Json& problem) { return problem.is_string(); });
}

SweptRun read_run(const fs::path& sweep_dir, const PlannedRun& plan) {
  SweptRun run{.plan = plan};
  const fs::path folder = sweep_dir / plan.folder;
  const fs::path row = folder / plan.estimator;
  for (const fs::path& failed : {folder / "failed", row / "failed"}) {
    if (!fs::exists(failed)) continue;
    run.failure = first_line(failed);
    return run;
  }
  const fs::path metrics = row / "metrics.json";
  if (!fs::exists(metrics)) {
    run.failure = fmt::format("not finished; logs are in {}", (folder / "logs").string());
    return run;
  }
  run.metrics = Json::parse(read_text(metrics), nullptr, false);
  if (!is_as_written(run.metrics))
    run.failure = fmt::format("not as waymark-evaluate run writes it: {}", metrics.string());
  else if (!run.figure("ate_origin_m"))
    run.failure = fmt::format("no trajectory error; see {}", metrics.string());
  if (run.has_failed()) {
    run.metrics = nullptr;
    return run;
  }
  if (fs::exists(row / "stations.csv"))
    run.stations = read_stations(row / "stations.csv", run.skipped);
  return run;
}

void add_figures(SweptRun& run, const std::optional<double>& odometry_ate_m) {
  if (run.has_failed()) return;
  if (const auto accuracy = run.figure("accuracy_percent"))
    run.metrics["length_error_percent"] = std::abs(100.0 - *accuracy);
  if (odometry_ate_m && *odometry_ate_m > 0.0)
    run.metrics["ate_over_odometry"] = *run.figure("ate_origin_m") / *odometry_ate_m;
}

bool is_higher_better(std::string_view key) {
  constexpr std::array<std::string_view, 4> kKeys{"marker_map_share", "moved_named_share",
                                                  "sigma_growth", "share_tracking"};
  return std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

}  // namespace

std::vector<PlannedRun> read_plan(const fs::path& sweep_dir) {
  const fs::path file = sweep_dir / "plan" / "runs.tsv";
  const std::vector<std::string> lines = read_lines(file);
  std::vector<PlannedRun> plan;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::vector<std::string> words = split_at_tabs(lines[i]);
    if (words.size() != 5)
      throw SetupError{at_line(
          file, i + 1, "expected scenario, seed, folder, row and command, separated by tabs")};
    plan.push_back({words[0], words[1], words[2], words[3], words[4]});
  }
  if (plan.empty()) throw SetupError{file.string() + ": no runs in it"};
  return plan;
}

bool SweptRun::misses() const {
  if (has_failed() || !metrics.contains("expectations")) return false;
  return std::any_of(metrics["expectations"].begin(), metrics["expectations"].end(),
                     [](const Json& figure) { return !figure.value("hit", false); });
}

std::vector<std::string> SweptRun::problems() const {
  if (has_failed()) return {};
  return metrics.value("problems", std::vector<std::string>{});
}

double SweptRun::sweep_limit(const std::string& key) const {
  const Json::json_pointer place{"/expected_of_seeds/" + key};
  if (!metrics.is_object() || !metrics.contains(place) || !metrics[place].is_number()) return 0.0;
  return metrics[place].get<double>();
}

std::optional<double> SweptRun::figure(const std::string& key) const {
  if (!metrics.is_object() || !metrics.contains(key) || !metrics[key].is_number())
    return std::nullopt;
  return metrics[key].get<double>();
}

std::vector<SweptRun> read_runs(const fs::path& sweep_dir) {
  std::vector<SweptRun> runs;
  for (const PlannedRun& plan : read_plan(sweep_dir))
    runs.push_back(read_run(sweep_dir, plan));
  return runs;
}

std::size_t SweepRow::failures() const {
  return static_cast<std::size_t>(std::count_if(
      runs.begin(), runs.end(), [](const SweptRun& run) { return run.has_failed(); }));
}

std::size_t SweepRow::misses() const {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const SweptRun& run) { return run.misses(); }));
}

std::size_t SweepRow::with_problems() const {
  return static_cast<std::size_t>(std::count_if(
      runs.begin(), runs.end(), [](const SweptRun& run) { return !run.problems().empty(); }));
}

Figures SweepRow::figures(const std::string& key) const {
  std::vector<double> values;
  for (const SweptRun& run : runs) {
    if (const auto value = run.figure(key)) values.push_back(*value);
  }
  Figures figures{.count = values.size(), .seeds = runs.size() - failures()};
  if (values.empty()) return figures;
  figures.median = median(values);
  const auto [smallest, largest] = std::ranges::minmax(values);
  if (!figures.is_partial()) figures.worst = is_higher_better(key) ? smallest : largest;
  return figures;
}

double SweepRow::limit(const std::string& key) const {
  double limit = 0.0;
  for (const SweptRun& run : runs)
    limit = std::max(limit, run.sweep_limit(key));
  return limit;
}

bool SweepRow::expects_anything() const {
  return limit("nees_in_band_share") > 0.0 ||
         std::any_of(runs.begin(), runs.end(), [](const SweptRun& run) {
           return run.metrics.is_object() && run.metrics.contains("expectations") &&
                  !run.metrics["expectations"].empty();
         });
}

bool SweepRow::meets_expectations() const {
  constexpr double kAll = 1.0;
  const double wanted = limit("seeds_share") > 0.0 ? limit("seeds_share") : kAll;
  const auto is_good = [](const SweptRun& run) {
    return !run.has_failed() && !run.misses() && run.problems().empty();
  };
  const auto hits = static_cast<double>(std::count_if(runs.begin(), runs.end(), is_good));
  constexpr double kRounding = 1e-9;
  return hits + kRounding >= wanted * static_cast<double>(runs.size()) &&
         (limit("nees_in_band_share") <= 0.0 ||
          share_in_band(stations) >= limit("nees_in_band_share"));  // NaN is no hit
}

const SweptRun* SweepRow::worst_run() const {
  const SweptRun* worst = nullptr;
  const auto badness = [](const SweptRun& run) {
    return std::pair{run.misses(), run.figure("ate_origin_m").value_or(0.0)};
  };
  for (const SweptRun& run : runs) {
    if (!run.has_failed() && (worst == nullptr || badness(run) > badness(*worst))) worst = &run;
  }
  return worst;
}

std::vector<SweepRow> sweep_rows(std::vector<SweptRun> runs) {
  std::map<std::string, std::optional<double>> odometry_ate_m;  // by folder
  for (const SweptRun& run : runs) {
    if (run.plan.estimator == "odometry")
      odometry_ate_m[run.plan.folder] = run.figure("ate_origin_m");
  }
  std::vector<SweepRow> rows;
  std::map<std::pair<std::string, std::string>, std::size_t> row_of;
  for (SweptRun& run : runs) {
    add_figures(run, odometry_ate_m[run.plan.folder]);
    const auto [place, is_new] =
        row_of.try_emplace({run.plan.scenario, run.plan.estimator}, rows.size());
    if (is_new) rows.push_back({.scenario = run.plan.scenario, .estimator = run.plan.estimator});
    rows[place->second].runs.push_back(std::move(run));
  }
  for (SweepRow& row : rows) {
    std::vector<std::vector<Station>> stations;
    for (const SweptRun& run : row.runs)
      stations.push_back(run.stations);
    row.stations = consistency(stations);
    row.stations_left_out = count_without_covariance(stations);
  }
  return rows;
}

}  // namespace waymark::evaluate
