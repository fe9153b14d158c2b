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

/// The wanted stamps; else ipc_timestamp, or, if it stands still or jumps and logger_timestamp
/// gives more scans distinct times, logger_timestamp, which is reported.
/// @throws SetupError when neither advances.
CarmenStamps choose_stamps(const std::vector<CarmenTimes>& scans,
                           std::optional<CarmenStamps> wanted, ImportReport& report);

}  // namespace waymark
