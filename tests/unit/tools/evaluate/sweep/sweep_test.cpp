// SPDX-License-Identifier: BSD-3-Clause
// The summary of a sweep's folder, with runs that met or missed expectations, failed, or are
// missing.
#include "evaluate/commands.hpp"
#include "evaluate/sweep/sweep_report.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::evaluate {
namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

std::string metrics(double ate_m, double accuracy_percent, bool hit) {
  return fmt::format(
      R"({{"ate_origin_m": {}, "accuracy_percent": {}, "along_rmse_m": null, "nees_mean": 2.5,
           "expectations": [{{"figure": "ate_origin_m", "limit": 0.1, "got": {}, "hit": {}}}]}})",
      ate_m, accuracy_percent, ate_m, hit);
}

/// Two scenarios. Recording seed 3 of `dark` failed; seed 2 of its row was not run.
struct SweptFolder {
  TemporaryFolder folder{};

  SweptFolder() {
    std::string plan;
    for (const char* scenario : {"plain", "dark"}) {
      for (const char* row : {"odometry", "waymark"}) {
        for (const char* seed : {"1", "2", "3"})
          plan += fmt::format("{0}\t{2}\t{0}/seed-{2}\t{1}\tagain {0} {2}\n", scenario, row, seed);
      }
    }
    folder.file("plan/runs.tsv", plan);
    for (int seed = 1; seed <= 3; ++seed) {
      const std::string run = fmt::format("plain/seed-{}", seed);
      folder.file(run + "/odometry/metrics.json",
                  R"({"ate_origin_m": 0.4, "accuracy_percent": 99.0, "expectations": []})");
      folder.file(run + "/waymark/metrics.json", metrics(0.04 * seed, 100.1, seed < 3));
      folder.file(run + "/waymark/stations.csv",
                  "travel_m,t,along_m,across_m,heading_rad,nees,sigma_along_m,sigma_across_m,"
                  "sigma_heading_rad,health\n"
                  "1,10,0.1,0,0,3,0.1,0.1,0.1,2\n2,20,0.1,0,0,99,0.1,0.1,0.1,2\n");
    }
    folder.file("dark/seed-1/odometry/metrics.json", metrics(0.5, 98.0, true));
    folder.file("dark/seed-1/waymark/failed", "replay ended with code 139; logs are x/logs/y.*\n");
    folder.file("dark/seed-2/odometry/metrics.json", metrics(0.5, 98.0, true));
    folder.file("dark/seed-3/failed", "recording ended with code 3; logs are z\n");
  }

  std::vector<SweepRow> rows() const { return sweep_rows(read_runs(folder.path())); }
};

TEST(Sweep, RowsHaveMedianWorstFailuresAndUnmetExpectations) {
  const SweptFolder sweep;
  const auto rows = sweep.rows();
  ASSERT_EQ(rows.size(), 4u);
  const SweepRow& waymark = rows[1];
  EXPECT_EQ(waymark.estimator, "waymark");
  EXPECT_EQ(waymark.failures(), 0u);
  EXPECT_EQ(waymark.misses(), 1u);
  EXPECT_NEAR(waymark.figures("ate_origin_m").median.value(), 0.08, 1e-12);
  EXPECT_NEAR(waymark.figures("ate_origin_m").worst.value(), 0.12, 1e-12);
  EXPECT_NEAR(waymark.figures("length_error_percent").worst.value(), 0.1, 1e-9);
  EXPECT_NEAR(waymark.figures("ate_over_odometry").worst.value(), 0.3, 1e-12);
  EXPECT_FALSE(waymark.figures("along_rmse_m").median);
  EXPECT_EQ(waymark.worst_run()->plan.seed, "3");
  EXPECT_EQ(share_in_band(waymark.stations), 0.5);
}

TEST(Sweep, FailedAndUnfinishedRunsAreCountedAndExplained) {
  const SweptFolder sweep;
  const SweepRow dark = sweep.rows()[3];
  EXPECT_EQ(dark.failures(), 3u);
  EXPECT_EQ(dark.worst_run(), nullptr);
  EXPECT_THAT(dark.runs[0].failure, HasSubstr("code 139; logs are x/logs/y"));
  EXPECT_THAT(dark.runs[1].failure, HasSubstr("not finished; logs are in"));
  EXPECT_THAT(dark.runs[2].failure, HasSubstr("recording ended with code 3"));
}

TEST(Sweep, TheTableListsACommandForEachBadSeed) {
  const SweptFolder sweep;
  const std::string table = sweep_markdown(sweep.rows());
  EXPECT_THAT(table, HasSubstr("| plain | waymark | 3 | 0.10 / 0.10 | 0.080 / 0.120 |"));
  EXPECT_THAT(table, HasSubstr("| 0 | 1 | 0 | ate_origin_m 0.1 | MISS |"));
  EXPECT_THAT(table, HasSubstr("| x odometry | mean NEES |"));
  EXPECT_THAT(table, HasSubstr(" | 2.5 / 2.5 | 50 | 0 | 1 | 0 |"));
  EXPECT_THAT(table, HasSubstr("# plain, waymark, seed 3: ate_origin_m 0.12 (limit 0.1)\n"
                               "again plain 3\n"));
  EXPECT_THAT(table, HasSubstr("seed 1: FAILED: replay ended with code 139"));
  EXPECT_THAT(table, Not(HasSubstr("again plain 1")));
}

