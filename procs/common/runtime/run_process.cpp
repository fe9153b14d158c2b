// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/run_process.hpp"

#include "common/bus/bus.hpp"
#include "common/errors/exit_codes.hpp"
#include "common/lockstep/participant.hpp"
#include "common/log/log_file.hpp"
#include "common/logging/logging.hpp"
#include "common/runtime/guard.hpp"
#include "common/runtime/reorder_buffer.hpp"
#include "common/runtime/replay.hpp"
#include "common/runtime/signals.hpp"
#include "common/runtime/silence_monitor.hpp"
#include "common/runtime/status.hpp"
#include "common/runtime/supervisor.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <utility>

namespace waymark {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr milliseconds kPoll{50};
// How long a participant that has finished answers re-sent ticks if the closing TICK is lost.
constexpr seconds kLinger{5};
constexpr milliseconds kBetweenChecks{250};  // of what is silent
// Without ticks for this long, the user gets a hint. The simulator re-sends a tick sooner.
constexpr seconds kNothingHint{10};
constexpr seconds kSilence{1};  // after this long without a message, no delayed one is expected
// How long received messages are still processed after a stop signal.
constexpr seconds kDrain{2};
// Longer than the jitter between our processes, shorter than the default LiDAR's period.
constexpr Duration kReorderWindow = milliseconds{150};

void publish_all(Bus& bus, const std::vector<Message>& messages) {
  for (const Message& message : messages)
    bus.publish(message);
}

bool is_command(std::string_view channel) {
  return channel == channels::kMbotSystemReset.name;
}

/// Statuses and MBOT_SYSTEM_RESET belong to no tick and have no sensor's stamp: they are delivered
/// at once.
bool is_untimed(std::string_view channel) {
  return channel.ends_with("_STATUS") || is_command(channel);
}

std::vector<std::string> names_in_ticks(const std::vector<Inbox::Subscription>& subscriptions) {
  std::vector<std::string> names;
  for (const auto& subscription : subscriptions) {
    if (!is_untimed(subscription.channel)) names.push_back(subscription.channel);
  }
  return names;
}

/// Lets a node be made or checked. @throws SetupError also for a file that cannot be examined.
template <class Work>
auto set_up(const Work& work) {
  try {
    return work();
  } catch (const std::filesystem::filesystem_error& error) {
    throw SetupError{fmt::format("{}: {}", error.path1().string(), error.code().message())};
  }
}

/// Where a live process listens, and how.
struct Network {
  std::string url;
  ChannelNames names;
  LargeMessages large_messages;  ///< for real time; in lockstep nobody sends them
  std::optional<double> for_s;   ///< in real time: how long to listen; nullopt: until a signal
};

/// Thrown through LockstepParticipant, so that a tick on which the node failed is not acknowledged.
struct NodeFailed {};

void deliver_or_fail(const std::vector<Message>& messages, Inbox& inbox) {
  const bool is_working = run_and_log_errors([&] {
    for (const Message& message : messages)
      inbox.deliver(message);
  });
  if (!is_working) throw NodeFailed{};
}

/// Tells the user why a run may have stopped; each log line once.
class LockstepHints {
 public:
  /// @param silence  since the last TICK, or since the start.
  void give(const LockstepParticipant& participant, steady_clock::duration silence) {
    if (participant.has_heard_another_run() && !std::exchange(is_other_run_said_, true)) {
      logging::warn(
          "another run uses this network, too: if its simulator has replaced the one of this "
          "process, start this process again");
    }
    if (silence <= kNothingHint || participant.finished()) return;
    if (!participant.has_seen_tick()) {
      if (!std::exchange(is_no_tick_said_, true))
        logging::info("no TICK so far: start waymark-sim, or use --real-time with a real robot");
    } else if (!std::exchange(is_silence_said_, true)) {
      logging::warn("no TICK for {} s: if waymark-sim has ended, stop this process, too",
                    kNothingHint.count());
    }
  }

