// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/keyframe_thinning.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr double kPlace_m = 1.0;
constexpr std::size_t kAssessedEvery = 100;  // keyframes, since it goes through all factors
// Keyframes in the head (and in the tail) of a run that are tied to keyframes before the run; some
// ties may be wrong.
constexpr std::size_t kMinTies = 10;
constexpr std::size_t kMinSightings = 20;  // kept keyframes that see a well mapped marker
constexpr double kMinInformation = 10.0;   // [1/m, 1/rad] 1 / sigma of a loop along each axis

bool observes_all_axes(const ScanFactor& loop) {
  return loop.root_information.rowwise().norm().minCoeff() > kMinInformation;
}

}  // namespace

KeyframeThinning::Place KeyframeThinning::place_of(const Se2& map_from_base) {
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  return {static_cast<int>(std::lround(map_from_base.x() / kPlace_m)),
          static_cast<int>(std::lround(map_from_base.y() / kPlace_m)),
          static_cast<int>(std::lround(map_from_base.theta() / kQuarter) + 4) % 4};
}

std::vector<RemovedKeyframe> KeyframeThinning::removable(const Graph& graph) {
  const std::size_t num_outside = graph.first_active_keyframe();
  if (num_outside < assessments_.size() + kAssessedEvery) return {};
  for (const Ties& ties : ties_of_new(graph))
    assessments_.push_back(assess(assessments_.size(), ties, graph.state()));
  std::vector<RemovedKeyframe> removable;
  for (std::size_t begin = open_run_, end = begin; end < num_outside; begin = end) {
    while (begin < num_outside && !assessments_[begin].is_redundant)
      ++begin;
    end = begin;
    while (end < num_outside && assessments_[end].is_redundant)
      ++end;
    add_removable(begin, end, graph, removable);
    open_run_ = begin;
  }
  return removable;
}

/// Constraints of the keyframes that have left the window since the last assessment.
std::vector<KeyframeThinning::Ties> KeyframeThinning::ties_of_new(const Graph& graph) const {
  const std::size_t first = assessments_.size();
  std::vector<Ties> ties(graph.first_active_keyframe() - first);
  for (std::size_t i = 0; i < ties.size(); ++i)
    ties[i].oldest = first + i;
  const auto of = [&](std::size_t keyframe) -> Ties* {
    return keyframe >= first && keyframe - first < ties.size() ? &ties[keyframe - first] : nullptr;
  };
  for (const Factor& factor : graph.factors()) {
    if (const auto* marker = std::get_if<MarkerFactor>(&factor)) {
      if (Ties* here = of(marker->keyframe)) here->landmarks.push_back(marker->landmark);
    } else if (const auto* prior = std::get_if<PosePrior>(&factor)) {
      if (Ties* here = of(prior->keyframe)) here->oldest = 0;
    } else if (const auto* scan = std::get_if<ScanFactor>(&factor)) {
      Ties* here = of(scan->keyframe);
      if (here == nullptr || !scan->is_loop || !observes_all_axes(*scan)) continue;
      for (const ScanFactor::Reference& reference : scan->references)
        here->oldest = std::min(here->oldest, reference.keyframe);
    }
  }
  return ties;
}

KeyframeThinning::Assessment KeyframeThinning::assess(std::size_t keyframe, const Ties& ties,
                                                      const State& state) {
  Assessment assessment{false, 0, ties.oldest};
  const Se2& map_from_base = state.keyframes[keyframe];
  std::vector<std::size_t>& there = kept_[place_of(map_from_base)];
  bool is_kept = there.size() < per_place_;
  for (const std::size_t landmark : ties.landmarks) {
    const auto [seen, is_new] = sightings_.try_emplace(landmark, Sightings{keyframe, 0});
    assessment.tied_to = std::min(assessment.tied_to, seen->second.first_keyframe);
    is_kept |= seen->second.kept < kMinSightings;
  }
  if (is_kept) {
    there.push_back(keyframe);
    for (const std::size_t landmark : ties.landmarks)
      ++sightings_.at(landmark).kept;
    return assessment;
  }
  assessment.is_redundant = true;
  assessment.anchor = *std::min_element(there.begin(), there.end(), [&](auto a, auto b) {
    const auto away_m = [&](std::size_t other) {
      return (state.keyframes[other].translation() - map_from_base.translation()).norm();
    };
    return away_m(a) < away_m(b);
  });
  return assessment;
}

/// One past the last keyframe of a run's head; the head stays. `end`: the whole run has to stay.
std::size_t KeyframeThinning::end_of_head(std::size_t begin, std::size_t end) const {
  std::size_t ties = 0;
  for (std::size_t k = begin; k < end; ++k) {
    ties += assessments_[k].tied_to < begin;
    if (ties >= kMinTies && k + 1 - begin >= min_end_) return k + 1;
  }
  return end;
}

/// First keyframe of a run's tail; the tail stays. `begin`: the whole run has to stay.
std::size_t KeyframeThinning::begin_of_tail(std::size_t begin, std::size_t end,
                                            const Graph& graph) const {
  std::size_t ties = 0;
  for (std::size_t k = end; k-- > begin && !graph.is_removed(k);) {
    ties += assessments_[k].tied_to < begin;
    if (ties >= kMinTies && end - k >= min_end_) return k;
  }
  return begin;
}

void KeyframeThinning::add_removable(std::size_t begin, std::size_t end, const Graph& graph,
                                     std::vector<RemovedKeyframe>& removable) const {
  const std::size_t tail = begin_of_tail(begin, end, graph);
  for (std::size_t k = end_of_head(begin, end); k < tail; ++k)
    if (!graph.is_removed(k)) removable.push_back({k, assessments_[k].anchor});
}

}  // namespace waymark
