// SPDX-License-Identifier: BSD-3-Clause
// Finds where the recording computer's clock was set during a recording: all stamps from there on
// are shifted against those before.
#pragma once

#include "common/time/time.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace waymark {

/// The clock was set just before stamp `index`: adding `shift` to the stamps from there on makes
/// them continue those before at the usual period.
struct ClockSeam {
  std::size_t index{0};
  Duration shift{0};
};

/// Steps back by more than kSmallDisorder, or ahead by more than kLongestLog, with ten stamps in
/// order before the step and ten after it. With fewer, single stamps are wrong, not the clock.
/// O(n).
/// @param stamps  in the order of the file
std::vector<ClockSeam> find_clock_seams(std::span<const Timestamp> stamps);

/// Whether the pieces between the seams are one recording in the wrong order (files concatenated in
/// the wrong order): sorted by time they do not overlap, and each begins within ten seconds after
/// the end of the one before.
bool are_pieces_in_disorder(std::span<const Timestamp> stamps, std::span<const ClockSeam> seams);

/// Correction to add to each stamp. The longest piece keeps its stamps, unless stamps of other
/// pieces would then become negative.
std::vector<Duration> corrections(std::span<const Timestamp> stamps,
                                  std::span<const ClockSeam> seams);

}  // namespace waymark
