// SPDX-License-Identifier: BSD-3-Clause
// The range that a LiDAR's driver writes when nothing returns.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <span>

namespace waymark {

/// How often each range occurs, in centimetres: fine enough for any LiDAR's codes.
class RangeHistogram {
 public:
  void add(std::span<const double> ranges_m);

  struct Code {
    double range_m{0.0};      ///< the smallest one of its pile
    std::int64_t count{0};    ///< of this and of all longer ranges
    double share{0.0};        ///< of all ranges
  };

  /// Smallest of the codes within a metre of the longest range (a SICK has several, from 81.83 m
  /// on): a range that occurs at least twenty times, and twenty times as often as those within 3 cm
  /// of it. A wall, even before a standing robot, is spread by its noise; a code is not.
  std::optional<Code> no_return_code() const;

 private:
  struct Bin {
    std::int64_t count{0};
    double smallest_m{0.0};
  };

  std::map<std::int64_t, Bin> bins_{};  ///< by centimetres
  std::int64_t total_{0};
};

}  // namespace waymark
