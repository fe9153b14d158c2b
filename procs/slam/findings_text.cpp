// SPDX-License-Identifier: BSD-3-Clause
#include "slam/findings_text.hpp"

#include "slam/core/graph/calibration_terms.hpp"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace waymark {
namespace {

// Less than these is not reported.
constexpr double kWorse = 1.9;       // factor on a standard deviation; learnt in steps of sqrt(2)
constexpr double kNoisier = 1.3;     // factor on the standard deviation of ranges
constexpr double kManyBeams = 0.05;  // moving; a few are noise at edges of walls
constexpr double kManyScans = 0.05;  // contradict a loaded map; fewer are people and doors
constexpr double kBriefly = 0.001;   // of observations; fewer are a push, or a wrong match
constexpr double kMinShare = 0.01;   // of the scans or observations; less may be an opened door

double share_of(std::int64_t part, std::int64_t all) {
  return all > 0 ? static_cast<double>(part) / static_cast<double>(all) : 0.0;
}

class List {
 public:
  void add(std::string name, std::string text, double value,
           std::optional<double> share = std::nullopt) {
    list_.push_back({std::move(name), std::move(text), value, share});
  }

  /// @param text  with {} for the share in percent.
  void add_share(std::string name, fmt::format_string<double> text, std::int64_t part,
                 std::int64_t all, double least = kMinShare) {
    const double share = share_of(part, all);
    if (part == 0 || share < least) return;
    add(std::move(name), fmt::format(text, 100.0 * share), static_cast<double>(part), share);
  }

  std::vector<Finding> take() { return std::move(list_); }

 private:
  std::vector<Finding> list_{};
};

void add_odometry(const SensorStatistics& f, List& list) {
  if (f.odometry_along >= kWorse) {
    list.add("odometry_along_noise_scale",
             fmt::format("odometry is {:.1f} times as noisy along the path as described",
                         f.odometry_along),
             f.odometry_along);
  }
  if (f.odometry_turn >= kWorse) {
    list.add(
        "odometry_turn_noise_scale",
        fmt::format("odometry is {:.1f} times as noisy in turns as described", f.odometry_turn),
        f.odometry_turn);
  }
  if (f.slips > 0) {
    list.add("odometry_slips_m_per_sqrt_m",
             fmt::format("wheels slip: {} times, which adds {:.3f} m per root metre to the noise",
                         f.slips, f.slip_m_per_sqrt_m),
             f.slip_m_per_sqrt_m);
  }
  list.add_share("odometry_stuck",
                 "odometry stood still while the robot moved for {:.1f} % of the observations",
                 f.odometry_stuck, f.observations, kBriefly);
  list.add_share("odometry_jumping", "odometry jumped about for {:.1f} % of the observations",
                 f.odometry_jumping, f.observations, 0.0);
  if (f.odometry_caught_up > 0) {
    list.add("odometry_caught_up",
             fmt::format("odometry reported motion late, {} times", f.odometry_caught_up),
             static_cast<double>(f.odometry_caught_up));
  }
}

void add_ranges(const SensorStatistics& f, std::int64_t repeated_scans, List& list) {
  if (f.range_sigma_m >= kNoisier * f.described_range_sigma_m) {
    list.add("range_noise_scale",
             fmt::format("LiDAR ranges scatter by {:.3f} m, described are {:.3f} m",
                         f.range_sigma_m, f.described_range_sigma_m),
             f.range_sigma_m / f.described_range_sigma_m);
  }
  list.add_share("scans_rescaled", "LiDAR ranges were at another scale in {:.1f} % of the scans",
                 f.scans_rescaled, f.scans, 0.0);
  if (f.scans_rescaled > 0) {
    list.add(
        "range_share",
        fmt::format("in the last of them {:.1f} % too {}", 100.0 * std::abs(f.range_scale_error),
                    f.range_scale_error > 0.0 ? "long" : "short"),
        f.range_scale_error);
  }
  list.add_share("scans_refuted", "{:.1f} % of the scans contradict the map and were left out",
                 f.scans_refuted, f.scans);
  list.add_share("scans_contradict_loaded_map",
                 "{:.1f} % of the scans contradict the loaded map: it is of another place, or much "
                 "has changed",
                 f.loaded_map.contradicting, f.loaded_map.scans, kManyScans);
  if (f.loaded_map.do_markers_contradict()) {
    const std::int64_t sighted = f.loaded_map.markers_moved + f.loaded_map.markers_in_place;
    list.add("markers_contradict_loaded_map",
             fmt::format("{} of {} sighted markers of the loaded map hang elsewhere: it is of "
                         "another building, or is to be made anew",
                         f.loaded_map.markers_moved, sighted),
             static_cast<double>(f.loaded_map.markers_moved));
  }
  list.add_share("scans_unusable",
                 "{:.1f} % of the scans show too few mapped walls and were left out",
                 f.scans_unusable, f.scans);
  list.add_share("beams_moving",
                 "{:.1f} % of the LiDAR's beams end where the map is free, on people or doors, and "
                 "were left out of the matching",
                 f.beams_moving, f.beams, kManyBeams);
  list.add_share("scans_repeated", "{:.1f} % of the scans repeat one from another place",
                 repeated_scans, f.scans + repeated_scans, 0.0);
}

}  // namespace

std::vector<Finding> reportable_findings(const SensorStatistics& statistics,
                                         std::int64_t repeated_scans) {
  List list;
  add_odometry(statistics, list);
  add_ranges(statistics, repeated_scans, list);
  for (const Miscalibration& found : statistics.miscalibrated) {
    // The more a turn is noise, the smaller is the scale that predicts it best (regression
    // dilution): good for predictions, but no advice on how to mend the odometry.
    if (found.term == OdometryTerm::kTurnScale && statistics.odometry_turn >= kWorse) continue;
    const CalibrationTerm& term = kCalibrationTerms.at(found.term);
    list.add(fmt::format("calibration_{}", term.key),
             fmt::format("{}: {:+.4g} +- {:.1g} {} from the description", term.name,
                         term.per_unit * found.error, term.per_unit * found.sigma, term.unit),
             found.error);
  }
  if (statistics.loops_ambiguous > 0) {
    list.add("loops_ambiguous",
             fmt::format("scans fitted in several places of the map {} times, which closed no loop",
                         statistics.loops_ambiguous),
             static_cast<double>(statistics.loops_ambiguous));
  }
  if (statistics.relocalisations > 0) {
    list.add("relocalisations",
             fmt::format("the robot was relocalised {} times", statistics.relocalisations),
             static_cast<double>(statistics.relocalisations));
  }
  return list.take();
}

std::string sentence_of(std::span<const Finding> findings) {
  std::string sentence;
  for (const Finding& finding : findings)
    sentence += (sentence.empty() ? "" : "; ") + finding.text;
  return sentence.empty() ? "nothing" : sentence;
}

}  // namespace waymark
