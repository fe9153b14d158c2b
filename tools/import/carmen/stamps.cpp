// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/stamps.hpp"

#include "common/errors/setup_error.hpp"
#include "import/log/time_order.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace waymark {
namespace {

constexpr double kGood = 0.9;  // least share of usable scans if only single stamps are wrong

/// Number of scans with distinct ascending times, after slight disorder has been sorted.
std::size_t num_usable(const std::vector<CarmenTimes>& scans, CarmenStamps stamps) {
  std::vector<Timestamp> times;
  for (const CarmenTimes& scan : scans)
    times.push_back(scan.by(stamps));
  std::vector<Timestamp> settled;
  for (const std::size_t index : order_within_tolerance(times))
    settled.push_back(times[index]);
  return static_cast<std::size_t>(std::ranges::count(longest_ascending(settled), true));
}

}  // namespace

CarmenStamps choose_stamps(const std::vector<CarmenTimes>& scans,
                           std::optional<CarmenStamps> wanted, ImportReport& report) {
  const std::size_t by_ipc = num_usable(scans, CarmenStamps::kIpc);
  const bool ipc_is_good = static_cast<double>(by_ipc) >= kGood * static_cast<double>(scans.size());
  if (ipc_is_good && !wanted) return CarmenStamps::kIpc;
  const std::size_t by_logger = num_usable(scans, CarmenStamps::kLogger);
  if (scans.size() > 1 && std::max(by_ipc, by_logger) <= 1) {
    throw SetupError{fmt::format(
        "all {} scans have the same time, by ipc_timestamp and by logger_timestamp: the log has "
        "no times",
        scans.size())};
  }
  if (wanted || by_logger <= by_ipc) return wanted.value_or(CarmenStamps::kIpc);
  report.note(fmt::format(
      "ipc_timestamp advances in {} of {} scans only, logger_timestamp in {}: the latter is taken; "
      "--stamps ipc says otherwise",
      by_ipc, scans.size(), by_logger));
  return CarmenStamps::kLogger;
}

}  // namespace waymark
