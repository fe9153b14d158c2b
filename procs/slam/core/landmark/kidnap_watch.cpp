// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/landmark/kidnap_watch.hpp"

#include <cmath>

namespace waymark {
namespace {

constexpr std::size_t kProof = 2;     // markers that agree about the other place
constexpr double kPatience_m = 1.0;   // then a marker without a witness is taken for a double
constexpr double kSamePlace_m = 0.5;  // two markers agree about the other place
constexpr double kSameHeading_rad = 0.35;

}  // namespace

KidnapWatch::Verdict KidnapWatch::judge(const Belief& belief,
                                        std::span<const MarkerMeasurement> seen,
                                        const Motion& motion, double gate, double near_m) {
  if (elsewhere_) {
    elsewhere_ = *elsewhere_ * motion.start_from_end;
    doubted_m_ += motion.distance_m;
    if (doubted_m_ > kPatience_m) forget();
  }
  bool belief_is_confirmed = false;
  for (const MarkerMeasurement& measurement : seen) {
    const auto nearest = belief.nearest(measurement);
    if (!nearest || nearest->may_be_it(gate, near_m)) {
      belief_is_confirmed = true;
    } else if (const auto only = belief.only_marker(measurement.id)) {
      count_for_elsewhere(measurement.id, belief.pose_by(*only, measurement));
      relocating_marker_ = measurement;
    }
  }
  if (belief_is_confirmed) forget();
  if (!elsewhere_) return Verdict::kSettled;
  if (ids_for_elsewhere_.size() < kProof) return Verdict::kDoubtful;
  forget();
  return Verdict::kElsewhere;
}

void KidnapWatch::count_for_elsewhere(int id, const Se2& map_from_base) {
  const bool agrees =
      elsewhere_ &&
      (map_from_base.translation() - elsewhere_->translation()).norm() < kSamePlace_m &&
      std::abs(angle_difference(map_from_base.theta(), elsewhere_->theta())) < kSameHeading_rad;
  if (!agrees) {
    ids_for_elsewhere_.clear();
    doubted_m_ = 0.0;
  }
  ids_for_elsewhere_.insert(id);
  elsewhere_ = map_from_base;
}

void KidnapWatch::forget() {
  elsewhere_.reset();
  ids_for_elsewhere_.clear();
  doubted_m_ = 0.0;
}

}  // namespace waymark
