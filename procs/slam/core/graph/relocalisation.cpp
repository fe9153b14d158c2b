// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/relocalisation.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr std::size_t kMarkersNeeded = 2;  // that agree on a pose
constexpr int kSightingsNeeded = 2;        // of each marker: a misread id rarely repeats
constexpr double kSamePlace_m = 0.5;
constexpr double kSameHeading_rad = 0.35;
constexpr int kRealSightings = 3;    // fewer of one marker may be a misreading
constexpr double kMisread_m = 0.5;   // driven without another sighting: the first was a misreading
constexpr double kPatience_m = 5.0;  // that limit after kRealSightings or more
constexpr double kReturn_m = 30.0;   // driven until a relocalisation is final

}  // namespace

RelocalisationMonitor::Verdict RelocalisationMonitor::update(const Se2& map_from_base,
                                                             std::span<const PoseHint> hints,
                                                             const Motion& motion) {
  propagate(motion);
  if (is_lookalike_place(hints)) {
    relocated_ = *abandoned_;
    abandoned_.reset();
    drop_alternative();
    return Verdict::kReverted;
  }
  bool is_confirmed = false;
  for (const PoseHint& hint : hints) {
    if (hint.kind == PoseHint::Kind::kElsewhere) support_alternative(hint);
    is_confirmed |= hint.kind == PoseHint::Kind::kAgrees || hint.kind == PoseHint::Kind::kNew;
  }
  if (is_confirmed) drop_alternative();
  if (!alternative_) return Verdict::kConsistent;
  if (!is_supported()) return Verdict::kSuspicious;
  relocated_ = *alternative_;
  drop_alternative();
  abandoned_ = map_from_base;
  unexpected_ids_.clear();
  relocated_m_ = 0.0;
  return Verdict::kRelocated;
}

void RelocalisationMonitor::propagate(const Motion& motion) {
  if (alternative_) {
    alternative_ = *alternative_ * motion.start_from_end;
    unsupported_m_ += motion.distance_m;
    if (unsupported_m_ > (num_sightings() < kRealSightings ? kMisread_m : kPatience_m))
      drop_alternative();
  }
  if (abandoned_) {
    abandoned_ = *abandoned_ * motion.start_from_end;
    relocated_m_ += motion.distance_m;
    if (relocated_m_ > kReturn_m) abandoned_.reset();
  }
}

bool RelocalisationMonitor::is_lookalike_place(std::span<const PoseHint> hints) {
  if (!abandoned_) return false;
  for (const PoseHint& hint : hints)
    if (hint.kind == PoseHint::Kind::kNew && hint.is_in_known_place)
      unexpected_ids_.insert(hint.id);
  return unexpected_ids_.size() >= kMarkersNeeded;
}

void RelocalisationMonitor::support_alternative(const PoseHint& hint) {
  const bool agrees =
      alternative_ &&
      (hint.map_from_base.translation() - alternative_->translation()).norm() < kSamePlace_m &&
      std::abs(angle_difference(hint.map_from_base.theta(), alternative_->theta())) <
          kSameHeading_rad;
  if (!agrees) sightings_.clear();
  ++sightings_[hint.id];
  unsupported_m_ = 0.0;
  alternative_ = hint.map_from_base;
}

int RelocalisationMonitor::num_sightings() const {
  int sum = 0;
  for (const auto& [id, count] : sightings_)
    sum += count;
  return sum;
}

bool RelocalisationMonitor::is_supported() const {
  return std::count_if(sightings_.begin(), sightings_.end(), [](const auto& seen) {
           return seen.second >= kSightingsNeeded;
         }) >= static_cast<std::ptrdiff_t>(kMarkersNeeded);
}

void RelocalisationMonitor::drop_alternative() {
  alternative_.reset();
  sightings_.clear();
  unsupported_m_ = 0.0;
}

}  // namespace waymark
