// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/landmark/sighting_sigmas.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr double kWider = 5.0;

}  // namespace

SightingSigmas SightingSigmas::doubted(Eigen::Index error) const {
  const SightingSigmas usual;
  SightingSigmas wider;
  wider.learnt = (learnt.array() > 0.0).select(learnt.cwiseMax(usual.learnt), learnt);
  if (wider.learnt[error] <= learnt[error]) wider.learnt[error] = kWider * learnt[error];
  wider.bearing_rad = std::max(bearing_rad, usual.bearing_rad);
  wider.position_m = std::max(position_m, usual.position_m);
  wider.bulge_m = std::max(bulge_m, usual.bulge_m);
  wider.skew_rad = std::max(skew_rad, usual.skew_rad);
  return wider;
}

}  // namespace waymark
