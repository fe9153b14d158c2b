// SPDX-License-Identifier: BSD-3-Clause
// Fault kinds that lose, repeat or delay measurements.
#pragma once

#include "common/random/random.hpp"
#include "common/time/time.hpp"
#include "sim/core/faults/fault_config.hpp"
#include "sim/core/random_streams.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace waymark {

/// Applies the faults of a sensor to its measurements, which have a member `time`, their stamp.
template <class Measurement>
class FaultyOutlet {
 public:
  FaultyOutlet(Faults faults, std::int64_t seed)
      : faults_{std::move(faults)}, seed_{static_cast<std::uint64_t>(seed)} {}

  const Faults& faults() const { return faults_; }

  /// Adds a measurement, with the faults active at `moment`. One stamped before 0 is dropped.
  void push(Measurement measured, const Moment& moment) {
    const std::uint64_t number = count_++;
    if (measured.time < Timestamp{} || is_lost(number, moment)) return;
    if (faults_.have(FaultKind::kStuck)) repeat_if_stuck(measured, moment);
    if (const FaultConfig* fault = faults_.active(FaultKind::kDelayed, moment))
      measured.time += duration_from_seconds(fault->delay_s);
    const auto later = std::upper_bound(
        waiting_.begin(), waiting_.end(), measured.time,
        [](const Timestamp& time, const Measurement& other) { return time < other.time; });
    waiting_.insert(later, std::move(measured));
  }

  /// Removes and returns all measurements stamped before a time, in order of their stamps.
  std::vector<Measurement> release(Timestamp before) {
    const auto end =
        std::find_if(waiting_.begin(), waiting_.end(),
                     [before](const Measurement& waiting) { return waiting.time >= before; });
    std::vector<Measurement> released{std::make_move_iterator(waiting_.begin()),
                                      std::make_move_iterator(end)};
    waiting_.erase(waiting_.begin(), end);
    return released;
  }

 private:
  bool is_lost(std::uint64_t number, const Moment& moment) const {
    if (faults_.active(FaultKind::kOff, moment) != nullptr) return true;
    if (const FaultConfig* fault = faults_.active(FaultKind::kSlow, moment);
        fault != nullptr && number % static_cast<std::uint64_t>(fault->keep_every) != 0) {
      return true;
    }
    const FaultConfig* fault = faults_.active(FaultKind::kIntermittent, moment);
    if (fault == nullptr) return false;
    Random random{seed_, random_streams::kLostMeasurements,
                  static_cast<std::uint64_t>(faults_.sensor()), number};
    return random.uniform() < fault->share;
  }

  void repeat_if_stuck(Measurement& measured, const Moment& moment) {
    if (faults_.active(FaultKind::kStuck, moment) == nullptr || !last_good_) {
      last_good_ = measured;
      return;
    }
    const Timestamp time = measured.time;
    measured = *last_good_;
    measured.time = time;
  }

  Faults faults_;
  std::uint64_t seed_;
  std::uint64_t count_{0};
  std::optional<Measurement> last_good_{};
  std::vector<Measurement> waiting_{};  ///< in order of time
};

}  // namespace waymark
