// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/trajectory/timeline.hpp"

#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "evaluate/trajectory/stations.hpp"

#include <algorithm>

namespace waymark::evaluate {
namespace {

/// Largest errors of a pose that counts as right: more than those of a good relocalisation, less
/// than half of the distance between hypotheses (the markers' spacing).
constexpr double kRight_m = 0.3;
constexpr double kRight_rad = 0.17;  // 10 degrees
constexpr double kStaysRight_s = 1.0;
/// 99.9 % quantile of chi-square with 3 degrees of freedom.
constexpr double kLargestNees = 16.266;

bool is_right(const PosePair& pair, const Se2& world_from_map) {
  const Se2 difference =
      pair.world_from_truth.inverse() * (world_from_map * pair.map_from_estimate);
  return difference.translation().norm() <= kRight_m && std::abs(difference.theta()) <= kRight_rad;
}

/// Time of the first right pose from `from_s` on that is followed by right ones for kStaysRight_s.
std::optional<double> found_t_s(const std::vector<PosePair>& pairs, const Se2& world_from_map,
                                double from_s) {
  std::optional<double> since_s;
  for (const PosePair& pair : pairs) {
    if (pair.t_s < from_s) continue;
    if (!is_right(pair, world_from_map)) {
      since_s.reset();
      continue;
    }
    if (!since_s) since_s = pair.t_s;
    if (pair.t_s - *since_s >= kStaysRight_s) return since_s;
  }
  return std::nullopt;
}

double jump_m(const PosePair& before, const PosePair& after) {
  const Se2 estimated = before.map_from_estimate.inverse() * after.map_from_estimate;
  const Se2 truth = before.world_from_truth.inverse() * after.world_from_truth;
  return (estimated.translation() - truth.translation()).norm();
}

double confident_wrong_s(const std::vector<PosePair>& pairs,
                         const std::vector<StampedCovariance>& covariances,
                         const Se2& world_from_map, double from_s) {
  double sum_s = 0.0;
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    const StampedCovariance* const stamped = covariance_at(covariances, pairs[i].t_s);
    if (pairs[i - 1].t_s < from_s || stamped == nullptr || stamped->health == Health::kLost ||
        is_right(pairs[i], world_from_map))
      continue;
    const auto nees = nees_of(pairs[i], stamped->covariance, world_from_map);
    if (!nees || *nees > kLargestNees) sum_s += pairs[i].t_s - pairs[i - 1].t_s;
  }
  return sum_s;
}

Kidnap kidnap_at(double lifted_t_s, const std::vector<PosePair>& pairs,
                 const std::vector<StampedCovariance>& covariances, const Se2& world_from_map,
                 const std::vector<double>& sightings_s) {
  const auto sighting = std::lower_bound(sightings_s.begin(), sightings_s.end(), lifted_t_s);
  Kidnap kidnap{.lifted_t_s = lifted_t_s,
                .sighting_t_s = sighting == sightings_s.end() ? lifted_t_s : *sighting};
  for (const StampedCovariance& stamped : covariances) {
    if (stamped.t_s < lifted_t_s || stamped.health != Health::kLost) continue;
    kidnap.says_lost_s = std::max(0.0, stamped.t_s - kidnap.sighting_t_s);
    break;
  }
  if (const auto found_s = found_t_s(pairs, world_from_map, lifted_t_s))
    kidnap.found_again_s = std::max(0.0, *found_s - kidnap.sighting_t_s);
  kidnap.confident_wrong_s =
      confident_wrong_s(pairs, covariances, world_from_map, kidnap.sighting_t_s);
  return kidnap;
}

}  // namespace

std::vector<double> sighting_times(const std::filesystem::path& log) {
  std::vector<double> times_s;
  try {
    LogReader reader{log};
    const auto is_wanted = [](std::string_view channel) {
      return channel == channels::kMarkers.name;
    };
    while (const auto message = reader.next(is_wanted)) {
      const auto decoded = decode<marker_detections_t>(message->payload);
      if (decoded.message && decoded.message->num_detections > 0)
        times_s.push_back(to_seconds(message->time));
    }
  } catch (const std::runtime_error& error) {
    throw SetupError{error.what()};
  }
  return times_s;
}

std::optional<double> lifted_t_s(const Trajectory& truth) {
  for (std::size_t i = 1; i < truth.size(); ++i) {
    if (was_lifted(truth[i - 1].parent_from_base, truth[i].parent_from_base,
                   truth[i].t_s - truth[i - 1].t_s))
      return truth[i].t_s;
  }
  return std::nullopt;
}

HealthSummary health_summary(const std::vector<PosePair>& pairs,
                             const std::vector<StampedCovariance>& covariances,
                             const Se2& world_from_map, std::optional<double> lifted_t_s,
                             const std::vector<double>& sightings_s) {
  HealthSummary summary{};
  double known = 0.0;
  for (const StampedCovariance& stamped : covariances) {
    known += stamped.health == Health::kUnknown ? 0.0 : 1.0;
    summary.share_tracking += stamped.health == Health::kTracking ? 1.0 : 0.0;
    summary.share_degenerate += stamped.health == Health::kDegenerate ? 1.0 : 0.0;
    summary.share_lost += stamped.health == Health::kLost ? 1.0 : 0.0;
  }
  for (double* share : {&summary.share_tracking, &summary.share_degenerate, &summary.share_lost})
    *share /= std::max(known, 1.0);
  if (lifted_t_s)
    summary.kidnap = kidnap_at(*lifted_t_s, pairs, covariances, world_from_map, sightings_s);
  for (std::size_t i = 1; i < pairs.size(); ++i) {
    if (lifted_t_s && pairs[i].t_s >= *lifted_t_s) break;  // relocalising is a jump by nature
    summary.max_jump_m = std::max(summary.max_jump_m, jump_m(pairs[i - 1], pairs[i]));
  }
  return summary;
}

}  // namespace waymark::evaluate