 private:
  bool is_other_run_said_{false};
  bool is_no_tick_said_{false};
  bool is_silence_said_{false};
};

/// Live, in step with the simulator, until its last tick.
int run_lockstep(const ProcessTraits& traits, const Network& network, Node& node, Inbox& inbox,
                 Outbox& outbox) {
  std::vector<Inbox::Subscription> subscriptions = inbox.subscriptions();
  if (std::erase_if(subscriptions, [](const auto& s) { return is_command(s.channel); }) > 0)
    logging::warn("{} is not heard in lockstep: it belongs to no tick",
                  channels::kMbotSystemReset.name);
  LockstepParticipant participant{std::string{traits.name}, names_in_ticks(subscriptions),
                                  traits.joins_midway,
                                  [&](const std::vector<Message>& messages, bool is_last) {
                                    deliver_or_fail(messages, inbox);
                                    if (is_last) node.finish();
                                    return outbox.take();
                                  },
                                  inbox.counters()};
  for (auto& subscription : subscriptions)
    subscription.backlog = Backlog::kKeepAll;
  for (const auto name : {channels::kTick.name, channels::kAck.name}) {
    subscriptions.push_back({std::string{name}});
  }
  Bus bus{network.url, subscriptions, LargeMessages::kRefused, network.names};
  StatusReporter reporter{traits.name};
  logging::info("ready, waits for ticks on {}", network.url);
  auto last_tick = steady_clock::now();
  Timestamp newest{};
  LockstepHints hints;
  while (!participant.closed() && stop_signal() == 0) {
    auto message = bus.receive(kPoll);
    if (message && is_untimed(message->channel)) {
      deliver_or_fail({*message}, inbox);
    } else if (message) {
      if (message->channel == channels::kTick.name) last_tick = steady_clock::now();
      newest = std::max(newest, message->time);
      publish_all(bus, participant.handle(std::move(*message)));
    }
    const auto silence = steady_clock::now() - last_tick;
    if (participant.finished() && silence > kLinger) break;
    hints.give(participant, silence);
    reporter.report(bus, inbox.counters(), newest, "lockstep");
  }
  bus.collect_counts(inbox.counters());
  log_counters(inbox.counters());
  if (participant.finished()) return node.failed() ? kExitFailed : kExitOk;
  if (stop_signal() == 0) {
    logging::error("the simulator ended the run before its last tick");
    return kExitFailed;
  }
  return kExitSignal + stop_signal();
}

/// Receives messages in real time, puts them in order, and delivers them to the node.
class RealTimeFeed {
 public:
  // A node with one input needs no reordering.
  RealTimeFeed(Bus& bus, Inbox& inbox, Outbox& outbox)
      : bus_{bus},
        inbox_{inbox},
        outbox_{outbox},
        buffer_{inbox.subscriptions().size() > 1 ? kReorderWindow : Duration{0}} {}

  /// Receives one message. @return false when none comes within the timeout.
  bool receive_one(milliseconds timeout) {
    auto message = bus_.receive(timeout);
    if (!message) return false;
    last_arrival_ = steady_clock::now();
    if (is_untimed(message->channel)) {
      deliver({*message});
      return true;
    }
    newest_ = std::max(newest_, message->time);
    deliver(buffer_.add(std::move(*message), inbox_.counters()));
    return true;
  }

  void flush() { deliver(buffer_.flush()); }

  /// nullopt when no message has come yet.
  std::optional<steady_clock::time_point> last_arrival() const { return last_arrival_; }

  Timestamp newest() const { return newest_; }

 private:
  void deliver(const std::vector<Message>& messages) {
    for (const Message& message : messages)
      inbox_.deliver(message);
    publish_all(bus_, outbox_.take());
  }

  Bus& bus_;
  Inbox& inbox_;
  Outbox& outbox_;
  ReorderBuffer buffer_;
  std::optional<steady_clock::time_point> last_arrival_{};
  Timestamp newest_{};
};

/// Several times a second: logs which channels are silent, and polls the node.
class WallClockChecks {
 public:
  WallClockChecks(const Bus& bus, const Network& network, Node& node, const Inbox& inbox)
      : bus_{bus},
        names_{network.names},
        node_{node},
        monitor_{node.needed_channels(), inbox.subscriptions(), network.names, network.url,
                 steady_clock::now()} {}

