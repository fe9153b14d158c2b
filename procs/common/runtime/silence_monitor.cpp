// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/silence_monitor.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace waymark {
namespace {

using std::chrono::duration;

constexpr std::chrono::seconds kMissing{10};
constexpr std::chrono::seconds kSilent{2};
constexpr int kSilentPeriods = 3;
// After a longer pause between two checks this process itself was stopped, and what has come
// meanwhile is yet to be received.
constexpr std::chrono::seconds kStopped{1};
constexpr std::size_t kMaxNamed = 10;

double seconds_of(HeardChannel::Time::duration span) {
  return duration<double>{span}.count();
}

/// Every live process sends a status, also on a network without a robot.
bool is_status(std::string_view name) {
  return name.ends_with("_STATUS");
}

/// How long the channel may be silent.
HeardChannel::Time::duration longest_pause(const HeardChannel& heard) {
  const auto period = (heard.last - heard.first) / std::max<std::int64_t>(1, heard.count - 1);
  return std::max<HeardChannel::Time::duration>(kSilent, kSilentPeriods * period);
}

}  // namespace

SilenceMonitor::SilenceMonitor(const std::vector<std::string_view>& needed,
                               const std::vector<Inbox::Subscription>& wanted,
                               const ChannelNames& names, std::string url, Time start)
    : names_{names}, url_{std::move(url)}, start_{start}, last_check_{start} {
  for (const std::string_view name : needed)
    needed_.push_back({std::string{name}, std::string{names.on_network(name)}});
  for (const Inbox::Subscription& subscription : wanted)
    wanted_on_network_.emplace_back(names.on_network(subscription.channel));
}

std::vector<SilenceMonitor::Line> SilenceMonitor::check(const HeardChannels& heard, Time now) {
  const bool was_stopped = now - std::exchange(last_check_, now) > kStopped;
  if (was_stopped) return {};
  std::vector<Line> lines;
  if (now - start_ > kMissing && !std::exchange(is_missing_said_, true)) lines = missing(heard);
  for (Channel& channel : needed_) {
    const auto found = heard.find(channel.name_on_network);
    if (found == heard.end()) continue;
    if (auto line = change(channel, found->second, now)) lines.push_back(std::move(*line));
  }
  return lines;
}

/// A line for each needed channel that has not come; one for the network if nothing has.
std::vector<SilenceMonitor::Line> SilenceMonitor::missing(const HeardChannels& heard) const {
  std::vector<std::string> unknown;
  bool is_any_data = false;
  for (const auto& [name, channel] : heard) {
    is_any_data = is_any_data || !is_status(name);
    if (!names_.has_on_network(name) && unknown.size() < kMaxNamed) unknown.push_back(name);
  }
  using logging::Level;
  const bool is_any_wanted = std::ranges::any_of(
      wanted_on_network_, [&](const auto& name) { return heard.contains(name); });
  if (!is_any_data && (!needed_.empty() || !is_any_wanted)) {
    return {{Level::kWarn,
             fmt::format("nothing has come on {} so far; is it the robot's LCM network?", url_)}};
  }
  const std::string instead =
      unknown.empty()
          ? "does its driver run?"
          : fmt::format("heard on this network: {} (see [channels])", fmt::join(unknown, ", "));
  std::vector<Line> lines;
  for (const Channel& channel : needed_) {
    if (heard.contains(channel.name_on_network)) continue;
    const std::string called = channel.name == channel.name_on_network
                                   ? channel.name
                                   : channel.name + " (here " + channel.name_on_network + ")";
    lines.push_back({Level::kWarn, fmt::format("no {} so far; {}", called, instead)});
  }
  if (needed_.empty() && !is_any_wanted && !unknown.empty())
    lines.push_back({Level::kWarn, "none of the channels of this process so far; " + instead});
  return lines;
}

/// Whether the channel has fallen silent, or is back.
std::optional<SilenceMonitor::Line> SilenceMonitor::change(Channel& channel,
                                                           const HeardChannel& heard, Time now) {
  using logging::Level;
  if (channel.silent_since && heard.last > *channel.silent_since) {
    const double silent_s = seconds_of(heard.last - *std::exchange(channel.silent_since, {}));
    return Line{Level::kInfo, fmt::format("{} is back after {:.1f} s", channel.name, silent_s)};
  }
  if (channel.silent_since || now - heard.last < longest_pause(heard)) return std::nullopt;
  channel.silent_since = heard.last;
  return Line{Level::kWarn, fmt::format("{} has been silent for {:.1f} s: does its driver run?",
                                        channel.name, seconds_of(now - heard.last))};
}

}  // namespace waymark
