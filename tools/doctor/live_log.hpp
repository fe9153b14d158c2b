// SPDX-License-Identifier: BSD-3-Clause
// What a running robot says, as a log.
#pragma once

#include "common/node/counters.hpp"
#include "doctor/doctor_input.hpp"

#include <chrono>
#include <filesystem>
#include <string>

namespace waymark {

/// In a temporary folder, which goes with it.
class LiveLog {
 public:
  /// Records CAMERA, MARKERS, LIDAR and ODOMETRY, or the channels that are wanted instead, for that
  /// long or until a signal comes.
  /// @throws SetupError when there is no network, or nothing came.
  LiveLog(const std::string& lcm_url, const InputChannels& wanted, std::chrono::seconds duration,
          const ShowProgress& progress = {});
  ~LiveLog();
  LiveLog(const LiveLog&) = delete;
  LiveLog& operator=(const LiveLog&) = delete;

  std::filesystem::path file() const { return folder_ / "live.lcm"; }

  /// What was lost or refused.
  const Counters& counters() const { return counters_; }

 private:
  std::filesystem::path folder_;
  Counters counters_{};
};

}  // namespace waymark