  void run_when_due() {
    const auto now = steady_clock::now();
    if (now - last_ < kBetweenChecks) return;
    last_ = now;
    const HeardChannels heard = bus_.heard();
    for (const SilenceMonitor::Line& line : monitor_.check(heard, now))
      logging::write(line.level, line.text);
    node_.poll({now, [&](std::string_view channel) -> std::optional<double> {
                  const auto found = heard.find(names_.on_network(channel));
                  if (found == heard.end()) return std::nullopt;
                  return std::chrono::duration<double>{now - found->second.last}.count();
                }});
  }

 private:
  const Bus& bus_;
  const ChannelNames& names_;
  Node& node_;
  SilenceMonitor monitor_;
  steady_clock::time_point last_{};
};

/// Live: processes what arrives until a signal asks to stop, the time is over, or the node throws.
int run_real_time(const ProcessTraits& traits, const Network& network, Node& node, Inbox& inbox,
                  Outbox& outbox) {
  Bus bus{network.url, inbox.subscriptions(), network.large_messages, network.names,
          Publishers::kOnePerChannel};
  StatusReporter reporter{traits.name};
  RealTimeFeed feed{bus, inbox, outbox};
  logging::info("ready, real time on {}", network.url);
  notify_supervisor(kReady);
  WallClockChecks checks{bus, network, node, inbox};
  bool is_working = true;
  const auto start = steady_clock::now();
  const auto is_time_over = [&] {
    const std::chrono::duration<double> listened = steady_clock::now() - start;
    return network.for_s && listened.count() >= *network.for_s;
  };
  while (is_working && stop_signal() == 0 && !is_time_over()) {
    const auto last = feed.last_arrival();
    is_working = run_and_log_errors([&] {
      if (!feed.receive_one(kPoll) && last && steady_clock::now() - *last > kSilence) feed.flush();
      checks.run_when_due();
    });
    if (reporter.report(bus, inbox.counters(), feed.newest(), "real-time"))
      notify_supervisor(kAlive);
  }
  notify_supervisor(kStopping);
  const auto stop = steady_clock::now();
  is_working = is_working && run_and_log_errors([&] {
                 while (steady_clock::now() - stop < kDrain && feed.receive_one(milliseconds{0})) {
                 }
                 feed.flush();
               });
  node.finish();
  publish_all(bus, outbox.take());
  bus.collect_counts(inbox.counters());
  log_counters(inbox.counters());
  if (!feed.last_arrival())
    logging::error("nothing came on {} on the channels of this process", network.url);
  return !is_working || !feed.last_arrival() || node.failed() ? kExitFailed : kExitOk;
}

}  // namespace

int run_described_process(int argc, char** argv, const ProcessDescription& description) {
  const ParsedOptions parsed =
      parse_options(argc, argv, description.traits, description.option_set);
  if (parsed.exit_code) return *parsed.exit_code;
  const ProcessOptions& options = parsed.options;
  return run_guarded(description.traits, [&] {
    if (options.check) {
      description.config.dump(options);
      check_options(options, description.option_set);
      set_up([&] { description.check_node(options); });
      if (options.logs.empty()) check_network(lcm_url_or_default(options.lcm_url));
      return int{kExitOk};
    }
    if (!options.print_config.empty()) {
      fmt::print("{}\n", description.config.value(options, options.print_config));
      return int{kExitOk};
    }
    if (options.dump_config) {
      fmt::print("{}", description.config.dump(options));
      return int{kExitOk};
    }
    check_options(options, description.option_set);
    if (options.print_channels) {
      print_channels(options.logs);
      return int{kExitOk};
    }
    Inbox inbox;
    Outbox outbox;
    const auto node = set_up([&] { return description.make_node(options, inbox, outbox); });
    if (!options.logs.empty()) return run_replay(options, *node, inbox, outbox);
    const Network network{
        lcm_url_or_default(options.lcm_url), description.config.channel_names(options),
        options.large_messages ? LargeMessages::kAccepted : LargeMessages::kRefused, options.for_s};
    const auto run = options.real_time ? run_real_time : run_lockstep;
    try {
      return run(description.traits, network, *node, inbox, outbox);
    } catch (const NodeFailed&) {
      node->finish();  // writes its files; its messages are not sent: they belong to no tick
      return int{kExitFailed};
    }
  });
}

}  // namespace waymark
