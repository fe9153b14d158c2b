// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/keyframe_thinning.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr double kPlace_m = 1.0;
constexpr std::size_t kLookEvery = 100;      // keyframes, since each look goes through all factors
constexpr std::size_t kLeastTies = 10;       // constraints of an end, since some may be wrong
constexpr std::size_t kLeastSightings = 20;  // of a marker by needed keyframes, to be well mapped
constexpr double kLeastInformation = 10.0;   // of a loop, as 1 / sigma: 0.1 m and 0.1 rad

bool shows_all_axes(const ScanFactor& loop) {
  return loop.root_information.rowwise().norm().minCoeff() > kLeastInformation;
}

}  // namespace

KeyframeThinning::Place KeyframeThinning::place_of(const Se2& map_from_base) {
  constexpr double kQuarter = 0.5 * std::numbers::pi;
  return {static_cast<int>(std::lround(map_from_base.x() / kPlace_m)),
          static_cast<int>(std::lround(map_from_base.y() / kPlace_m)),
          static_cast<int>(std::lround(map_from_base.theta() / kQuarter) + 4) % 4};
}

std::vector<RemovedKeyframe> KeyframeThinning::surplus(const Graph& graph) {
  const std::size_t behind = graph.first_active_keyframe();
  if (behind < assessments_.size() + kLookEvery) return {};
  for (const Ties& ties : ties_of_new(graph))
    assessments_.push_back(assess(assessments_.size(), ties, graph.state()));
  std::vector<RemovedKeyframe> surplus;
  for (std::size_t begin = open_run_, end = begin; end < behind; begin = end) {
    while (begin < behind && assessments_[begin].is_needed)
      ++begin;
    end = begin;
    while (end < behind && !assessments_[end].is_needed)
      ++end;
    add_surplus(begin, end, graph, surplus);
    open_run_ = begin;
  }
  return surplus;
}

/// Constraints of the keyframes that have left the window since the last look.
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
      if (here == nullptr || !scan->is_loop || !shows_all_axes(*scan)) continue;
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
  std::vector<std::size_t>& there = needed_[place_of(map_from_base)];
  assessment.is_needed = there.size() < per_place_;
  for (const std::size_t landmark : ties.landmarks) {
    const auto [seen, is_new] = sightings_.try_emplace(landmark, Sightings{keyframe, 0});
    assessment.tied_to = std::min(assessment.tied_to, seen->second.first_keyframe);
    assessment.is_needed |= seen->second.needed < kLeastSightings;
  }
  if (assessment.is_needed) {
    there.push_back(keyframe);
    for (const std::size_t landmark : ties.landmarks)
      ++sightings_.at(landmark).needed;
    return assessment;
  }
  assessment.carrier = *std::min_element(there.begin(), there.end(), [&](auto a, auto b) {
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
    if (ties >= kLeastTies && k + 1 - begin >= least_end_) return k + 1;
  }
  return end;
}

/// First keyframe of a run's tail; the tail stays. `begin`: the whole run has to stay.
std::size_t KeyframeThinning::begin_of_tail(std::size_t begin, std::size_t end,
                                            const Graph& graph) const {
  std::size_t ties = 0;
  for (std::size_t k = end; k-- > begin && !graph.is_removed(k);) {
    ties += assessments_[k].tied_to < begin;
    if (ties >= kLeastTies && end - k >= least_end_) return k;
  }
  return begin;
}

void KeyframeThinning::add_surplus(std::size_t begin, std::size_t end, const Graph& graph,
                                   std::vector<RemovedKeyframe>& surplus) const {
  const std::size_t tail = begin_of_tail(begin, end, graph);
  for (std::size_t k = end_of_head(begin, end); k < tail; ++k)
    if (!graph.is_removed(k)) surplus.push_back({k, assessments_[k].carrier});
}

}  // namespace waymark
