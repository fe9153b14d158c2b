// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/landmark/sighting_sigmas.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kSurprise = 5.0;  // standard deviations
constexpr double kLearnt = 1e-12;  // variance; less is rounding

}  // namespace

std::optional<SightingSigmas> SightingSigmas::doubted_by(const Eigen::Vector3d& found,
                                                         const Eigen::Vector3d& variances,
                                                         const Eigen::Vector3d& scatter) const {
  for (Eigen::Index error = 0; error < learnt.size(); ++error) {
    const double prior = learnt[error] * learnt[error];
    const double lost = std::max(prior - variances[error], kLearnt);
    if (found[error] * found[error] <= kSurprise * kSurprise * (lost + scatter[error])) continue;
    SightingSigmas wider = no_better_than_usual();
    wider.learnt[error] = std::max(wider.learnt[error], std::abs(found[error]) * prior / lost);
    return wider;
  }
  return std::nullopt;
}

SightingSigmas SightingSigmas::no_better_than_usual() const {
  const SightingSigmas usual;
  SightingSigmas wider;
  wider.learnt = (learnt.array() > 0.0).select(learnt.cwiseMax(usual.learnt), learnt);
  wider.bearing_rad = std::max(bearing_rad, usual.bearing_rad);
  wider.position_m = std::max(position_m, usual.position_m);
  wider.bulge_m = std::max(bulge_m, usual.bulge_m);
  wider.skew_rad = std::max(skew_rad, usual.skew_rad);
  return wider;
}

}  // namespace waymark
