// SPDX-License-Identifier: BSD-3-Clause
#include "common/random/random.hpp"

#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15ULL;

std::uint64_t mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

}  // namespace

Random::Random(std::initializer_list<std::uint64_t> key) : state_{kGoldenGamma} {
  for (const std::uint64_t part : key)
    state_ = mix(state_ + kGoldenGamma + mix(part + kGoldenGamma));
}

Random::result_type Random::operator()() {
  state_ += kGoldenGamma;
  return mix(state_);
}

double Random::uniform() {
  return static_cast<double>((*this)() >> 11) * 0x1.0p-53;
}

double Random::uniform(double low, double high) {
  return low + (high - low) * uniform();
}

double Random::normal() {
  // Box-Muller; std::normal_distribution is not the same on every standard library.
  if (has_spare_normal_) {
    has_spare_normal_ = false;
    return spare_normal_;
  }
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  const double angle = 2.0 * std::numbers::pi * uniform();
  spare_normal_ = radius * std::sin(angle);
  has_spare_normal_ = true;
  return radius * std::cos(angle);
}

double Random::normal(double mean, double standard_deviation) {
  return mean + standard_deviation * normal();
}

}  // namespace waymark
