// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/landmark/kidnap_watch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace waymark {
namespace {

constexpr std::size_t kProof = 2;     // markers that agree
constexpr double kSamePlace_m = 0.5;  // about the other place
constexpr double kSameHeading_rad = 0.35;
constexpr int kProofSightings = 2;   // of each of them: misread ids do not repeat
constexpr int kRealSightings = 3;    // fewer of one marker may be a misreading
constexpr double kMisread_m = 0.15;  // way without another sighting that ends such a doubt
constexpr double kPatience_m = 5.0;  // the same for a marker that was really there
constexpr double kReturn_m = 30.0;   // way after which a relocation is final

}  // namespace

KidnapWatch::Verdict KidnapWatch::judge(const Belief& belief,
                                        std::span<const MarkerMeasurement> seen,
                                        const Motion& motion, double gate, double near_m) {
  follow(motion);
  if (doubles_explain(belief, seen)) return Verdict::kBack;
  bool belief_is_confirmed = false;
  for (const MarkerMeasurement& measurement : seen) {
    const auto nearest = belief.nearest(measurement);
    if (!nearest || nearest->may_be_it(gate, near_m)) {
      belief_is_confirmed = true;
    } else if (const auto witness = belief.witness(measurement.id)) {
      count_for_elsewhere(measurement.id, belief.pose_by(*witness, measurement));
      relocating_marker_ = measurement;
    }
  }
  if (belief_is_confirmed) forget_doubt();
  if (!elsewhere_) return Verdict::kSettled;
  if (!is_elsewhere()) return Verdict::kDoubtful;
  forget_doubt();
  unbelieved_ = belief.map_from_base();
  strangers_.clear();
  relocated_m_ = 0.0;
  return Verdict::kElsewhere;
}

void KidnapWatch::follow(const Motion& motion) {
  if (elsewhere_) {
    elsewhere_ = *elsewhere_ * motion.start_from_end;
    unsupported_m_ += motion.distance_m;
    if (unsupported_m_ > (sightings() < kRealSightings ? kMisread_m : kPatience_m)) forget_doubt();
  }
  if (unbelieved_) {
    unbelieved_ = *unbelieved_ * motion.start_from_end;
    relocated_m_ += motion.distance_m;
    if (relocated_m_ > kReturn_m || strangers_.size() >= kProof) unbelieved_.reset();
  }
}

bool KidnapWatch::doubles_explain(const Belief& belief, std::span<const MarkerMeasurement> seen) {
  if (!unbelieved_) return false;
  const std::vector<Landmark> known = belief.markers();
  for (const MarkerMeasurement& measurement : seen) {
    if (belief.nearest(measurement)) continue;
    const Eigen::Vector2d place =
        belief.map_from_base() * measurement.base_from_marker.translation();
    if (std::any_of(known.begin(), known.end(), [&](const Landmark& marker) {
          return (marker.map_from_marker.translation() - place).norm() < kSamePlace_m;
        })) {
      strangers_.insert(measurement.id);
    }
  }
  return strangers_.size() >= kProof;
}

void KidnapWatch::count_for_elsewhere(int id, const Se2& map_from_base) {
  const bool agrees =
      elsewhere_ &&
      (map_from_base.translation() - elsewhere_->translation()).norm() < kSamePlace_m &&
      std::abs(angle_difference(map_from_base.theta(), elsewhere_->theta())) < kSameHeading_rad;
  if (!agrees) ids_for_elsewhere_.clear();
  ++ids_for_elsewhere_[id];
  unsupported_m_ = 0.0;
  elsewhere_ = map_from_base;
}

int KidnapWatch::sightings() const {
  return std::accumulate(ids_for_elsewhere_.begin(), ids_for_elsewhere_.end(), 0,
                         [](int sum, const auto& seen) { return sum + seen.second; });
}

bool KidnapWatch::is_elsewhere() const {
  return std::count_if(ids_for_elsewhere_.begin(), ids_for_elsewhere_.end(), [](const auto& seen) {
           return seen.second >= kProofSightings;
         }) >= static_cast<std::ptrdiff_t>(kProof);
}

void KidnapWatch::forget_doubt() {
  elsewhere_.reset();
  ids_for_elsewhere_.clear();
  unsupported_m_ = 0.0;
}

}  // namespace waymark
