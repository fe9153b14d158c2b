// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/replay.hpp"

#include "common/errors/exit_codes.hpp"
#include "common/files/whole_file.hpp"
#include "common/log/log_file.hpp"
#include "common/logging/logging.hpp"
#include "common/messages/channels.hpp"
#include "common/runtime/guard.hpp"
#include "common/runtime/progress.hpp"
#include "common/runtime/replay_report.hpp"
#include "common/runtime/signals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace waymark {
namespace {

/// One log, read ahead by one message, restricted to the channels that are read from it.
struct Source {
  std::filesystem::path path;
  LogReader reader;
  std::vector<std::string> all_channels;  ///< channels that occur in the log
  std::vector<std::string> channels{};    ///< channels that are read from it
  std::optional<Message> head{};

  void advance() {
    head = reader.next([this](std::string_view channel) {
      return std::ranges::find(channels, channel) != channels.end();
    });
  }
};

/// All channels of a group are read from the last log that has any of them. SLAM_* and MAP_*
/// channels, which belong together, are one group; any other channel is its own group.
std::string group_of(const std::string& channel) {
  constexpr std::string_view kSlam = "SLAM_";
  constexpr std::string_view kMap = "MAP_";
  return channel.starts_with(kSlam) || channel.starts_with(kMap) ? std::string{kSlam} : channel;
}

std::vector<Source> open_sources(const std::vector<std::filesystem::path>& paths,
                                 const std::vector<Inbox::Subscription>& subscriptions) {
  std::map<std::string, std::size_t> source_of_group;
  std::vector<Source> sources;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    try {
      sources.push_back({paths[i], LogReader{paths[i]}, channels_in(paths[i])});
    } catch (const std::exception& error) {
      throw SetupError{error.what()};
    }
    for (const std::string& channel : sources[i].all_channels)
      source_of_group[group_of(channel)] = i;
  }
  for (const auto& subscription : subscriptions) {
    const auto found = source_of_group.find(group_of(subscription.channel));
    if (found != source_of_group.end()) {
      sources[found->second].channels.push_back(subscription.channel);
    }
  }
  for (Source& source : sources)
    source.advance();
  return sources;
}

/// The source whose next message is oldest, the first one among equals; nullptr if all have ended.
Source* oldest(std::vector<Source>& sources) {
  Source* best = nullptr;
  for (Source& source : sources) {
    if (source.head && (best == nullptr || source.head->time < best->head->time)) best = &source;
  }
  return best;
}

/// Share of all logs' bytes that has been read, 0..1.
double share_read(const std::vector<Source>& sources) {
  std::int64_t read_bytes = 0;
  std::int64_t all_bytes = 0;
  for (const Source& source : sources) {
    read_bytes += source.reader.offset_bytes();
    all_bytes += source.reader.size_bytes();
  }
  return static_cast<double>(read_bytes) / static_cast<double>(all_bytes);
}

bool report_skipped(const std::vector<Source>& sources) {
  bool any = false;
  for (const Source& source : sources) {
    if (source.reader.skipped_bytes() == 0) continue;
    logging::error("{}: {} bytes from offset {} on are no events; skipped", source.path.string(),
                   source.reader.skipped_bytes(), source.reader.first_skipped_offset());
    any = true;
  }
  return any;
}

/// Reports each log that has no channel of this process, with the channels that it does have. (A
/// log whose channels are all replaced by later logs is not reported.)
/// @return whether that is an error: a log has no event, or no log has a channel of this process.
bool report_useless(const std::vector<Source>& sources,
                    const std::vector<Inbox::Subscription>& subscriptions) {
  std::vector<std::string> wanted;
  for (const auto& subscription : subscriptions)
    wanted.push_back(subscription.channel);
  const auto is_useful = [&](const Source& source) {
    return std::ranges::find_first_of(source.all_channels, wanted) != source.all_channels.end();
  };
  const bool any_useful = std::ranges::any_of(sources, is_useful);
  bool any_error = false;
  for (const Source& source : sources) {
    if (is_useful(source)) continue;
    const bool is_error = source.all_channels.empty() || !any_useful;
    any_error = any_error || is_error;
    if (source.all_channels.empty()) {
      logging::error("{}: has no LCM event; is it an LCM log?", source.path.string());
      continue;
    }
    logging::write(
        is_error ? logging::Level::kError : logging::Level::kWarn,
        fmt::format("{}: has none of the channels that this process reads ({}), but {}; {}",
                    source.path.string(), fmt::join(wanted, ", "),
                    fmt::join(source.all_channels, ", "),
                    is_error ? "logs of other robots are for waymark-import first"
                             : "the other logs are used without it"));
  }
  return any_error;
}

/// Channels that occur in the logs.
std::set<std::string, std::less<>> channels_held(const std::vector<Source>& sources) {
  std::set<std::string, std::less<>> held;
  for (const Source& source : sources)
    held.insert(source.all_channels.begin(), source.all_channels.end());
  return held;
}