/// Four seeds of `plain`; the last misses its expectation. Expectations over all seeds are in the
/// file of every run.
std::vector<SweepRow> rows_with(const std::string& expected_of_seeds) {
  const TemporaryFolder folder;
  std::string plan;
  for (int seed = 1; seed <= 4; ++seed) {
    plan += fmt::format("plain\t{0}\tplain/seed-{0}\twaymark\tagain\n", seed);
    const std::string run = fmt::format("plain/seed-{}/waymark", seed);
    nlohmann::json json = nlohmann::json::parse(metrics(0.05, 100.1, seed < 4));
    json["expected_of_seeds"] = nlohmann::json::parse(expected_of_seeds);
    json["marker_map_share"] = 0.9 + 0.01 * seed;
    folder.file(run + "/metrics.json", json.dump());
    folder.file(run + "/stations.csv",
                "travel_m,t,along_m,across_m,heading_rad,nees,sigma_along_m,sigma_across_m,"
                "sigma_heading_rad,health\n"
                "1,10,0.1,0,0,3,0.1,0.1,0.1,2\n2,20,0.1,0,0,99,0.1,0.1,0.1,2\n");
  }
  folder.file("plan/runs.tsv", plan);
  return sweep_rows(read_runs(folder.path()));
}

TEST(Sweep, AllSeedsCountUnlessTheScenarioSaysHowMany) {
  EXPECT_FALSE(rows_with("{}")[0].meets_expectations());
  EXPECT_TRUE(rows_with(R"({"seeds_share": 0.75})")[0].meets_expectations());
  EXPECT_FALSE(rows_with(R"({"seeds_share": 0.8})")[0].meets_expectations());
  EXPECT_THAT(sweep_markdown(rows_with(R"({"seeds_share": 0.75})")),
              HasSubstr("| ate_origin_m 0.1, seeds_share 0.75 | hit |"));
}

TEST(Sweep, StationsOutsideTheirBandAreAnUnmetExpectation) {
  const std::string wanted = R"({{"seeds_share": 0.75, "nees_in_band_share": {}}})";
  EXPECT_TRUE(rows_with(fmt::format(fmt::runtime(wanted), 0.5))[0].meets_expectations());
  EXPECT_FALSE(rows_with(fmt::format(fmt::runtime(wanted), 0.6))[0].meets_expectations());
}

TEST(Sweep, TheWorstFigureIsTheSmallestWhereLargerIsBetter) {
  const Figures figures = rows_with("{}")[0].figures("marker_map_share");
  EXPECT_NEAR(figures.worst.value(), 0.91, 1e-12);
  EXPECT_NEAR(figures.median.value(), 0.925, 1e-12);
}

TEST(Sweep, ErrorsArePlottedByRowWithTheMissedExpectations) {
  const SweptFolder sweep;
  EXPECT_EQ(sweep_plots(sweep.rows()).errors_dat,
            "# plain, odometry\n0 0.400000 0\n0 0.400000 0\n0 0.400000 0\n\n\n"
            "# plain, waymark\n1 0.040000 0\n1 0.080000 0\n1 0.120000 1\n\n\n"
            "# dark, odometry\n2 0.500000 0\n2 0.500000 0\n\n\n"
            "# dark, waymark\n\n\n");
}

TEST(Sweep, StationsArePlottedByRowAlsoWhereARowHasNone) {
  const SweptFolder sweep;
  // Chi-square of 9 degrees of freedom over 3 runs, by the approximation of Wilson and Hilferty.
  EXPECT_EQ(sweep_plots(sweep.rows()).stations_dat,
            "# plain, odometry\nnan nan nan nan nan\n\n\n"
            "# plain, waymark\n1 0.100000 3.0000 0.8915 6.3400\n"
            "2 0.100000 99.0000 0.8915 6.3400\n\n\n"
            "# dark, odometry\nnan nan nan nan nan\n\n\n"
            "# dark, waymark\nnan nan nan nan nan\n\n\n");
}

TEST(Sweep, PlotsAreAsWideAndHaveAsManyLabelsAsThereAreRows) {
  const SweptFolder sweep;
  const std::string program = sweep_plots(sweep.rows()).program;
  EXPECT_THAT(program, HasSubstr("set terminal pngcairo size 860,700 "));  // 700 + 40 for each row
  EXPECT_THAT(program, HasSubstr("set xrange [-0.5:3.5]\n"));
  EXPECT_THAT(program, HasSubstr("noenhanced (\"plain, odometry\" 0, \"plain, waymark\" 1, "
                                 "\"dark, odometry\" 2, \"dark, waymark\" 3)\n"));
  EXPECT_THAT(program, HasSubstr("array titles[4] = ['plain, odometry', 'plain, waymark', "
                                 "'dark, odometry', 'dark, waymark']\n"));
  EXPECT_THAT(program, HasSubstr("plot for [i=0:3] 'stations.dat'"));
}

