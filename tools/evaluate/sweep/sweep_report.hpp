// SPDX-License-Identifier: BSD-3-Clause
// A sweep as tables, plots, and a page of its worst maps.
#pragma once

#include "evaluate/sweep/sweep.hpp"

#include <string>
#include <vector>

namespace waymark::evaluate {

/// One line per scenario and estimator; what the statistics leave out; a command for each seed that
/// failed, missed an expectation or has problems.
std::string sweep_markdown(const std::vector<SweepRow>& rows);

/// One line per scenario and estimator. The worst value of a figure is "none" if only some of the
/// seeds have the figure, and empty if none has it.
std::string sweep_csv(const std::vector<SweepRow>& rows);

/// One line per run.
std::string sweep_runs_csv(const std::vector<SweepRow>& rows);

/// The worst map of every row, and the plots.
std::string sweep_page(const std::vector<SweepRow>& rows);

/// Data and gnuplot program of the plots; gnuplot has to run in their folder.
struct PlotFiles {
  std::string errors_dat{};    ///< row number, ATE, misses: one block per row
  std::string stations_dat{};  ///< travel, RMS along, mean NEES, band: one block per row
  std::string program{};       ///< writes errors.png, along.png and nees.png
};

PlotFiles sweep_plots(const std::vector<SweepRow>& rows);

}  // namespace waymark::evaluate
