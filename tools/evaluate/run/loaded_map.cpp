// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/run/loaded_map.hpp"

#include "evaluate/run/run_evaluation.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace waymark::evaluate {
namespace {

/// Largest distance of a marker in both maps: what it moves while the map grows, but no shift of
/// the frame that would show in an error of centimetres.
constexpr double kSamePlace_m = 0.1;

}  // namespace

std::optional<std::string> difference_of(const std::vector<Marker>& used,
                                         const std::vector<Marker>& made) {
  if (used.empty() || made.empty()) return std::nullopt;
  std::vector<double> apart_m;
  for (const Marker& marker : used) {
    const auto same = std::find_if(made.begin(), made.end(), [&](const Marker& other) {
      return other.id == marker.id && other.instance == marker.instance;
    });
    if (same == made.end()) continue;
    apart_m.push_back(
        (same->parent_from_marker.translation() - marker.parent_from_marker.translation()).norm());
  }
  if (apart_m.empty()) return "has none of its markers";
  std::sort(apart_m.begin(), apart_m.end());
  const auto same = std::upper_bound(apart_m.begin(), apart_m.end(), kSamePlace_m);
  const auto num_same = static_cast<std::size_t>(same - apart_m.begin());
  if (2 * num_same > apart_m.size()) return std::nullopt;
  return fmt::format("has {} of {} markers of the same id at the same place (median {:.2f} m away)",
                     num_same, apart_m.size(), apart_m[apart_m.size() / 2]);
}

std::optional<std::string> foreign_map(const std::filesystem::path& used_file,
                                       const std::filesystem::path& mapping_run,
                                       SkippedLines& skipped) {
  if (!std::filesystem::exists(used_file)) return std::nullopt;
  const std::vector<Marker> used = read_markers(used_file, skipped);
  std::optional<std::string> first;
  for (const std::string& name : estimators_in(mapping_run)) {
    const std::filesystem::path made_file = mapping_run / name / "markers.csv";
    if (!std::filesystem::exists(made_file)) continue;
    const auto difference = difference_of(used, read_markers(made_file, skipped));
    if (!difference) return std::nullopt;
    if (!first)
      first = fmt::format(
          "{}: the loaded map is not in the frame of the one that --mapped-in {} made: it {}. It "
          "was made by another run, or transformed; no ate_frame_m is given",
          used_file.string(), mapping_run.string(), *difference);
  }
  return first;
}

}  // namespace waymark::evaluate
