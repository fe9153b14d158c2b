// SPDX-License-Identifier: BSD-3-Clause
// A sweep as tables for people and scripts, as data for plots, and as a page of its worst maps.
#pragma once

#include "evaluate/sweep/sweep.hpp"

#include <string>
#include <vector>

namespace waymark::evaluate {

/// One line per scenario and estimator, then the command for each seed that failed or missed.
std::string sweep_markdown(const std::vector<SweepRow>& rows);

/// One line per scenario and estimator.
std::string sweep_csv(const std::vector<SweepRow>& rows);

/// One line per run.
std::string sweep_runs_csv(const std::vector<SweepRow>& rows);

/// The worst map of every row, and the plots.
std::string sweep_page(const std::vector<SweepRow>& rows);

/// Data and program of the plots, for gnuplot run in the folder of both.
struct PlotFiles {
  std::string errors_dat{};    ///< row number, ATE, misses: one block per row
  std::string stations_dat{};  ///< travel, RMS along, mean NEES, band: one block per row
  std::string program{};       ///< writes errors.png, along.png and nees.png
};

PlotFiles sweep_plots(const std::vector<SweepRow>& rows);

}  // namespace waymark::evaluate
