// SPDX-License-Identifier: BSD-3-Clause
// Processor time of the estimator, for the log at the end; no result depends on it.
#pragma once

#include <cstdint>
#include <ctime>
#include <string>

namespace waymark {

/// Processor time of all threads of the process between start() and stop(), once per observation.
class UpdateTimer {
 public:
  void start() { started_ = std::clock(); }

  /// @param updated  as Estimate::updated.
  void stop(bool updated);

  /// "estimator: N observations, M updates, S s of processor time, worst W ms, process P s": S for
  /// all observations, W for the slowest one, P for the whole process so far.
  std::string summary() const;

 private:
  std::clock_t started_{0};
  std::clock_t total_{0};
  std::clock_t worst_{0};
  std::int64_t observations_{0};
  std::int64_t updates_{0};
};

}  // namespace waymark
