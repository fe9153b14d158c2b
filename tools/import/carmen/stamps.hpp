// SPDX-License-Identifier: BSD-3-Clause
// Chooses between the two times of a CARMEN line.
#pragma once

#include "common/time/time.hpp"
#include "import/log/import_report.hpp"

#include <optional>
#include <vector>

namespace waymark {

enum class CarmenStamps {
  kIpc,     ///< ipc_timestamp: when the message was sent
  kLogger,  ///< logger_timestamp: when it was written, in seconds since the logger started
};

struct CarmenTimes {
  Timestamp ipc{};
  Timestamp logger{};

  Timestamp by(CarmenStamps stamps) const { return stamps == CarmenStamps::kIpc ? ipc : logger; }
};

/// `wanted`, if given; else ipc_timestamp. If that gives fewer than 90 % of the scans ascending
/// times, and logger_timestamp gives more, then logger_timestamp, which is reported.
/// @throws SetupError when neither advances.
CarmenStamps choose_stamps(const std::vector<CarmenTimes>& scans,
                           std::optional<CarmenStamps> wanted, ImportReport& report);

}  // namespace waymark
