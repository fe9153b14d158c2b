// SPDX-License-Identifier: BSD-3-Clause
// exp(-d^2 / width) up to a limit, then 0, from a table: the matcher needs a million per scan.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace waymark {

/// Linear interpolation in 1024 equal steps of d^2. Without rounding its error is below
/// (limit / width)^2 / 8e6, 2e-8 for GMapping's defaults; single precision adds up to 1e-7.
/// Benchmark: tests/benchmark/gmapping_speed.cpp.
class BellCurve {
 public:
  /// @param width_squared  `width` above, e.g. [cells^2].
  /// @param limit          of d^2, same unit; from here on the curve is 0.
  BellCurve(double width_squared, double limit)
      : steps_per_unit_{static_cast<float>(kSteps / limit)} {
    const double step = limit / kSteps / width_squared;
    for (std::size_t i = 0; i < kSteps; ++i) {
      const double here = std::exp(-step * static_cast<double>(i));
      const double next = std::exp(-step * static_cast<double>(i + 1));
      pieces_[i] = {static_cast<float>(here), static_cast<float>(next - here)};
    }
  }

  /// @param squared  d^2, not negative; may be infinite.
  float operator()(float squared) const {
    const float position = std::min(squared * steps_per_unit_, static_cast<float>(kSteps));
    const int index = static_cast<int>(position);
    const Piece piece = pieces_[static_cast<std::size_t>(index)];
    return piece.start + piece.rise * (position - static_cast<float>(index));
  }

 private:
  static constexpr std::size_t kSteps = 1024;

  struct Piece {
    float start;
    float rise;
  };

  std::array<Piece, kSteps + 1> pieces_{};  ///< the last one is 0
  float steps_per_unit_;
};

}  // namespace waymark
