// SPDX-License-Identifier: BSD-3-Clause
// Which of the two times of a CARMEN line is the time of its scan.
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

/// As wanted, else by ipc_timestamp, unless these stand still or jump about and logger_timestamp
/// gives more scans a time of their own, which is said.
/// @throws SetupError when neither advances
CarmenStamps choose_stamps(const std::vector<CarmenTimes>& scans,
                           std::optional<CarmenStamps> wanted, ImportReport& report);

}  // namespace waymark
