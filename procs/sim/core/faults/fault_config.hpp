// SPDX-License-Identifier: BSD-3-Clause
// Faults of sensors, with the names of PX4's failure injection.
#pragma once

#include "common/config/config.hpp"
#include "sim/core/span.hpp"

#include <vector>

namespace waymark {

enum class Sensor { kCamera, kLidar, kOdometry };

/// off: no measurements. stuck: repeats the last measurement with new stamps. garbage: random
/// values. wrong: ranges, brightness or counted wheel angles scaled by 1 + share. slow: sends every
/// keep_every-th measurement. delayed: stamped and sent delay_s late. intermittent: each
/// measurement is lost with probability `share`.
enum class FaultKind { kOff, kStuck, kGarbage, kWrong, kSlow, kDelayed, kIntermittent };

/// The wheel that a fault "wrong" of the odometry concerns.
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

  /// The first fault of this kind that is active now, or null.
  const FaultConfig* active(FaultKind kind, const Moment& moment) const;

  /// True when a fault of this kind is configured, whether or not it is active now.
  bool have(FaultKind kind) const;

  Sensor sensor() const { return sensor_; }

 private:
  Sensor sensor_;
  std::vector<FaultConfig> faults_;
};

}  // namespace waymark
