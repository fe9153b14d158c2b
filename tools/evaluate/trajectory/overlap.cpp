// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/trajectory/overlap.hpp"

#include <fmt/format.h>

namespace waymark::evaluate {
namespace {

/// If a larger share of either trajectory lies outside the other, the errors are not the run's.
constexpr double kOutsideShare = 0.05;
/// The first pose may come late, as localising needs a unique place; but if less than half of the
/// run is left, the errors are not the run's.
constexpr double kLatestStartShare = 0.5;
/// Longer than the travel between two updates of any estimator. A robot at rest needs no poses.
constexpr double kLongestGap_m = 2.0;

/// Total time of the gaps between poses in which the true robot drives more than kLongestGap_m [s].
double gaps_s(const Trajectory& truth, const std::vector<PosePair>& pairs) {
  double sum_s = 0.0;
  auto next = truth.begin();
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    double driven_m = 0.0;
    Eigen::Vector2d from = pairs[i - 1].world_from_truth.translation();
    const auto drive_to = [&](const Se2& pose) {
      driven_m += (pose.translation() - from).norm();
      from = pose.translation();
    };
    for (; next != truth.end() && next->t_s < pairs[i].t_s; ++next) {
      if (next->t_s > pairs[i - 1].t_s) drive_to(next->parent_from_base);
    }
    drive_to(pairs[i].world_from_truth);
    if (driven_m > kLongestGap_m) sum_s += pairs[i].t_s - pairs[i - 1].t_s;
  }
  return sum_s;
}

bool starts_after(double share, const Overlap& overlap) {
  return overlap.first_pose_s > share * overlap.truth_s;
}

std::string start_of(const Overlap& overlap, std::string_view truth) {
  return fmt::format("begins {:.1f} s after the {}, which lasts {:.1f} s; errors are from there on",
                     overlap.first_pose_s, truth, overlap.truth_s);
}

}  // namespace

Overlap overlap_of(const Trajectory& estimate, const Trajectory& truth,
                   const std::vector<PosePair>& pairs) {
  Overlap overlap{.poses = estimate.size(), .outside = estimate.size() - pairs.size()};
  overlap.truth_s = truth.back().t_s - truth.front().t_s;
  overlap.first_pose_s = pairs.front().t_s - truth.front().t_s;
  const double wanted_s = truth.back().t_s - pairs.front().t_s;
  const double covered_s = pairs.back().t_s - pairs.front().t_s - gaps_s(truth, pairs);
  overlap.covered_share = wanted_s > 0.0 ? covered_s / wanted_s : 0.0;
  return overlap;
}

std::vector<std::string> problems_of(const Overlap& overlap, std::string_view truth) {
  std::vector<std::string> problems;
  if (static_cast<double>(overlap.outside) > kOutsideShare * static_cast<double>(overlap.poses))
    problems.push_back(fmt::format("{} of {} poses are outside the {}'s time span", overlap.outside,
                                   overlap.poses, truth));
  if (overlap.covered_share < 1.0 - kOutsideShare)
    problems.push_back(fmt::format(
        "covers {:.1f} % of the {}'s time from the first pose on, expected at least {:.0f} %",
        100.0 * overlap.covered_share, truth, 100.0 * (1.0 - kOutsideShare)));
  if (starts_after(kLatestStartShare, overlap)) problems.push_back(start_of(overlap, truth));
  return problems;
}

std::optional<std::string> late_start_of(const Overlap& overlap, std::string_view truth) {
  if (!starts_after(kOutsideShare, overlap) || starts_after(kLatestStartShare, overlap))
    return std::nullopt;
  return start_of(overlap, truth);
}

}  // namespace waymark::evaluate
