// SPDX-License-Identifier: BSD-3-Clause
// Writes all data channels to an LCM log, in the order in which the other programs process the
// messages. It acknowledges ticks like them, so a lockstep run is recorded without loss and with
// the same bytes every time.
#pragma once

#include "common/config/config.hpp"
#include "common/log/log_file.hpp"
#include "common/node/node.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace waymark {

struct RecorderSection {
  std::vector<std::string> exclude{};  ///< channels not to record

  void describe(Fields& fields);
};

struct RecorderConfig {
  RecorderSection recorder{};
  std::filesystem::path out_log{};  ///< from --out-log

  void describe(Fields& fields) { fields.section("recorder", recorder); }

  void check(Problems& problems) const;
};

class RecorderNode final : public Node {
 public:
  using Config = RecorderConfig;
  static constexpr ProcessTraits kTraits{"recorder",
                                         "Records every data channel of a run to an LCM log (log "
                                         "time = message time). Statuses, ticks and "
                                         "acknowledgements are not data.",
                                         false};

  /// @throws SetupError if the log or its `.part` file exists, or cannot be created.
  RecorderNode(const RecorderConfig& config, Inbox& inbox, Outbox& outbox);

  void finish() override;

  /// Logs every 10 s how many messages of each channel have come in that time.
  void poll(const WallClock& clock) override;

  bool failed() const override { return failed_; }

 private:
  void record(const Message& message);
  void write(const Message& message);
  /// @param time  for those that were held back.
  void write_held_back(Timestamp time);
  void fail(const std::string& what);

  std::optional<LogWriter> writer_;
  Counters& counters_;
  std::vector<Message> held_back_{};  ///< without a stamp, before the first one with a stamp
  bool has_stamped_{false};
  std::map<std::string, std::int64_t, std::less<>> recent_{};  ///< messages since last_line_
  std::optional<std::chrono::steady_clock::time_point> last_line_{};
  bool failed_{false};
};

}  // namespace waymark