/// Reports each needed channel that no log has, with the channels that the logs do have.
/// @return whether there is any.
bool report_missing(const std::vector<Source>& sources,
                    const std::vector<std::string_view>& needed) {
  const auto held = channels_held(sources);
  std::vector<std::string> names;
  for (const Source& source : sources)
    names.push_back(source.path.string());
  bool any = false;
  for (const std::string_view channel : needed) {
    if (held.empty() || held.contains(channel)) continue;
    any = true;
    logging::error(
        "{}: has no {}, but {}: did the driver run while it was recorded? Where the channel has "
        "another name, waymark-import mbot makes a log with ours",
        fmt::join(names, ", "), channel, fmt::join(held, ", "));
  }
  return any;
}

/// Warns if the logs have images, but not the detections in them, which this process reads.
void warn_of_unused_images(const std::vector<Source>& sources,
                           const std::vector<Inbox::Subscription>& subscriptions) {
  const auto is_wanted = [&](std::string_view channel) {
    return std::ranges::find(subscriptions, channel, &Inbox::Subscription::channel) !=
           subscriptions.end();
  };
  const auto held = channels_held(sources);
  if (!is_wanted(channels::kMarkers.name) || is_wanted(channels::kCamera.name) ||
      !held.contains(channels::kCamera.name) || held.contains(channels::kMarkers.name))
    return;
  logging::warn(
      "the log has images ({}), but no {}: the markers in them are not used. `waymark-detector "
      "--config robot.toml --log LOG --out-log FILE` finds them; then --log LOG --log FILE",
      channels::kCamera.name, channels::kMarkers.name);
}

std::optional<LogWriter> open_writer(const std::filesystem::path& file) {
  if (file.empty()) return std::nullopt;
  try {
    return std::optional<LogWriter>{std::in_place, file};
  } catch (const std::exception& error) {
    throw SetupError{error.what()};
  }
}

void log_report(const ReplayReport& report) {
  logging::info(
      "replayed {} messages, {:.1f} s of log in {:.2f} s ({:.1f} x real time), peak memory {:.0f} "
      "MB",
      report.messages, report.log_s, report.wall_s, report.real_time_factor(),
      report.peak_memory_mb);
}

}  // namespace

void print_channels(const std::vector<std::filesystem::path>& logs) {
  std::set<std::string> names;
  try {
    for (const std::filesystem::path& log : logs)
      for (std::string& name : channels_in(log))
        names.insert(std::move(name));
  } catch (const std::exception& error) {
    throw SetupError{error.what()};
  }
  for (const std::string& name : names)
    fmt::print("{}\n", name);
}

int run_replay(const ProcessOptions& options, Node& node, Inbox& inbox, Outbox& outbox) {
  std::vector<Source> sources = open_sources(options.logs, inbox.subscriptions());
  const bool useless = report_useless(sources, inbox.subscriptions());
  const bool missing = !useless && report_missing(sources, node.needed_channels());
  warn_of_unused_images(sources, inbox.subscriptions());
  if (oldest(sources) == nullptr) {
    report_skipped(sources);
    return kExitFailed;
  }
  std::optional<LogWriter> writer = open_writer(options.out_log);
  const auto write_out = [&] {
    for (const Message& message : outbox.take()) {
      if (writer) writer->write(message);
    }
  };
  Progress progress{"replay"};
  const Timestamp first = oldest(sources)->head->time;
  const Timestamp begin = first + duration_from_seconds(options.skip_s);
  const auto end = options.until_s ? std::optional{first + duration_from_seconds(*options.until_s)}
                                   : std::nullopt;
  Timestamp last = first;
  std::int64_t num_messages = 0;
  bool has_begun = false;  // for good: later messages may be stamped earlier, by a clock set back
  bool is_working = true;
  while (Source* source = oldest(sources)) {
    if (stop_signal() != 0) {
      logging::warn("interrupted");
      return kExitSignal + stop_signal();
    }
    if (end && source->head->time > *end) break;
    last = std::max(last, source->head->time);
    has_begun = has_begun || source->head->time >= begin;
    if (!has_begun) {
      source->advance();
      continue;
    }
    is_working = run_and_log_errors([&] { inbox.deliver(*source->head); });
    write_out();
    ++num_messages;
    if (!is_working) break;
    progress.show(share_read(sources), fmt::format("{:.1f} s", to_seconds(last - first)));
    source->advance();
  }
  if (num_messages == 0) {
    logging::error("nothing is left of the log, which is {:.1f} s long: see --skip-s and --until-s",
                   to_seconds(last - first));
    return kExitFailed;
  }
  node.finish();
  write_out();
  if (writer) writer->close();
  progress.done();
  const ReplayReport report{.messages = num_messages,
                            .log_s = to_seconds(last - begin),
                            .wall_s = progress.elapsed_s(),
                            .peak_memory_mb = peak_memory_mb()};
  log_report(report);
  if (!options.report.empty()) write_whole_file(options.report, to_json(report, inbox.counters()));
  log_counters(inbox.counters());
  const bool skipped = report_skipped(sources);
  return !is_working || useless || missing || skipped ||
                 inbox.counters().total(CountKind::kRejection) > 0 || node.failed()
             ? kExitFailed
             : kExitOk;
}

}  // namespace waymark
