// SPDX-License-Identifier: BSD-3-Clause
// Records a running robot into a temporary log.
#pragma once

#include "common/node/counters.hpp"
#include "doctor/doctor_input.hpp"

#include <chrono>
#include <filesystem>
#include <string>

namespace waymark {

/// A log in a temporary folder, which the destructor removes.
class LiveLog {
 public:
  /// Records CAMERA, MARKERS, LIDAR and ODOMETRY, or the `wanted` channels in place of the last
  /// two, for `duration` or until a stop signal.
  /// @throws SetupError when there is no network, or no message came.
  LiveLog(const std::string& lcm_url, const InputChannels& wanted, std::chrono::seconds duration,
          const ShowProgress& progress = {});
  ~LiveLog();
  LiveLog(const LiveLog&) = delete;
  LiveLog& operator=(const LiveLog&) = delete;

  std::filesystem::path file() const { return folder_ / "live.lcm"; }

  /// Lost and rejected messages.
  const Counters& counters() const { return counters_; }

 private:
  std::filesystem::path folder_;
  Counters counters_{};
};

}  // namespace waymark
