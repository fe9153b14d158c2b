// SPDX-License-Identifier: BSD-3-Clause
// Surveyed markers: which landmarks they are, and which frame they define.
#pragma once

#include "slam/core/graph/association.hpp"
#include "slam/core/graph/graph.hpp"
#include "slam/core/landmark/surveyed_marker.hpp"
#include "slam/core/mapping/map_change.hpp"

#include <optional>
#include <vector>

namespace waymark {

/// Two surveyed markers, or one with yaw, define the map frame. From then on each surveyed marker
/// that is met is a prior of its landmark. One that the drive and the others contradict is taken
/// out where leaving it out alone mends the contradiction.
class Survey {
 public:
  explicit Survey(std::vector<SurveyedMarker> markers);

  bool is_empty() const { return entries_.empty(); }

  bool has_frame() const { return has_frame_; }

  /// Looks for landmarks that are surveyed and have become sure.
  /// @return whether there are new ones.
  bool match(const Graph& graph, const MarkerBook& book);

  /// Once there is a frame: survey_from_map, by which the graph is to be moved.
  std::optional<Se2> new_frame(const Graph& graph);

  /// Adds the priors of new matches, solves, and tests those that are contradicted.
  void apply(Graph& graph, int solve_steps);

  /// Markers that the graph has more than kWrong sigma away from where the survey has them; and
  /// those that contradict each other, where nobody can know which one is wrong.
  std::vector<MapChange> changes(const Graph& graph) const;

 private:
  struct Entry {
    SurveyedMarker marker{};
    std::optional<std::size_t> landmark{};
    bool has_prior{false};  ///< in the graph
  };

  /// Whether the other entries fix where the map is, and how it is turned.
  bool holds_frame(const Graph& graph, const Entry& without) const;
  void switch_all(Graph& graph, bool is_on) const;
  std::vector<const Entry*> most_suspicious(const Graph& graph) const;
  double sigmas_off(const Entry& entry, const Graph& graph) const;

  std::vector<Entry> entries_{};
  bool has_frame_{false};
  double unresolved_sigmas_{0.0};  ///< by which entries contradict each other, none clearly wrong
};

}  // namespace waymark
