// SPDX-License-Identifier: BSD-3-Clause
// Where the clock was set while a log was recorded: from there on all its stamps are off.
#pragma once

#include "common/time/time.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace waymark {

/// The stamps from `index` on have to be this much later to go on from those before, at the usual
/// period.
struct ClockSeam {
  std::size_t index{0};
  Duration late{0};
};

/// Steps back by more than kSmallDisorder, or ahead by more than a month, that ten stamps in order
/// before and ten behind agree on: with fewer it is those that are wrong, not the clock. O(n).
/// @param stamps  in the order of the file
std::vector<ClockSeam> find_clock_seams(std::span<const Timestamp> stamps);

/// Whether the pieces between the seams are those of one recording in another order (files that
/// were put together the wrong way round): sorted by time they do not overlap, and each begins
/// within ten seconds of the end of the one before.
bool are_pieces_in_disorder(std::span<const Timestamp> stamps, std::span<const ClockSeam> seams);

/// By how much each stamp has to be later. The longest piece keeps its stamps, unless some would be
/// before 0.
std::vector<Duration> corrections(std::span<const Timestamp> stamps,
                                  std::span<const ClockSeam> seams);

}  // namespace waymark
