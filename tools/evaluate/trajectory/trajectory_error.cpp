// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/trajectory/trajectory_error.hpp"

#include "common/geometry/rigid_fit.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::evaluate {
namespace {

using Eigen::Vector2d;

constexpr double kRpeTravel_m = 1.0;
constexpr double kShortestAxis_m = 1.0;  ///< least distance between first and last pose

class SpreadOf {
 public:
  void add(double value) {
    squares_ += value * value;
    max_ = std::max(max_, std::abs(value));
    ++count_;
  }

  Spread get() const { return {std::sqrt(squares_ / static_cast<double>(count_)), max_}; }

 private:
  double squares_{0.0};
  double max_{0.0};
  std::size_t count_{0};
};

double ate_m(const std::vector<PosePair>& pairs, const Se2& world_from_map) {
  SpreadOf distances;
  for (const PosePair& pair : pairs)
    distances.add((world_from_map * pair.map_from_estimate.translation() -
                   pair.world_from_truth.translation())
                      .norm());
  return distances.get().rms;
}

/// world_from_map by the best rigid fit.
Se2 best_fit(const std::vector<PosePair>& pairs) {
  std::vector<PointPair> points;
  for (const PosePair& pair : pairs)
    points.push_back({pair.world_from_truth.translation(), pair.map_from_estimate.translation()});
  return rigid_fit(points);
}

/// Relative pose errors over kRpeTravel_m of true travel, from every pose.
void add_rpe(const std::vector<PosePair>& pairs, TrajectoryError& error) {
  std::vector<double> travelled_m{0.0};
  for (std::size_t i = 1; i < pairs.size(); ++i)
    travelled_m.push_back(travelled_m.back() + (pairs[i].world_from_truth.translation() -
                                                pairs[i - 1].world_from_truth.translation())
                                                   .norm());
  SpreadOf translation_m;
  SpreadOf rotation_deg;
  for (std::size_t from = 0, to = 0; from < pairs.size(); ++from) {
    while (to < pairs.size() && travelled_m[to] - travelled_m[from] < kRpeTravel_m)
      ++to;
    if (to == pairs.size()) break;
    const Se2 estimated = pairs[from].map_from_estimate.inverse() * pairs[to].map_from_estimate;
    const Se2 truth = pairs[from].world_from_truth.inverse() * pairs[to].world_from_truth;
    const Se2 difference = truth.inverse() * estimated;
    translation_m.add(difference.translation().norm());
    rotation_deg.add(degrees(difference.theta()));
    ++error.rpe_pairs;
  }
  if (error.rpe_pairs == 0) return;
  error.rpe_translation_m = translation_m.get();
  error.rpe_rotation_deg = rotation_deg.get();
}

}  // namespace

std::string_view name_of(Alignment alignment) {
  switch (alignment) {
    case Alignment::kOrigin:
      return "origin";
    case Alignment::kSe2:
      return "se2";
    case Alignment::kFrame:
      break;
  }
  return "frame";
}

std::vector<PosePair> associate(const Trajectory& estimate, const Trajectory& truth) {
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : estimate) {
    if (const auto world_from_truth = pose_at(truth, pose.t_s))
      pairs.push_back({pose.t_s, pose.parent_from_base, *world_from_truth});
  }
  return pairs;
}

Se2 align(const std::vector<PosePair>& pairs, Alignment alignment) {
  if (alignment == Alignment::kSe2) return best_fit(pairs);
  return pairs.front().world_from_truth * pairs.front().map_from_estimate.inverse();
}

TrajectoryError trajectory_error(const std::vector<PosePair>& pairs, Alignment alignment,
                                 const std::optional<Se2>& known_frame) {
  TrajectoryError error{};
  error.alignment = known_frame ? Alignment::kFrame : alignment;
  error.poses = pairs.size();
  error.duration_s = pairs.back().t_s - pairs.front().t_s;
  error.ate_origin_m = ate_m(pairs, align(pairs, Alignment::kOrigin));
  error.ate_se2_m = ate_m(pairs, align(pairs, Alignment::kSe2));

  if (known_frame) error.ate_frame_m = ate_m(pairs, *known_frame);

  const Se2 world_from_map = known_frame ? *known_frame : align(pairs, alignment);
  const Vector2d whole =
      pairs.back().world_from_truth.translation() - pairs.front().world_from_truth.translation();
  const Vector2d axis = whole.normalized();
  SpreadOf distance_m;
  SpreadOf along_m;
  SpreadOf across_m;
  SpreadOf heading_deg;
  for (const PosePair& pair : pairs) {
    const Se2 world_from_estimate = world_from_map * pair.map_from_estimate;
    const Vector2d offset = world_from_estimate.translation() - pair.world_from_truth.translation();
    const double turn_deg =
        degrees(angle_difference(world_from_estimate.theta(), pair.world_from_truth.theta()));
    distance_m.add(offset.norm());
    along_m.add(offset.dot(axis));
    across_m.add(axis.x() * offset.y() - axis.y() * offset.x());
    heading_deg.add(turn_deg);
    error.end_distance_m = offset.norm();
    error.end_heading_deg = turn_deg;
  }
  error.distance_m = distance_m.get();
  error.heading_deg = heading_deg.get();
  if (whole.norm() >= kShortestAxis_m) {
    error.along_m = along_m.get();
    error.across_m = across_m.get();
  }
  add_rpe(pairs, error);
  return error;
}

}  // namespace waymark::evaluate
