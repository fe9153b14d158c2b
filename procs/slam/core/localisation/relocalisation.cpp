// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/relocalisation.hpp"

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
constexpr int kMissesNeeded = 2;     // of one marker: a single frame may be blurred
constexpr int kMissedInDoubt = 2;    // markers: both may have been moved
constexpr int kMissedIfCarried = 3;  // so many were hardly moved at once
constexpr double kLargestSlip_m = 0.5;    // that the estimate follows; a longer one relocates
constexpr double kLongestSpin_m = 2.0;    // of the wheels, on one spot
constexpr double kSpinAside_m = 0.3;      // error of a pose from one marker
constexpr double kClearlyNearer = 2.0;    // ratio of distances of a marker's pose from two others
constexpr double kMetresPerRadian = 1.0;  // weight of the heading in these distances
constexpr double kReturn_m = 30.0;        // driven until a relocalisation is final

bool is_same_pose(const Se2& a, const Se2& b) {
  return (a.translation() - b.translation()).norm() < kSamePlace_m &&
         std::abs(angle_difference(a.theta(), b.theta())) < kSameHeading_rad;
}

double apart_m(const Se2& a, const Se2& b) {
  return (a.translation() - b.translation()).norm() +
         kMetresPerRadian * std::abs(angle_difference(a.theta(), b.theta()));
}

/// Whether one pose is before or behind the other one, and no farther than wheels may spin.
bool is_along_path(const Se2& a, const Se2& b) {
  const Se2 apart = a.inverse() * b;
  return std::abs(apart.x()) < kLongestSpin_m && std::abs(apart.y()) < kSpinAside_m &&
         std::abs(apart.theta()) < kSameHeading_rad;
}

bool has_enough(const std::map<int, int>& sightings, std::size_t markers) {
  return std::ranges::count_if(sightings, [](const auto& seen) {
           return seen.second >= kSightingsNeeded;
         }) >= static_cast<std::ptrdiff_t>(markers);
}

}  // namespace

RelocalisationMonitor::Verdict RelocalisationMonitor::update(const Se2& map_from_base,
                                                             std::span<const PoseHint> hints,
                                                             const Motion& motion,
                                                             bool may_be_carried,
                                                             const View& view) {
  propagate(motion);
  if (may_be_carried) is_certain_ = false;
  note_unexpected(hints);
  if (is_lookalike_place()) return revert();
  count_misses(is_doubtful_ ? *abandoned_ : map_from_base, view);
  if (is_doubtful_) {
    if (const auto decided = settle_doubt(map_from_base, hints, view)) return *decided;
  }
  bool is_confirmed = false;
  for (const PoseHint& hint : hints) {
    if (hint.kind == PoseHint::Kind::kElsewhere && !moved_ids_.contains(hint.id))
      support_alternative(hint);
    is_confirmed |= hint.kind == PoseHint::Kind::kAgrees || hint.kind == PoseHint::Kind::kNew;
    if (hint.kind != PoseHint::Kind::kAgrees || hint.is_mapped_since || is_doubtful_) continue;
    is_certain_ = true;
    misses_.clear();
  }
  if (is_confirmed) drop_alternative();
  if (!alternative_ || is_latent_)
    return is_doubtful_ ? Verdict::kSuspicious : Verdict::kConsistent;
  if (!has_enough(sightings_, kMarkersNeeded)) return Verdict::kSuspicious;
  if (is_certain_ && apart_m(*alternative_, map_from_base) < kLargestSlip_m) {
    drop_alternative();
    return Verdict::kSlipped;
  }
  const Walls walls = view.compare_walls(*alternative_, map_from_base);
  const bool is_carried = !is_certain_ || is_along_path(map_from_base, *alternative_) ||
                          walls == Walls::kContradictSecond || num_missed() >= kMissedIfCarried;
  const bool are_others =
      walls == Walls::kContradictFirst || (!is_carried && num_missed() < kMissedInDoubt);
  if (are_others && !is_doubtful_) {
    for (const auto& [id, count] : sightings_)
      moved_ids_.insert(id);
    drop_alternative();
    return Verdict::kConsistent;
  }
  return relocate(map_from_base, !is_carried);
}

