// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/reversed_odometry.hpp"

#include "import/findings/scan_overlay.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr double kShortestApart_m = 0.01;  // a shorter step is noise
constexpr double kLongestApart_m = 1.0;    // scans further apart overlap too little
constexpr double kLargestMisfit_m = 0.15;  // with a larger misfit, neither direction is right
constexpr double kFloor_m = 1e-4;          // added to misfits: the ratio of two perfect fits is 1
constexpr double kSmallestScore = 0.2;     // smaller scores are noise, as along a wall
constexpr double kLargestScore = 2.0;  // limit for one step: the misfits differ by a factor of 7
// Cost of a change of direction. A reversed sequence has two changes: with the reversed
// motion, its misfits have to be half of those with the motion as counted (ln 2).
constexpr double kChange = 0.5 * std::numbers::ln2;
constexpr double kUsualBraking_m_s2 = 2.0;  // usual deceleration of an indoor robot

struct Step {
  ReversedStep step{};
  double score{0.0};  ///< positive when the reversed motion fits better
};

double score_of(const LidarScan& first, const LidarScan& second, const Se2& motion,
                const Se2& base_from_lidar) {
  const double distance_m = motion.translation().norm();
  if (distance_m < kShortestApart_m || distance_m > kLongestApart_m) return 0.0;
  const auto misfit_with = [&](const Se2& moved) {
    return misfit_m(first, second, base_from_lidar.inverse() * moved * base_from_lidar);
  };
  const auto counted_m = misfit_with(motion);
  const auto reversed_m = misfit_with(Se2{-motion.translation(), motion.theta()});
  if (!counted_m || !reversed_m || std::min(*counted_m, *reversed_m) > kLargestMisfit_m) return 0.0;
  const double score = std::log((*counted_m + kFloor_m) / (*reversed_m + kFloor_m));
  if (std::abs(score) < kSmallestScore) return 0.0;
  return std::clamp(score, -kLargestScore, kLargestScore);
}

std::vector<Step> steps_of(const ImportedLog& log, const BodyBeams& body) {
  std::vector<Step> steps;
  const Se2 base_from_lidar = log.robot.lidar.base_from_lidar();
  LidarScan before = usable(log.scans.front(), body);
  Se2 odom_from_before = pose_at(log.odometry, before.time);
  for (std::size_t i = 1; i < log.scans.size(); ++i) {
    LidarScan now = usable(log.scans[i], body);
    const Se2 odom_from_now = pose_at(log.odometry, now.time);
    const Se2 motion = odom_from_before.inverse() * odom_from_now;
    steps.push_back({{before.time, now.time, motion.translation().norm()},
                     score_of(before, now, motion, base_from_lidar)});
    before = std::move(now);
    odom_from_before = odom_from_now;
  }
  return steps;
}

/// Cost of a change of direction between two steps, with the deceleration that it requires.
double cost_of_change(const ReversedStep& before, const ReversedStep& now) {
  const double seconds = 0.5 * to_seconds(now.until - before.after);
  const double braking_m_s2 = (before.distance_m + now.distance_m) / (seconds * seconds);
  const double relative = braking_m_s2 / kUsualBraking_m_s2;
  return kChange * (1.0 + relative * relative);
}

/// For each step whether it is reversed in the sequence of least cost (Viterbi); O(n).
std::vector<bool> most_likely(const std::vector<Step>& steps) {
  std::vector<std::array<bool, 2>> changed(steps.size());
  std::array<double, 2> cost{0.0, kChange};  // as counted, reversed
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double change = i == 0 ? kChange : cost_of_change(steps[i - 1].step, steps[i].step);
    const std::array<double, 2> stay = cost;
    for (const std::size_t state : {0U, 1U}) {
      changed[i][state] = stay[1 - state] + change < stay[state];
      cost[state] = std::min(stay[state], stay[1 - state] + change);
    }
    cost[0] += std::max(0.0, steps[i].score);
    cost[1] += std::max(0.0, -steps[i].score);
  }
  std::vector<bool> reversed(steps.size(), false);
  std::size_t state = cost[1] < cost[0] ? 1 : 0;
  for (std::size_t i = steps.size(); i-- > 0;) {
    reversed[i] = state == 1;
    if (changed[i][state]) state = 1 - state;
  }
  return reversed;
}

/// Score of drives of 0.4 m along the steps [begin, end), positive if they fit better reversed.
/// Unlike the scores of single steps, it does not depend on somebody who walks by.
double score_of_drives(const ImportedLog& log, const BodyBeams& body, std::size_t begin,
                       std::size_t end) {
  constexpr double kDrive_m = 0.4;
  const Se2 base_from_lidar = log.robot.lidar.base_from_lidar();
  double sum = 0.0;
  for (std::size_t first = begin; first < end;) {
    Se2 motion{};
    std::size_t last = first;
    while (last < end && motion.translation().norm() < kDrive_m) {
      ++last;
      motion = odometry_between(log, first, last);
    }
    sum += score_of(usable(log.scans[first], body), usable(log.scans[last], body), motion,
                    base_from_lidar);
    first = last;
  }
  return sum;
}

/// True if the drives of all reversed sequences together fit twice as well reversed.
bool drives_agree(const ImportedLog& log, const BodyBeams& body,
                  const std::vector<bool>& reversed) {
  double sum = 0.0;
  for (std::size_t begin = 0; begin < reversed.size();) {
    std::size_t end = begin;
    while (end < reversed.size() && reversed[end])
      ++end;
    if (end > begin) sum += score_of_drives(log, body, begin, end);
    begin = end + 1;
  }
  return sum >= std::numbers::ln2;
}

}  // namespace

std::vector<ReversedStep> find_reversed_steps(const ImportedLog& log, const BodyBeams& body) {
  const std::vector<Step> steps = steps_of(log, body);
  const std::vector<bool> is_reversed = most_likely(steps);
  if (!drives_agree(log, body, is_reversed)) return {};
  std::vector<ReversedStep> reversed;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (is_reversed[i] && steps[i].step.distance_m >= kShortestApart_m)
      reversed.push_back(steps[i].step);
  }
  return reversed;
}

std::vector<ImportedPose> with_steps_corrected(const std::vector<ImportedPose>& odometry,
                                               const std::vector<ReversedStep>& steps) {
  std::vector<ImportedPose> repaired;
  auto step = steps.begin();
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    repaired.push_back(odometry[i]);
    if (i == 0) continue;
    while (step != steps.end() && step->until < odometry[i].time)
      ++step;
    Se2 motion = odometry[i - 1].pose.inverse() * odometry[i].pose;
    if (step != steps.end() && odometry[i].time > step->after)
      motion = Se2{-motion.translation(), motion.theta()};
    repaired[i].pose = repaired[i - 1].pose * motion;
  }
  return repaired;
}

}  // namespace waymark
