// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/survey.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark {
namespace {

constexpr double kWrong = 5.0;           // sigmas
constexpr double kLeastApart_m = 1.0;    // between two markers that define a frame's rotation
constexpr double kClearlyBetter = 25.0;  // chi^2 that switching the wrong prior off has to save
constexpr int kConfirmed = 3;            // sightings of a landmark
constexpr double kContradiction = 50.0;  // chi^2 that correct priors add at most
constexpr double kGauge = 1e3;           // 1 / sigma [m, rad] of the prior that fixes the gauge
constexpr int kMostLeftOut = 5;          // priors to switch off
constexpr std::size_t kMostTried = 8;    // entries, the most suspicious ones

LandmarkPrior prior_of(const SurveyedMarker& marker, std::size_t landmark) {
  LandmarkPrior prior;
  prior.landmark = landmark;
  prior.map_from_marker = marker.survey_from_marker;
  Eigen::Vector3d information_root = marker.sigmas.cwiseInverse();
  if (!marker.has_yaw) information_root.z() = 0.0;
  prior.root_information = information_root.asDiagonal();
  return prior;
}

}  // namespace

Survey::Survey(std::vector<SurveyedMarker> markers) {
  for (SurveyedMarker& marker : markers)
    entries_.push_back({marker, std::nullopt});
}

bool Survey::match(const Graph& graph, const MarkerBook& book) {
  bool is_new = false;
  for (Entry& entry : entries_) {
    if (entry.landmark) continue;
    double least_m = 0.0;
    int candidates = 0;
    for (std::size_t i = 0; i < book.entries().size(); ++i) {
      const Landmark& landmark = book.entries()[i];
      if (landmark.id != entry.marker.id || book.is_retired(i) || landmark.sightings < kConfirmed) {
        continue;
      }
      const double away_m =
          (graph.state().landmarks[i].translation() - entry.marker.survey_from_marker.translation())
              .norm();
      if (candidates++ > 0 && away_m >= least_m) continue;
      least_m = away_m;
      entry.landmark = i;
    }
    // Without a frame, markers of the same id cannot be distinguished.
    if (!has_frame_ && candidates > 1) entry.landmark.reset();
    is_new |= entry.landmark.has_value();
  }
  return is_new;
}

std::optional<Se2> Survey::new_frame(const Graph& graph) {
  if (has_frame_) return std::nullopt;
  const auto mapped = [&](const Entry& entry) -> const Se2& {
    return graph.state().landmarks[*entry.landmark];
  };
  for (const Entry& entry : entries_) {
    if (!entry.landmark || !entry.marker.has_yaw) continue;
    has_frame_ = true;
    return entry.marker.survey_from_marker * mapped(entry).inverse();
  }
  for (const Entry& a : entries_) {
    for (const Entry& b : entries_) {
      if (!a.landmark || !b.landmark || &a == &b) continue;
      const Eigen::Vector2d by_survey =
          b.marker.survey_from_marker.translation() - a.marker.survey_from_marker.translation();
      const Eigen::Vector2d by_map = mapped(b).translation() - mapped(a).translation();
      if (std::min(by_survey.norm(), by_map.norm()) < kLeastApart_m) continue;
      has_frame_ = true;
      const Se2 turn{0.0, 0.0,
                     std::atan2(by_survey.y(), by_survey.x()) - std::atan2(by_map.y(), by_map.x())};
      const Eigen::Vector2d middle = 0.5 * (mapped(a).translation() + mapped(b).translation());
      const Eigen::Vector2d surveyed = a.marker.survey_from_marker.translation() + 0.5 * by_survey;
      return Se2{surveyed - turn * middle, turn.theta()};
    }
  }
  return std::nullopt;
}

void Survey::apply(Graph& graph, int solve_steps) {
  for (Entry& entry : entries_) {
    if (!entry.landmark || entry.has_prior) continue;
    graph.add(prior_of(entry.marker, *entry.landmark));
    entry.has_prior = true;
  }
  Graph free = graph;
  switch_all(free, false);
  // Without priors the gauge would be free.
  free.add(PosePrior{0, free.state().keyframes[0], kGauge * Eigen::Matrix3d::Identity()});
  free.optimise_all(solve_steps);
  switch_all(graph, true);  // tested again, with the new measurements
  graph.optimise_all(solve_steps);
  for (int i = 0; i < kMostLeftOut && graph.cost() - free.cost() > kContradiction; ++i) {
    // The wrong prior is the one without which the contradiction is smallest by far.
    std::optional<Graph> best;
    double least = graph.cost() - kClearlyBetter;
    for (const Entry* entry : most_suspicious(graph)) {
      if (!holds_frame(graph, *entry)) continue;  // of the last two, either may be wrong
      Graph without = graph;
      without.switch_prior(*entry->landmark, false);
      without.optimise_all(solve_steps);
      if (without.cost() >= least) continue;
      least = without.cost();
      best = std::move(without);
    }
    if (!best) break;
    graph = std::move(*best);
  }
  const double contradiction = graph.cost() - free.cost();
  unresolved_sigmas_ = contradiction > kContradiction ? std::sqrt(contradiction) : 0.0;
}

bool Survey::holds_frame(const Graph& graph, const Entry& without) const {
  int num_places = 0;
  for (const Entry& entry : entries_) {
    if (&entry == &without || !entry.has_prior || !graph.is_prior_on(*entry.landmark)) continue;
    if (entry.marker.has_yaw) return true;
    ++num_places;
  }
  return num_places >= 2;
}

void Survey::switch_all(Graph& graph, bool is_on) const {
  for (const Entry& entry : entries_)
    if (entry.has_prior) graph.switch_prior(*entry.landmark, is_on);
}

/// Entries by their own chi^2 plus that of their landmark's measurements, the largest first.
std::vector<const Survey::Entry*> Survey::most_suspicious(const Graph& graph) const {
  std::vector<std::pair<double, const Entry*>> costs;
  for (const Entry& entry : entries_) {
    if (!entry.has_prior || !graph.is_prior_on(*entry.landmark)) continue;
    const double sigmas = sigmas_off(entry, graph);
    costs.emplace_back(sigmas * sigmas + graph.cost_of_landmark(*entry.landmark), &entry);
  }
  std::stable_sort(costs.begin(), costs.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (costs.size() > kMostTried) costs.resize(kMostTried);
  std::vector<const Entry*> entries;
  for (const auto& [cost, entry] : costs)
    entries.push_back(entry);
  return entries;
}

double Survey::sigmas_off(const Entry& entry, const Graph& graph) const {
  const LandmarkPrior prior = prior_of(entry.marker, *entry.landmark);
  return prior.linearise(graph.state()).residual.norm();
}

std::vector<MapChange> Survey::changes(const Graph& graph) const {
  std::vector<MapChange> changes;
  for (const Entry& entry : entries_) {
    if (!entry.has_prior) continue;
    const bool is_on = graph.is_prior_on(*entry.landmark);
    const double sigmas = std::max(sigmas_off(entry, graph), is_on ? unresolved_sigmas_ : 0.0);
    if (sigmas <= kWrong) continue;
    MapChange change;
    change.kind = MapChange::Kind::kSurveyOff;
    change.id = entry.marker.id;
    change.place = graph.state().landmarks[*entry.landmark];
    change.was_at = entry.marker.survey_from_marker.translation();
    change.sigmas = sigmas;
    changes.push_back(change);
  }
  return changes;
}

}  // namespace waymark
