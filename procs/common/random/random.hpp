// SPDX-License-Identifier: BSD-3-Clause
// Random numbers that depend on a key only, not on earlier draws elsewhere.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <limits>

namespace waymark {

/// A generator that is determined by a key, e.g. {seed, stream, step, particle}. With a generator
/// of its own for every particle and step, results do not depend on the order or the thread of the
/// draws. Meets UniformRandomBitGenerator. Source: Steele, Lea, Flood, "Fast splittable
/// pseudorandom number generators" (2014), SplitMix64.
class Random {
 public:
  using result_type = std::uint64_t;

  explicit Random(std::initializer_list<std::uint64_t> key);

  static constexpr result_type min() { return 0; }

  static constexpr result_type max() { return std::numeric_limits<result_type>::max(); }

  result_type operator()();

  /// Uniform in [0, 1), 53 random bits.
  double uniform();
  /// Uniform in [low, high).
  double uniform(double low, double high);
  /// Standard normal.
  double normal();
  double normal(double mean, double standard_deviation);

 private:
  std::uint64_t state_;
  double spare_normal_{0.0};
  bool has_spare_normal_{false};
};

}  // namespace waymark
