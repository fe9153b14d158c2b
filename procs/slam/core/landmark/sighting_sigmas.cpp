// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/landmark/sighting_sigmas.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr double kWider = 5.0;
constexpr double kSurprise = 3.5;  // standard deviations
constexpr double kLearnt = 1e-12;  // variance; less is rounding

}  // namespace

std::optional<Eigen::Index> SightingSigmas::contradicted_by(const Eigen::Vector3d& found,
                                                            const Eigen::Vector3d& variances,
                                                            const Eigen::Vector3d& scatter) const {
  for (Eigen::Index error = 0; error < learnt.size(); ++error) {
    const double lost = std::max(learnt[error] * learnt[error] - variances[error], kLearnt);
    if (found[error] * found[error] > kSurprise * kSurprise * (lost + scatter[error])) return error;
  }
  return std::nullopt;
}

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
