// SPDX-License-Identifier: BSD-3-Clause
// Faults of sensors, named as PX4's failure injection names them.
#pragma once

#include "common/config/config.hpp"
#include "sim/core/span.hpp"

#include <vector>

namespace waymark {

enum class Sensor { kCamera, kLidar, kOdometry };

/// off: silent. stuck: the last measurement over and over, with new stamps. garbage: random values.
/// wrong: values that are off by a share. slow: only every so many-th. delayed: stamped and sent
/// late. intermittent: each lost by chance.
enum class FaultKind { kOff, kStuck, kGarbage, kWrong, kSlow, kDelayed, kIntermittent };

/// Whose counts are wrong.
enum class Wheel { kBoth, kLeft, kRight };

struct FaultConfig {
  Sensor sensor{Sensor::kCamera};
  FaultKind kind{FaultKind::kOff};
  Span during{};
  double share{0.0};
  int keep_every{10};
  double delay_s{0.0};
  Wheel wheel{Wheel::kBoth};

  void describe(Fields& fields);
};

/// The faults of one sensor.
class Faults {
 public:
  Faults(Sensor sensor, const std::vector<FaultConfig>& all);

  /// The first one of this kind that acts now, or null.
  const FaultConfig* acting(FaultKind kind, const Moment& moment) const;

  /// Is there one of this kind at any time?
  bool have(FaultKind kind) const;

  Sensor sensor() const { return sensor_; }

 private:
  Sensor sensor_;
  std::vector<FaultConfig> faults_;
};

}  // namespace waymark
