// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/motion/speed_limits.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark {
namespace {

constexpr double kSlowest = 0.01;  // [m/s, rad/s]; less is standing
constexpr double kBinRatio = 1.1;  // upper / lower edge of a speed bin; 80 bins reach 20 m/s
constexpr double kUsualShare = 0.95;
constexpr double kFaster = 2.0;  // factor on the usual speed, to which these margins are added:
constexpr double kSlack_m_s = 0.5;
constexpr double kSlack_rad_s = 1.0;
// Floor robots accelerate less (TurtleBot3: top speed 0.26 m/s).
constexpr double kMaxAcceleration_m_s2 = 1.0;
constexpr double kMaxAcceleration_rad_s2 = 2.0;
constexpr double kNewStep = 0.05;  // weight of the newest step in the mean duration
constexpr int kMinSteps = 20;      // driving plus turning samples before any step is rejected
constexpr int kMaxRefused = 20;    // in a row, before the histograms are reset

}  // namespace

void SpeedLimits::Usual::add(double speed) {
  if (speed < kSlowest) return;
  const auto bin = static_cast<std::size_t>(std::log(speed / kSlowest) / std::log(kBinRatio));
  ++counts_[std::min(bin, kBins - 1)];
  ++count_;
}

double SpeedLimits::Usual::high() const {
  int below = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    below += counts_[bin];
    if (below > kUsualShare * count_)
      return kSlowest * std::pow(kBinRatio, static_cast<double>(bin) + 1.0);
  }
  return 0.0;
}

bool SpeedLimits::allow(const Motion& step, double step_s) {
  if (step_s <= 0.0) return true;
  // Messages may be stamped in bursts: the speed over a very short step is meaningless.
  mean_step_s_ = mean_step_s_ == 0.0 ? step_s : mean_step_s_ + kNewStep * (step_s - mean_step_s_);
  // After a step that took longer than usual, this one may include part of its motion.
  const double left_over_s = std::max(0.0, std::exchange(last_step_s_, step_s) - mean_step_s_);
  const double lasted_s = std::max(step_s, mean_step_s_) + left_over_s;
  const double drive_m_s = step.distance_m / lasted_s;
  const double turn_rad_s = step.turn_rad / lasted_s;
  const bool is_known = drives_.count() + turns_.count() >= kMinSteps;
  const double most_m_s =
      std::max(kFaster * drives_.high() + kSlack_m_s, drive_m_s_ + kMaxAcceleration_m_s2 * step_s);
  const double most_rad_s = std::max(kFaster * turns_.high() + kSlack_rad_s,
                                     turn_rad_s_ + kMaxAcceleration_rad_s2 * step_s);
  if (is_known && (drive_m_s > most_m_s || turn_rad_s > most_rad_s)) {
    if (++refused_in_a_row_ <= kMaxRefused) return false;
    drives_ = {};
    turns_ = {};
  }
  refused_in_a_row_ = 0;
  drive_m_s_ = drive_m_s;
  turn_rad_s_ = turn_rad_s;
  drives_.add(drive_m_s);
  turns_.add(turn_rad_s);
  return true;
}

}  // namespace waymark
