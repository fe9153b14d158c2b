// SPDX-License-Identifier: BSD-3-Clause
#include "import/log/clock_seams.hpp"

#include "common/geometry/median.hpp"
#include "import/log/time_order.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr std::size_t kConsistent = 10;  // consistent stamps before and after a seam
constexpr Duration kBesideEachOther = std::chrono::seconds{10};

using Stamps = std::span<const Timestamp>;

bool ascend(Stamps stamps) {
  return stamps.back() > stamps.front() &&
         std::ranges::adjacent_find(stamps, [](Timestamp before, Timestamp now) {
           return now < before - kSmallDisorder || now > before + kLongestLog;
         }) == stamps.end();
}

/// Stamps between two seams: [begin, end).
struct Piece {
  std::size_t begin{0};
  std::size_t end{0};
};

std::vector<Piece> pieces_of(Stamps stamps, std::span<const ClockSeam> seams) {
  std::vector<Piece> pieces{{0, stamps.size()}};
  for (const ClockSeam& seam : seams) {
    pieces.back().end = seam.index;
    pieces.push_back({seam.index, stamps.size()});
  }
  return pieces;
}

Duration usual_period(Stamps before, Stamps behind) {
  std::vector<Duration> periods;
  for (const Stamps stamps : {before, behind})
    for (std::size_t i = 1; i < stamps.size(); ++i)
      periods.push_back(std::max(Duration{1}, stamps[i] - stamps[i - 1]));
  return upper_median(std::move(periods));
}

}  // namespace

std::vector<ClockSeam> find_clock_seams(Stamps stamps) {
  std::vector<ClockSeam> seams;
  for (std::size_t i = kConsistent; i + kConsistent <= stamps.size(); ++i) {
    const bool steps =
        stamps[i] < stamps[i - 1] - kSmallDisorder || stamps[i] > stamps[i - 1] + kLongestLog;
    if (!steps) continue;
    const Stamps before = stamps.subspan(i - kConsistent, kConsistent);
    const Stamps behind = stamps.subspan(i, kConsistent);
    if (!ascend(before) || !ascend(behind)) continue;
    const bool is_set = std::ranges::max(behind) < std::ranges::min(before) ||
                        std::ranges::min(behind) > std::ranges::max(before) + kLongestLog;
    if (is_set) seams.push_back({i, stamps[i - 1] + usual_period(before, behind) - stamps[i]});
  }
  return seams;
}

bool are_pieces_in_disorder(Stamps stamps, std::span<const ClockSeam> seams) {
  if (seams.empty()) return false;
  std::vector<Piece> pieces = pieces_of(stamps, seams);
  std::ranges::sort(pieces, {}, [&](const Piece& piece) { return stamps[piece.begin]; });
  for (std::size_t i = 1; i < pieces.size(); ++i) {
    const Duration gap = stamps[pieces[i].begin] - stamps[pieces[i - 1].end - 1];
    if (gap < Duration::zero() || gap > kBesideEachOther) return false;
  }
  return true;
}

std::vector<Duration> corrections(Stamps stamps, std::span<const ClockSeam> seams) {
  std::vector<Duration> shifts(stamps.size(), Duration::zero());
  Duration sum{0};
  Duration of_longest{0};
  std::size_t longest = 0;
  const std::vector<Piece> pieces = pieces_of(stamps, seams);
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    if (i > 0) sum += seams[i - 1].shift;
    std::fill(shifts.begin() + static_cast<std::ptrdiff_t>(pieces[i].begin),
              shifts.begin() + static_cast<std::ptrdiff_t>(pieces[i].end), sum);
    if (pieces[i].end - pieces[i].begin <= longest) continue;
    longest = pieces[i].end - pieces[i].begin;
    of_longest = sum;
  }
  const auto is_before_0 = [&](std::size_t i) {
    return stamps[i] + shifts[i] - of_longest < Timestamp{};
  };
  for (const Piece& piece : pieces)
    if (is_before_0(piece.begin)) return shifts;
  for (Duration& shift : shifts)
    shift -= of_longest;
  return shifts;
}

}  // namespace waymark
