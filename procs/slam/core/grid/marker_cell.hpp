// SPDX-License-Identifier: BSD-3-Clause
// What the camera says about a cell of a wall: which marker it carries, or that it carries none.
#pragma once

#include "common/sensors/sensors.hpp"

#include <algorithm>
#include <array>

namespace waymark {

/// Votes for the ids seen on a cell, so that a wrong id does not overwrite a right one. Keeps the
/// best few ids; an id that finds no place wears down the weakest one (Misra and Gries, 1982), so a
/// frequent id always gets in. Votes may be fractions.
struct MarkerCell {
  static constexpr int kMaxIds = 3;

  struct Votes {
    int id{kNoMarker};
    float count{0.0F};

    bool operator==(const Votes&) const = default;
  };

  std::array<Votes, kMaxIds> ids{};  ///< unused places have kNoMarker and no votes
  float none{0.0F};                  ///< votes for "the camera saw this spot and no marker on it"

  void vote(int id, float votes) {
    if (id == kNoMarker) {
      none += votes;
      return;
    }
    for (Votes& known : ids) {
      if (known.id == id || known.id == kNoMarker) {
        known.id = id;
        known.count += votes;
        return;
      }
    }
    Votes& weakest = *std::min_element(
        ids.begin(), ids.end(), [](const Votes& a, const Votes& b) { return a.count < b.count; });
    weakest.count -= votes;
    if (weakest.count < 0.0F) weakest = {id, -weakest.count};
  }

  float votes_for(int id) const {
    if (id == kNoMarker) return none;
    for (const Votes& known : ids) {
      if (known.id == id) return known.count;
    }
    return 0.0F;
  }

  float votes_for_markers() const {
    float sum = 0.0F;
    for (const Votes& known : ids)
      sum += known.count;
    return sum;
  }

  /// Votes that the camera has cast here at all; 0 = nothing is known.
  float votes() const { return none + votes_for_markers(); }

  /// The id with most votes if it has more than "none", else kNoMarker; the first of equals.
  int most_supported() const {
    Votes best{kNoMarker, none};
    for (const Votes& known : ids) {
      if (known.count > best.count) best = known;
    }
    return best.id;
  }

  bool operator==(const MarkerCell&) const = default;
};

}  // namespace waymark
