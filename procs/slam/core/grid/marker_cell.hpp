// SPDX-License-Identifier: BSD-3-Clause
// The camera's observations of a cell: votes for marker ids, and for no marker.
#pragma once

#include "common/sensors/sensors.hpp"

#include <algorithm>
#include <array>

namespace waymark {

/// Votes for the ids seen on a cell, so that a wrong id does not overwrite a correct one. Keeps the
/// best few ids; a vote for another one reduces the weakest and finally replaces it (after Misra
/// and Gries, 1982), so that a frequent id is always kept. Votes may be fractions.
struct MarkerCell {
  static constexpr int kMaxIds = 3;

  struct Votes {
    int id{kNoMarker};
    float count{0.0F};

    bool operator==(const Votes&) const = default;
  };

  std::array<Votes, kMaxIds> ids{};  ///< unused entries have kNoMarker and no votes
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

  /// All votes, "none" included; 0: unknown.
  float votes() const { return none + votes_for_markers(); }

  /// The id with the most votes if it has more than "none", else kNoMarker; the first of equals.
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
