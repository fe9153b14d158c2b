// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/faults/fault_config.hpp"

#include <algorithm>

namespace waymark {

void FaultConfig::describe(Fields& fields) {
  fields.choice(
      "sensor", sensor,
      {{"camera", Sensor::kCamera}, {"lidar", Sensor::kLidar}, {"odometry", Sensor::kOdometry}},
      "which sensor has the fault");
  fields.choice("kind", kind,
                {{"off", FaultKind::kOff},
                 {"stuck", FaultKind::kStuck},
                 {"garbage", FaultKind::kGarbage},
                 {"wrong", FaultKind::kWrong},
                 {"slow", FaultKind::kSlow},
                 {"delayed", FaultKind::kDelayed},
                 {"intermittent", FaultKind::kIntermittent}},
                "as in PX4");
  during.describe(fields);
  fields.field(
      "share", share, {-1.0, 10.0},
      "wrong: ranges, wheel turns or brightness times 1 + share; intermittent: so many are "
      "lost");
  fields.field("keep_every", keep_every, {1, 100000}, "slow: only every so many-th is sent");
  fields.field("delay_s", delay_s, {0.0, 10.0}, "delayed: by so much");
  fields.choice("wheel", wheel,
                {{"both", Wheel::kBoth}, {"left", Wheel::kLeft}, {"right", Wheel::kRight}},
                "odometry wrong: which wheel turns further than it rolls");
}

Faults::Faults(Sensor sensor, const std::vector<FaultConfig>& all) : sensor_{sensor} {
  std::copy_if(all.begin(), all.end(), std::back_inserter(faults_),
               [sensor](const FaultConfig& fault) { return fault.sensor == sensor; });
}

const FaultConfig* Faults::active(FaultKind kind, const Moment& moment) const {
  const auto found = std::find_if(faults_.begin(), faults_.end(), [&](const FaultConfig& fault) {
    return fault.kind == kind && fault.during.covers(moment);
  });
  return found == faults_.end() ? nullptr : &*found;
}

bool Faults::have(FaultKind kind) const {
  return std::any_of(faults_.begin(), faults_.end(),
                     [kind](const FaultConfig& fault) { return fault.kind == kind; });
}

}  // namespace waymark
