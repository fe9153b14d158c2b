// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/association/survey.hpp"

#include "slam/core/association/survey_model.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark {
namespace {

constexpr double kWrong = 5.0;           // sigmas beyond which an entry is reported
constexpr double kMinApart_m = 1.0;      // between two markers that define a frame's rotation
constexpr double kClearlyBetter = 25.0;  // chi^2 that switching the wrong prior off has to save
constexpr int kConfirmed = 3;     // sightings of a landmark before it is assigned to an entry
constexpr int kRetestFactor = 4;  // growth of the sightings after which a prior is tested again
// Largest excess of chi^2 over its mean with correct priors: the larger of a constant and a
// multiple of its standard deviation.
constexpr double kContradiction = 50.0;
constexpr double kContradictionSigmas = 5.0;
constexpr int kMaxSwitchedOff = 5;    // priors
constexpr std::size_t kMaxTried = 8;  // entries, the most suspicious ones

LandmarkPrior prior_of(const SurveyedMarker& marker, std::size_t landmark) {
  LandmarkPrior prior;
  prior.landmark = landmark;
  prior.map_from_marker = marker.survey_from_marker;
  Eigen::Vector3d information_root = marker.sigmas.cwiseInverse();
  if (!marker.has_yaw) information_root.z() = 0.0;
  prior.root_information = information_root.asDiagonal();
  return prior;
}

/// Whether the priors other than `without` determine the frame's position and rotation.
bool determine_frame(const std::vector<LandmarkPrior>& priors, std::size_t without) {
  int num_places = 0;
  for (std::size_t i = 0; i < priors.size(); ++i) {
    if (i == without || priors[i].is_off) continue;
    if (priors[i].root_information(2, 2) > 0.0) return true;
    ++num_places;
  }
  return num_places >= 2;
}

/// Excess of chi^2 over its mean, the number of degrees of freedom, if correct priors do not
/// explain it; else 0.
double contradiction_of(double chi2, const std::vector<LandmarkPrior>& priors) {
  int freedom = -3;  // the frame has three
  for (const LandmarkPrior& prior : priors)
    if (!prior.is_off) freedom += prior.root_information(2, 2) > 0.0 ? 3 : 2;
  const double excess = chi2 - freedom;
  const double usual = std::max(kContradiction, kContradictionSigmas * std::sqrt(2.0 * freedom));
  return excess > usual ? excess : 0.0;
}

/// At most kMaxTried priors that may be switched off; first the one without which the cost is
/// least.
std::vector<std::size_t> most_suspicious(const std::vector<LandmarkPrior>& priors,
                                         const SurveyModel::Solution& solution) {
  std::vector<std::pair<double, std::size_t>> savings;
  for (std::size_t i = 0; i < priors.size(); ++i)
    // Only if the other priors determine the frame: of the last two, either could be wrong.
    if (!priors[i].is_off && determine_frame(priors, i))
      savings.emplace_back(saving_without(priors[i], solution), i);
  std::stable_sort(savings.begin(), savings.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  if (savings.size() > kMaxTried) savings.resize(kMaxTried);
  std::vector<std::size_t> indices;
  for (const auto& [saving, index] : savings)
    indices.push_back(index);
  return indices;
}

/// Switches contradicted priors off.
/// @return contradiction_of() for the priors that stay on.
double switch_wrong_off(std::vector<LandmarkPrior>& priors, const SurveyModel& model) {
  const double free = model.cost_without_priors();
  SurveyModel::Solution solution = model.solve(priors);
  for (int i = 0; i < kMaxSwitchedOff && contradiction_of(solution.cost - free, priors) > 0.0;
       ++i) {
    // The wrong prior is the one whose removal reduces the cost most, and by enough.
    std::optional<std::size_t> wrong;
    SurveyModel::Solution best;
    best.cost = solution.cost - kClearlyBetter;
    for (const std::size_t candidate : most_suspicious(priors, solution)) {
      priors[candidate].is_off = true;
      SurveyModel::Solution without = model.solve(priors);
      priors[candidate].is_off = false;
      if (without.cost >= best.cost) continue;
      best = std::move(without);
      wrong = candidate;
    }
    if (!wrong) break;
    priors[*wrong].is_off = true;
    solution = std::move(best);
  }
  return contradiction_of(solution.cost - free, priors);
}

}  // namespace

Survey::Survey(const std::vector<SurveyedMarker>& markers) {
  for (const SurveyedMarker& marker : markers)
    entries_.push_back({marker, std::nullopt});
}

std::optional<std::size_t> Survey::landmark_of(const SurveyedMarker& marker, const Graph& graph,
                                               const MarkerBook& book) const {
  std::optional<std::size_t> nearest;
  double least_m = 0.0;
  int candidates = 0;
  for (std::size_t i = 0; i < book.entries().size(); ++i) {
    const Landmark& landmark = book.entries()[i];
    if (landmark.id != marker.id || book.is_retired(i) || landmark.sightings < kConfirmed) continue;
    const double away_m =
        (graph.state().landmarks[i].translation() - marker.survey_from_marker.translation()).norm();
    if (candidates++ > 0 && away_m >= least_m) continue;
    least_m = away_m;
    nearest = i;
  }
  // Without a frame, markers of the same id cannot be distinguished.
  if (!has_map_frame_ && candidates > 1) return std::nullopt;
  return nearest;
}

/// An entry whose prior is on keeps its landmark; one whose prior is off may have been associated
/// with another marker of its id before the frame was known.
void Survey::associate(Entry& entry, const Graph& graph, const MarkerBook& book) const {
  if (entry.is_prior_on) return;
  const auto landmark = landmark_of(entry.marker, graph, book);
  if (landmark == entry.landmark || (entry.has_prior && !landmark)) return;
  entry = Entry{entry.marker, landmark};
}

bool Survey::match(const Graph& graph, const MarkerBook& book) {
  bool is_due = false;
  for (Entry& entry : entries_) {
    associate(entry, graph, book);
    if (!entry.landmark) continue;
    const int sightings = book.entries()[*entry.landmark].sightings;
    if (sightings < kRetestFactor * entry.tested_sightings) continue;
    entry.tested_sightings = sightings;
    is_due = true;
  }
  return is_due;
}

std::optional<Se2> Survey::new_frame(const Graph& graph) {
  if (has_map_frame_) return std::nullopt;
  const auto mapped = [&](const Entry& entry) -> const Se2& {
    return graph.state().landmarks[*entry.landmark];
  };
  for (const Entry& entry : entries_) {
    if (!entry.landmark || !entry.marker.has_yaw) continue;
    has_map_frame_ = true;
    return entry.marker.survey_from_marker * mapped(entry).inverse();
  }
  for (const Entry& a : entries_) {
    for (const Entry& b : entries_) {
      if (!a.landmark || !b.landmark || &a == &b) continue;
      const Eigen::Vector2d by_survey =
          b.marker.survey_from_marker.translation() - a.marker.survey_from_marker.translation();
      const Eigen::Vector2d by_map = mapped(b).translation() - mapped(a).translation();
      if (std::min(by_survey.norm(), by_map.norm()) < kMinApart_m) continue;
      has_map_frame_ = true;
      const Se2 turn{0.0, 0.0,
                     std::atan2(by_survey.y(), by_survey.x()) - std::atan2(by_map.y(), by_map.x())};
      const Eigen::Vector2d middle = 0.5 * (mapped(a).translation() + mapped(b).translation());
      const Eigen::Vector2d surveyed = a.marker.survey_from_marker.translation() + 0.5 * by_survey;
      return Se2{surveyed - turn * middle, turn.theta()};
    }
  }
  return std::nullopt;
}

void Survey::add_priors(Graph& graph) {
  for (Entry& entry : entries_) {
    if (!entry.landmark || entry.has_prior) continue;
    entry.has_prior = true;
    if (graph.has_prior(*entry.landmark)) continue;  // one that is off
    graph.add(prior_of(entry.marker, *entry.landmark));
    entry.is_prior_on = true;
  }
}

bool Survey::apply(Graph& graph) {
  add_priors(graph);
  std::vector<Entry*> entries;
  std::vector<std::size_t> landmarks;
  std::vector<LandmarkPrior> priors;  // all on: tested again, with the new measurements
  for (Entry& entry : entries_) {
    if (!entry.has_prior) continue;
    priors.push_back(prior_of(entry.marker, landmarks.size()));
    landmarks.push_back(*entry.landmark);
    entries.push_back(&entry);
  }
  auto marginal = graph.marginal_of(landmarks);
  if (!marginal) return false;
  unresolved_sigmas_ = std::sqrt(switch_wrong_off(priors, SurveyModel{std::move(*marginal)}));
  bool has_switched = false;
  for (std::size_t i = 0; i < priors.size(); ++i) {
    const bool is_on = !priors[i].is_off;
    if (std::exchange(entries[i]->is_prior_on, is_on) == is_on) continue;
    graph.switch_prior(landmarks[i], is_on);
    has_switched = true;
  }
  return has_switched;
}

double Survey::sigmas_off(const Entry& entry, const Graph& graph) const {
  const LandmarkPrior prior = prior_of(entry.marker, *entry.landmark);
  return prior.linearise(graph.state()).residual.norm();
}

std::vector<MapChange> Survey::changes(const Graph& graph) const {
  std::vector<MapChange> changes;
  for (const Entry& entry : entries_) {
    if (!entry.has_prior) continue;
    const double sigmas =
        std::max(sigmas_off(entry, graph), entry.is_prior_on ? unresolved_sigmas_ : 0.0);
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
