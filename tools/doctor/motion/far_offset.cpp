// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/motion/far_offset.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace waymark {
namespace {

constexpr double kReach_s = 10.0;  // farthest offset that is searched
constexpr double kStep_s = 0.1;    // turns last longer
constexpr double kNear_s = 0.5;    // within this, the fine search finds the offset
constexpr double kApart_s = 1.0;   // offsets farther apart than this are different ones
/// Part of the motion that stays unexplained at the right offset, of that at any other one. A drive
/// that repeats itself fits at several offsets, and then none is found.
constexpr double kClear = 0.5;
constexpr double kUsualShare = 0.02;         // of the turns' squares: noise of scans and wheels
constexpr double kUsualBearing_rad2 = 1e-4;  // half a degree, squared: noise of markers and wheels
constexpr std::size_t kMinCompared = 30;
constexpr std::size_t kMaxCompared = 4000;  // more make the search slow and not better
constexpr double kMaxPause_s = 2.0;         // between two sightings of a marker that are compared
/// A sighting that is farther from its prediction is of another marker, or misread.
constexpr double kMaxBearing_rad = 0.3;

using Cost = std::function<std::optional<double>(double late_s)>;

/// The offset with the clearly least cost, if it is no near one.
/// @param noise  cost at the right offset that is usual: smaller ones are as good.
std::optional<double> far_minimum_s(double noise, const Cost& cost) {
  constexpr int kSteps = static_cast<int>(kReach_s / kStep_s);

  struct Tried {
    double late_s{0.0};
    double cost{0.0};
  };

  std::vector<Tried> tried;
  for (int i = -kSteps; i <= kSteps; ++i)
    if (const auto value = cost(i * kStep_s)) tried.push_back({i * kStep_s, *value});
  if (tried.empty()) return std::nullopt;
  const Tried best = *std::ranges::min_element(tried, {}, &Tried::cost);
  if (std::abs(best.late_s) <= kNear_s) return std::nullopt;
  const bool is_clear = std::ranges::all_of(tried, [&](const Tried& other) {
    return std::abs(other.late_s - best.late_s) <= kApart_s ||
           std::max(noise, best.cost) < kClear * other.cost;
  });
  return is_clear ? std::optional{best.late_s} : std::nullopt;
}

bool is_covered(const std::vector<ImportedPose>& odometry, Timestamp time) {
  return time >= odometry.front().time && time <= odometry.back().time;
}

/// At least half of them must be comparable at every offset that counts.
std::size_t least_compared(std::size_t count) {
  return std::max(kMinCompared, count / 2);
}

/// Share of the turns' squares that a common ratio does not explain: 1 - correlation^2.
std::optional<double> unexplained_share(const std::vector<LidarTurn>& turns,
                                        const std::vector<ImportedPose>& odometry, double late_s) {
  const Duration late = duration_from_seconds(late_s);
  double product = 0.0;
  double lidar_squares = 0.0;
  double odometry_squares = 0.0;
  std::size_t compared = 0;
  for (const LidarTurn& turn : turns) {
    if (!is_covered(odometry, turn.from - late) || !is_covered(odometry, turn.to - late)) continue;
    const double by_odometry_rad = angle_difference(pose_at(odometry, turn.to - late).theta(),
                                                    pose_at(odometry, turn.from - late).theta());
    product += turn.turn_rad * by_odometry_rad;
    lidar_squares += turn.turn_rad * turn.turn_rad;
    odometry_squares += by_odometry_rad * by_odometry_rad;
    ++compared;
  }
  if (compared < least_compared(turns.size())) return std::nullopt;
  const double squares = lidar_squares * odometry_squares;
  return squares > 0.0 ? 1.0 - product * product / squares : 1.0;
}

/// Two sightings of one marker, shortly after each other.
struct SightingPair {
  Timestamp first_time{};
  Timestamp second_time{};
  Eigen::Vector2d first_in_base{Eigen::Vector2d::Zero()};
  Eigen::Vector2d second_in_base{Eigen::Vector2d::Zero()};
};

std::vector<SightingPair> pairs_of(const std::vector<CameraSighting>& sightings,
                                   const Eigen::Isometry3d& base_from_camera) {
  const auto in_base = [&](const CameraSighting& sighting) -> Eigen::Vector2d {
    return (base_from_camera * sighting.place_in_camera).head<2>();
  };
  std::vector<SightingPair> pairs;
  for (auto first = sightings.begin(); first != sightings.end(); ++first) {
    const auto second = std::find_if(std::next(first), sightings.end(), [&](const auto& other) {
      return other.id == first->id && other.time > first->time;
    });
    if (second == sightings.end()) continue;
    if (to_seconds(second->time - first->time) > kMaxPause_s) continue;
    pairs.push_back({first->time, second->time, in_base(*first), in_base(*second)});
  }
  return pairs;
}

double angle_of(const Eigen::Vector2d& place) {
  return std::atan2(place.y(), place.x());
}

/// Mean square of the bearings' differences from the prediction by odometry [rad^2].
std::optional<double> unexplained_bearings(const std::vector<SightingPair>& pairs,
                                           const std::vector<ImportedPose>& odometry,
                                           double late_s) {
  const Duration late = duration_from_seconds(late_s);
  double squares = 0.0;
  std::size_t compared = 0;
  for (const SightingPair& pair : pairs) {
    const Timestamp first = pair.first_time - late;
    const Timestamp second = pair.second_time - late;
    if (!is_covered(odometry, first) || !is_covered(odometry, second)) continue;
    const Eigen::Vector2d predicted =
        pose_at(odometry, second).inverse() * pose_at(odometry, first) * pair.first_in_base;
    const double off_rad = angle_difference(angle_of(pair.second_in_base), angle_of(predicted));
    squares += std::pow(std::min(std::abs(off_rad), kMaxBearing_rad), 2);
    ++compared;
  }
  if (compared < least_compared(pairs.size())) return std::nullopt;
  return squares / static_cast<double>(compared);
}

template <class Record>
std::vector<Record> thinned_out(const std::vector<Record>& records) {
  std::vector<Record> some;
  const std::size_t every = 1 + records.size() / kMaxCompared;
  for (std::size_t i = 0; i < records.size(); i += every)
    some.push_back(records[i]);
  return some;
}

}  // namespace

std::optional<double> far_lidar_late_s(const std::vector<LidarTurn>& turns,
                                       const std::vector<ImportedPose>& odometry) {
  if (odometry.empty()) return std::nullopt;
  const std::vector<LidarTurn> some = thinned_out(turns);
  return far_minimum_s(kUsualShare,
                       [&](double late_s) { return unexplained_share(some, odometry, late_s); });
}

std::optional<double> far_camera_late_s(const std::vector<CameraSighting>& sightings,
                                        const Eigen::Isometry3d& base_from_camera,
                                        const std::vector<ImportedPose>& odometry) {
  if (odometry.empty()) return std::nullopt;
  const std::vector<SightingPair> some = thinned_out(pairs_of(sightings, base_from_camera));
  return far_minimum_s(kUsualBearing_rad2,
                       [&](double late_s) { return unexplained_bearings(some, odometry, late_s); });
}

double persistence_of(const std::vector<LidarTurn>& turns) {
  double product = 0.0;
  double squares = 0.0;
  for (std::size_t i = 1; i < turns.size(); ++i) {
    product += turns[i - 1].turn_rad * turns[i].turn_rad;
    squares += turns[i].turn_rad * turns[i].turn_rad;
  }
  return squares > 0.0 ? product / squares : 0.0;
}

}  // namespace waymark
