// SPDX-License-Identifier: BSD-3-Clause
// Which markers a belief knows: how they come, rest, move and go.
#include "slam/core/belief/belief.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr int kTurnedUp = 3;  // sightings of the one that it may have become

}  // namespace

void Belief::augment(const Landmark& landmark, const Columns& with_all,
                     const Eigen::Matrix3d& own) {
  const Eigen::Index size = covariance_.rows();
  covariance_.conservativeResize(size + 3, size + 3);
  covariance_.topRightCorner(size, 3) = with_all;
  covariance_.bottomLeftCorner(3, size) = with_all.transpose();
  covariance_.bottomRightCorner<3, 3>() = own;
  active_.push_back(landmark);
}

/// @return its place among the active ones.
std::size_t Belief::revive(std::size_t settled_marker) {
  std::vector<Landmark>& settled = settled_.edit();
  const Landmark revived = settled[settled_marker];
  settled.erase(settled.begin() + static_cast<std::ptrdiff_t>(settled_marker));
  augment(revived, Columns::Zero(covariance_.rows(), 3), revived.covariance);
  return active_.size() - 1;
}

void Belief::settle_oldest(std::size_t limit) {
  while (active_.size() > limit) {
    const auto oldest = std::min_element(
        active_.begin(), active_.end(),
        [](const Landmark& a, const Landmark& b) { return a.last_seen < b.last_seen; });
    settle(static_cast<std::size_t>(oldest - active_.begin()));
  }
}

void Belief::settle(std::size_t marker) {
  const Eigen::Index place = place_of(marker);
  Landmark settled = active_[marker];
  settled.covariance = covariance_.block<3, 3>(place, place);
  settled_.edit().push_back(settled);
  remove_active(marker);
}

void Belief::remove_active(std::size_t marker) {
  const Eigen::Index place = place_of(marker);
  active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(marker));
  const Eigen::Index behind = covariance_.rows() - place - 3;
  covariance_.middleRows(place, behind) = covariance_.bottomRows(behind).eval();
  covariance_.middleCols(place, behind) = covariance_.rightCols(behind).eval();
  covariance_.conservativeResize(covariance_.rows() - 3, covariance_.cols() - 3);
}

void Belief::forget_since(Timestamp time) {
  const auto is_new = [time](const Landmark& marker) {
    return marker.first_seen > time;
  };
  for (std::size_t i = active_.size(); i-- > 0;)
    if (is_new(active_[i])) remove_active(i);
  if (std::ranges::any_of(settled(), is_new)) std::erase_if(settled_.edit(), is_new);
}

Landmark& Belief::editable(std::size_t index) {
  return index < active_.size() ? active_[index] : settled_.edit()[index - active_.size()];
}

void Belief::note_absences(const std::function<bool(const Se2&)>& is_in_view, Timestamp now) {
  const Se2 base_from_map = map_from_base_.inverse();
  for (std::size_t i = 0; i < num_markers(); ++i) {
    if (marker(i).last_seen < now && is_in_view(base_from_map * marker(i).map_from_marker))
      ++editable(i).misses;
  }
  forget_moved();
}

void Belief::forget_moved() {
  for (std::size_t i = 0; i < num_markers(); ++i) {
    if (!marker(i).is_missed()) continue;
    for (std::size_t k = 0; k < num_markers(); ++k) {
      const Landmark& other = marker(k);
      if (k == i || other.id != marker(i).id || other.first_seen <= marker(i).last_seen ||
          other.sightings < kTurnedUp) {
        continue;
      }
      editable(k).instance = marker(i).instance;
      editable(k).was_moved = marker(i).is_confirmed();
      if (i < active_.size()) {
        remove_active(i);
      } else {
        std::vector<Landmark>& settled = settled_.edit();
        settled.erase(settled.begin() + static_cast<std::ptrdiff_t>(i - active_.size()));
      }
      return;  // the others come with the next update
    }
  }
}

std::vector<Landmark> Belief::markers() const {
  std::vector<Landmark> markers = settled();
  for (std::size_t i = 0; i < active_.size(); ++i) {
    markers.push_back(active_[i]);
    markers.back().covariance = covariance_.block<3, 3>(place_of(i), place_of(i));
  }
  std::stable_sort(markers.begin(), markers.end(), [](const Landmark& a, const Landmark& b) {
    return a.first_seen < b.first_seen;
  });
  return markers;
}

}  // namespace waymark