RelocalisationMonitor::Verdict RelocalisationMonitor::relocate(const Se2& map_from_base,
                                                               bool is_doubtful) {
  relocated_ = *alternative_;
  relocated_by_.clear();
  for (const auto& [id, count] : sightings_)
    relocated_by_.insert(id);
  drop_alternative();
  // In doubt, the pose that markers had confirmed stays the other hypothesis.
  if (!is_doubtful_) abandoned_ = map_from_base;
  is_doubtful_ = is_doubtful;
  unexpected_ids_.clear();
  votes_against_.clear();
  relocated_m_ = 0.0;
  return Verdict::kRelocated;
}

RelocalisationMonitor::Verdict RelocalisationMonitor::revert() {
  relocated_ = *abandoned_;
  moved_ids_.merge(relocated_by_);
  abandoned_.reset();
  is_doubtful_ = false;
  drop_alternative();
  return Verdict::kReverted;
}

/// @return kReverted or kConsistent, if the doubt is over.
std::optional<RelocalisationMonitor::Verdict> RelocalisationMonitor::settle_doubt(
    const Se2& map_from_base, std::span<const PoseHint> hints, const View& view) {
  for (const PoseHint& hint : hints) {
    if (relocated_by_.contains(hint.id) || !hint.map_from_base) continue;
    const double from_new_m = apart_m(*hint.map_from_base, map_from_base);
    const double from_old_m = apart_m(*hint.map_from_base, *abandoned_);
    if (kClearlyNearer * from_old_m < from_new_m) ++votes_against_[hint.id];
  }
  const Walls walls = view.compare_walls(map_from_base, *abandoned_);
  if (has_enough(votes_against_, 1) || walls == Walls::kContradictFirst) return revert();
  if (num_missed() < kMissedIfCarried && walls != Walls::kContradictSecond) return std::nullopt;
  is_doubtful_ = false;
  drop_alternative();
  return Verdict::kConsistent;
}

void RelocalisationMonitor::count_misses(const Se2& map_from_base, const View& view) {
  for (const std::size_t landmark : view.missed(map_from_base))
    ++misses_[landmark];
}

std::ptrdiff_t RelocalisationMonitor::num_missed() const {
  return std::ranges::count_if(misses_,
                               [](const auto& missed) { return missed.second >= kMissesNeeded; });
}

void RelocalisationMonitor::propagate(const Motion& motion) {
  if (alternative_) {
    alternative_ = *alternative_ * motion.start_from_end;
    unsupported_m_ += motion.distance_m;
    is_latent_ |= unsupported_m_ > (num_sightings() < kRealSightings ? kMisread_m : kPatience_m);
    if (is_latent_ && !has_enough(sightings_, 1)) drop_alternative();
  }
  if (abandoned_) {
    abandoned_ = *abandoned_ * motion.start_from_end;
    relocated_m_ += motion.distance_m;
    if (relocated_m_ <= kReturn_m) return;
    abandoned_.reset();
    is_doubtful_ = false;
  }
}

void RelocalisationMonitor::note_unexpected(std::span<const PoseHint> hints) {
  if (!abandoned_) return;
  for (const PoseHint& hint : hints)
    if (hint.kind == PoseHint::Kind::kNew && hint.is_in_known_place)
      unexpected_ids_.insert(hint.id);
}

bool RelocalisationMonitor::is_lookalike_place() const {
  return abandoned_ && unexpected_ids_.size() >= kMarkersNeeded;
}

void RelocalisationMonitor::support_alternative(const PoseHint& hint) {
  if (!alternative_ || !is_same_pose(*hint.map_from_base, *alternative_)) sightings_.clear();
  ++sightings_[hint.id];
  unsupported_m_ = 0.0;
  is_latent_ = false;
  alternative_ = hint.map_from_base;
}

int RelocalisationMonitor::num_sightings() const {
  int sum = 0;
  for (const auto& [id, count] : sightings_)
    sum += count;
  return sum;
}

void RelocalisationMonitor::drop_alternative() {
  alternative_.reset();
  sightings_.clear();
  unsupported_m_ = 0.0;
  is_latent_ = false;
}

}  // namespace waymark
