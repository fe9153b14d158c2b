// SPDX-License-Identifier: BSD-3-Clause
// Surveyed markers: data association, the frame that they define, and their priors.
#pragma once

#include "slam/core/association/marker_book.hpp"
#include "slam/core/graph/graph.hpp"
#include "slam/core/landmark/surveyed_marker.hpp"
#include "slam/core/mapping/map_change.hpp"

#include <optional>
#include <vector>

namespace waymark {

/// Two surveyed markers, or one with yaw, define the map frame. From then on each surveyed marker
/// that is sighted becomes a prior of its landmark. Priors that contradict measurements and other
/// priors are switched off, one by one: each time the one whose removal reduces the cost most.
class Survey {
 public:
  explicit Survey(const std::vector<SurveyedMarker>& markers);

  bool is_empty() const { return entries_.empty(); }

  bool has_map_frame() const { return has_map_frame_; }

  /// Associates surveyed markers with landmarks that have enough sightings, and those whose priors
  /// are off with the nearest landmarks of their ids.
  /// @return whether there are new associations, or landmarks have been sighted so much more often
  ///         since their priors were tested that the priors have to be tested again.
  bool match(const Graph& graph, const MarkerBook& book);

  /// survey_from_map, once, when the survey first defines the frame.
  std::optional<Se2> new_frame(const Graph& graph);

  /// Adds the priors of new associations; switches contradicted priors off and the others on.
  /// @return whether a prior was switched: then the whole graph has to be solved.
  bool apply(Graph& graph);

  /// Whether entries contradict each other and none is clearly wrong: the frame is uncertain.
  bool is_undecided() const { return unresolved_sigmas_ > 0.0; }

  /// Surveyed markers whose landmarks are more than 5 sigmas from their surveyed places, and while
  /// is_undecided() all whose priors are on.
  std::vector<MapChange> changes(const Graph& graph) const;

 private:
  struct Entry {
    SurveyedMarker marker{};
    std::optional<std::size_t> landmark{};
    int tested_sightings{0};  ///< landmark's sightings when its prior was last tested
    bool has_prior{false};    ///< the graph has its prior
    bool is_prior_on{false};
  };

  std::optional<std::size_t> landmark_of(const SurveyedMarker& marker, const Graph& graph,
                                         const MarkerBook& book) const;
  void associate(Entry& entry, const Graph& graph, const MarkerBook& book) const;
  void add_priors(Graph& graph);
  double sigmas_off(const Entry& entry, const Graph& graph) const;

  std::vector<Entry> entries_{};
  bool has_map_frame_{false};
  double unresolved_sigmas_{0.0};  ///< root of the excess of chi^2 that remains; 0: none
};

}  // namespace waymark
