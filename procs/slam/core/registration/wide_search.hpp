// SPDX-License-Identifier: BSD-3-Clause
// Registration of a scan whose guess may be off by more than plain matching can find.
#pragma once

#include "slam/core/registration/scan_match.hpp"
#include "slam/core/registration/usual_fit.hpp"

#include <span>

namespace waymark {

/// The best of a plain match and of matches that begin at the best places in wide windows about
/// `guesses`. The plain match is left only if the map contradicts it, or for a place where the scan
/// fits as well as others do: a view of a new place has few inliers where it is right.
///
/// @param points     ends of beams, base frame.
/// @param surfaces   what the scan is matched with,
/// @param occupied   and its points around the guesses.
/// @param guesses    map_from_base.
/// @param min_score  of a place (SearchMatch).
ScanMatch searched_widely(const ScanMatch& plain, const Points& points, const NdtMap& surfaces,
                          const Points& occupied, std::span<const Se2> guesses,
                          const UsualFit& usual, const RangeNoise& noise,
                          const ScanMatchConfig& config, double min_score);

/// That `occupied` has to reach from the guesses on, for a scan of these points.
double wide_search_reach_m(const Points& points);

}  // namespace waymark
