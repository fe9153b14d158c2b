// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/submaps.hpp"

#include <utility>

namespace waymark {
const Submap* Submaps::find(std::size_t first_keyframe) const {
  const auto found = std::find_if(
      finished_.begin(), finished_.end(),
      [first_keyframe](const Submap& submap) { return submap.first_keyframe() == first_keyframe; });
  return found == finished_.end() ? nullptr : &*found;
}

void Submaps::add_keyframe(const Points& points_in_base, const PoseSequence& keyframes,
                           double point_variance_m2) {
  if (growing_.empty() || growing_.back().num_keyframes() >= half_keyframes_ ||
      growing_.back().path_length_m() >= half_m_) {
    if (growing_.size() > 1) {
      finished_.push_back(std::move(growing_.front()));
      finished_.back().finish(point_variance_m2);
      growing_.pop_front();
    }
    growing_.emplace_back(cell_spacing_m_, keyframes.size() - 1);
  }
  for (Submap& submap : growing_)
    submap.insert(points_in_base, submap.submap_from_map(keyframes) * keyframes.back());
}

void Submaps::add_between(const Points& points_in_base, const Se2& map_from_base,
                          const PoseSequence& keyframes) {
  for (Submap& submap : growing_)
    submap.add(points_in_base, submap.submap_from_map(keyframes) * map_from_base);
}

void Submaps::rebuild_deformed(const PoseSequence& keyframes) {
  for (Submap& submap : growing_)
    if (submap.is_deformed(keyframes)) submap = submap.rebuilt(keyframes);
}

void Submaps::forget(const std::function<bool(std::size_t)>& is_removed) {
  std::erase_if(finished_, [&is_removed](const Submap& submap) {
    for (std::size_t k = submap.first_keyframe(); k <= submap.last_keyframe(); ++k)
      if (is_removed(k)) return true;
    return false;
  });
}

}  // namespace waymark
