// SPDX-License-Identifier: BSD-3-Clause
// Processor time of the estimator, for the closing line; no result depends on it.
#pragma once

#include <cstdint>
#include <ctime>
#include <string>

namespace waymark {

/// Time of all threads of the process between start() and stop(), once per observation.
class UpdateTimer {
 public:
  void start() { started_ = std::clock(); }

  /// @param updated  the observation was weighed and mapped, not only followed by odometry
  void stop(bool updated);

  /// "estimator: N observations, M updates, S s of processor time, worst W ms, process P s": S is
  /// all observations', W the longest one's, P the whole process's so far.
  std::string summary() const;

 private:
  std::clock_t started_{0};
  std::clock_t total_{0};
  std::clock_t worst_{0};
  std::int64_t observations_{0};
  std::int64_t updates_{0};
};

}  // namespace waymark
