// SPDX-License-Identifier: BSD-3-Clause
// Graph::remove_keyframes().
#include "slam/core/graph/graph.hpp"

#include <algorithm>
#include <utility>

namespace waymark {

/// Drops a scan factor's references to removed keyframes.
/// @return whether the factor still constrains keyframes that stay.
bool Graph::forget_removed(Factor& factor) const {
  const std::vector<Variable> variables = variables_of(factor);
  const auto is_gone = [this](const Variable& variable) {
    return variable.kind == VariableKind::kKeyframe && is_removed(variable.index);
  };
  if (std::none_of(variables.begin(), variables.end(), is_gone)) return true;
  auto* scan = std::get_if<ScanFactor>(&factor);
  if (scan == nullptr || is_removed(scan->keyframe)) return false;
  std::erase_if(scan->references, [this](const ScanFactor::Reference& reference) {
    return is_removed(reference.keyframe);
  });
  return scan->normalise_shares();
}

void Graph::remove_keyframes(const std::vector<RemovedKeyframe>& removed) {
  is_removed_.resize(state_.keyframes.size(), false);
  for (const RemovedKeyframe& gone : removed) {
    is_removed_[gone.keyframe] = true;
    anchored_.push_back(
        {gone, state_.keyframes[gone.anchor].inverse() * state_.keyframes[gone.keyframe]});
  }
  std::vector<bool> is_active_factor(factors_.size(), false);
  for (const std::size_t index : active_factors_)
    is_active_factor[index] = true;
  active_factors_.clear();
  std::vector<Factor> kept;
  kept.reserve(factors_.size());
  for (std::size_t index = 0; index < factors_.size(); ++index) {
    if (!forget_removed(factors_[index])) continue;
    if (is_active_factor[index]) active_factors_.push_back(kept.size());
    kept.push_back(std::move(factors_[index]));
  }
  factors_ = std::move(kept);
  // A disabled odometry factor bridges each gap.
  std::size_t filled = 0;
  for (const RemovedKeyframe& gone : removed) {
    if (gone.keyframe < filled) continue;
    OdometryFactor gap{.from = gone.keyframe, .to = gone.keyframe, .is_disabled = true};
    while (is_removed_[gap.from])
      --gap.from;
    while (is_removed_[gap.to])
      ++gap.to;
    filled = gap.to;
    factors_.emplace_back(gap);
  }
}

void Graph::move_removed() {
  for (const AnchoredKeyframe& anchored : anchored_)
    state_.keyframes[anchored.removed.keyframe] =
        state_.keyframes[anchored.removed.anchor] * anchored.anchor_from_keyframe;
}

}  // namespace waymark