/// Changes a metric of seed 2 of the row `waymark` of `plain`.
void change_metrics(const SweptFolder& sweep, const std::string& key, const Json& value) {
  const auto file = sweep.folder.path() / "plain/seed-2/waymark/metrics.json";
  Json json = Json::parse(read_text(file));
  json[key] = value;
  sweep.folder.file("plain/seed-2/waymark/metrics.json", json.dump());
}

TEST(Sweep, AFigureThatASeedDoesNotHaveHasNoWorstValue) {
  const SweptFolder sweep;
  change_metrics(sweep, "accuracy_percent", nullptr);
  const auto rows = sweep.rows();
  const Figures figures = rows[1].figures("length_error_percent");
  EXPECT_TRUE(figures.median);
  EXPECT_FALSE(figures.worst);
  EXPECT_THAT(sweep_markdown(rows), HasSubstr("| plain | waymark | 3 | 0.10 / none (2 of 3) |"));
  EXPECT_THAT(sweep_csv(rows), HasSubstr("\nplain,waymark,3,0,1,0,0.5,0.1,none,"));
}

TEST(Sweep, RunsWithProblemsAreCountedAndAreNoHits) {
  const SweptFolder sweep;
  change_metrics(sweep, "problems", {"covers 50 % of the truth"});
  change_metrics(sweep, "expected_of_seeds", {{"seeds_share", 0.6}});
  const auto rows = sweep.rows();
  EXPECT_EQ(rows[1].with_problems(), 1u);
  EXPECT_FALSE(rows[1].meets_expectations());
  const std::string table = sweep_markdown(rows);
  EXPECT_THAT(table, HasSubstr("| 0 | 1 | 1 | ate_origin_m 0.1, seeds_share 0.6 | MISS |"));
  EXPECT_THAT(table, HasSubstr("seed 2: covers 50 % of the truth\nagain plain 2\n"));
  change_metrics(sweep, "problems", Json::array());
  EXPECT_TRUE(sweep.rows()[1].meets_expectations());
}

TEST(Sweep, MetricsOfAnotherFormAreAFailure) {
  for (const char* damaged :
       {R"([{"figure": "ate_origin_m", "got": 1, "hit": true}])", "[1]", "7"}) {
    const SweptFolder sweep;
    change_metrics(sweep, "expectations", Json::parse(damaged));
    const auto rows = sweep.rows();
    EXPECT_EQ(rows[1].failures(), 1u);
    EXPECT_THAT(sweep_markdown(rows), HasSubstr("FAILED: not as waymark-evaluate run writes it: "));
  }
}

TEST(Sweep, WhatIsLeftOutOfStationsIsNamed) {
  const SweptFolder sweep;
  EXPECT_THAT(sweep_markdown(sweep.rows()), Not(HasSubstr("Left out")));
  const std::string file = "plain/seed-2/waymark/stations.csv";
  const std::string text = read_text(sweep.folder.path() / file);
  sweep.folder.file(file, text + "3,30,much\n4,40,0.1,0,0,-1,0.1,0.1,0.1,2\n");
  const std::string table = sweep_markdown(sweep.rows());
  EXPECT_THAT(table, HasSubstr("* plain, waymark, seed 2: 1 lines skipped, first: "));
  EXPECT_THAT(table, HasSubstr("* plain, waymark: 1 stations of single runs have no usable"));
  EXPECT_EQ(run_sweep(sweep.folder.path(), {}), kExitFailed);
  EXPECT_EQ(run_sweep(sweep.folder.path(), Output{false, true}), kExitOk);
}

TEST(Sweep, AllFilesAreWritten) {
  const SweptFolder sweep;
  EXPECT_EQ(run_sweep(sweep.folder.path(), {}), kExitOk);
  const std::string csv = read_text(sweep.folder.path() / "results.csv");
  EXPECT_THAT(csv, HasSubstr("\nplain,waymark,3,0,1,0,0.5,"));
  EXPECT_THAT(read_text(sweep.folder.path() / "runs.csv"),
              HasSubstr("\ndark,waymark,3,dark/seed-3/waymark,1,0,"));
  EXPECT_THAT(read_text(sweep.folder.path() / "index.html"),
              HasSubstr("src=\"plain/seed-3/waymark/map.png\""));
  EXPECT_TRUE(std::filesystem::exists(sweep.folder.path() / "plots/plots.gp"));
}

TEST(Sweep, WithoutAPlanThereIsNoSweep) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_runs(folder.path()), SetupError);
  folder.file("plan/runs.tsv", "plain 1 x\n");
  EXPECT_THROW(read_runs(folder.path()), SetupError);
}

}  // namespace
}  // namespace waymark::evaluate
