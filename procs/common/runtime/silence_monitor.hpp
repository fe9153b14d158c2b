// SPDX-License-Identifier: BSD-3-Clause
// Names channels that a process needs and that are missing or have fallen silent (real time only).
#pragma once

#include "common/bus/channel_names.hpp"
#include "common/bus/heard_channels.hpp"
#include "common/logging/logging.hpp"
#include "common/node/node.hpp"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// Says once that a needed channel has not come for 10 s since the start, and which channels
/// without a meaning to us have come instead; once in each silence of more than 2 s, that it is
/// silent; and when it is back. A channel that usually comes more seldom may be silent for three of
/// its periods.
class SilenceMonitor {
 public:
  using Time = HeardChannel::Time;

  struct Line {
    logging::Level level{logging::Level::kInfo};
    std::string text{};
  };

  /// @param needed  may be empty: then only a network without any of the process's channels is
  ///                reported.
  /// @param wanted  all channels of the process.
  SilenceMonitor(const std::vector<std::string_view>& needed,
                 const std::vector<Inbox::Subscription>& wanted, const ChannelNames& names,
                 std::string url, Time start);

  /// To be called a few times a second.
  /// @return what is to be logged.
  std::vector<Line> check(const HeardChannels& heard, Time now);

 private:
  struct Channel {
    std::string name{};
    std::string name_on_network{};
    std::optional<Time> silent_since{};
  };

  std::vector<Line> missing(const HeardChannels& heard) const;
  static std::optional<Line> change(Channel& channel, const HeardChannel& heard, Time now);

  std::vector<Channel> needed_{};
  std::vector<std::string> wanted_on_network_{};
  ChannelNames names_;
  std::string url_;
  Time start_;
  Time last_check_;
  bool is_missing_said_{false};
};

}  // namespace waymark
