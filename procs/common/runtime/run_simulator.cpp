// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/run_simulator.hpp"

#include "common/bus/bus.hpp"
#include "common/bus/simulator_lock.hpp"
#include "common/errors/exit_codes.hpp"
#include "common/lockstep/command_relay.hpp"
#include "common/lockstep/master.hpp"
#include "common/log/log_file.hpp"
#include "common/logging/logging.hpp"
#include "common/runtime/guard.hpp"
#include "common/runtime/progress.hpp"
#include "common/runtime/signals.hpp"
#include "common/runtime/status.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <span>

namespace waymark {
namespace {

using std::chrono::duration_cast;
using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr milliseconds kProbePeriod{100};
constexpr seconds kReadyTimeout{30};
constexpr milliseconds kFirstResend{250};
constexpr milliseconds kLongestResend{4000};
constexpr seconds kSilenceTimeout{60};
constexpr milliseconds kReceiveFor{20};
constexpr int kClosingRepeats = 3;

/// Wall-clock side of a run: network, time-outs, progress.
class Run {
 public:
  Run(const ProcessTraits& traits, const std::string& url, const ChannelNames& names,
      TickSource& source, Inbox& inbox)
      : source_{source},
        inbox_{inbox},
        reporter_{traits.name},
        bus_{url, subscriptions(inbox), LargeMessages::kRefused, names},
        commands_{inbox.counters()} {}

  int in_lockstep() {
    LockstepMaster master{source_.run_id(), source_.participants(), source_.window_ticks()};
    if (const int code = wait_until_ready(master); code != kExitOk) return code;
    const int code = run_ticks(master);
    // Also after a signal or a time-out, so that no process waits for more ticks.
    for (int i = 0; i < kClosingRepeats; ++i)
      bus_.publish(master.closing());
    if (code == kExitOk) log_state_hashes(master);
    return code;
  }

  /// Paces the messages by the wall clock; no process acknowledges them.
  int in_real_time() {
    const auto start = steady_clock::now();
    while (!source_.finished()) {
      std::vector<Message> messages = source_.advance(tick_end_);
      std::ranges::sort(messages, comes_before);
      for (const Message& message : messages) {
        // The latency leaves time to simulate the first tick. Every later tick is simulated between
        // two messages, and delays those that are due meanwhile.
        const auto due = start + message.time.time_since_epoch() + kRealTimeLatency;
        while (stop_signal() == 0 && steady_clock::now() < due) {
          handle_commands(std::min<milliseconds>(
              kReceiveFor, duration_cast<milliseconds>(due - steady_clock::now())));
        }
        if (stop_signal() != 0) return kExitSignal + stop_signal();
        bus_.publish(message);
      }
      report("real-time");
    }
    return kExitOk;
  }

  void close() {
    progress_.done();
    const double simulated_s = to_seconds(tick_end_);
    const double wall_s = progress_.elapsed_s();
    logging::info("simulated {:.1f} s in {:.1f} s ({:.2f} x real time), peak memory {:.0f} MB",
                  simulated_s, wall_s, simulated_s / std::max(wall_s, 1e-9), peak_memory_mb());
    bus_.collect_counts(inbox_.counters());
    log_counters(inbox_.counters());
  }

 private:
  static constexpr milliseconds kRealTimeLatency{150};

  static std::vector<Inbox::Subscription> subscriptions(const Inbox& inbox) {
    std::vector<Inbox::Subscription> subscriptions = inbox.subscriptions();
    subscriptions.push_back({std::string{channels::kAck.name}});
    subscriptions.push_back({std::string{channels::kSlamCommand.name}});
    return subscriptions;
  }

  int wait_until_ready(LockstepMaster& master) {
    const auto start = steady_clock::now();
    auto last_probe = start - kProbePeriod;
    while (!master.all_ready()) {
      const auto now = steady_clock::now();
      if (stop_signal() != 0) return kExitSignal + stop_signal();
      if (now - start > kReadyTimeout) {
        logging::error("not ready after {} s: {} (is it running, with the same --lcm-url?)",
                       kReadyTimeout.count(), fmt::join(master.not_ready(), ", "));
        return kExitTimeout;
      }
      if (now - last_probe >= kProbePeriod) {
        bus_.publish(master.probe());
        last_probe = now;
      }
      handle_messages(master, kReceiveFor);
    }
    logging::info("all ready: {}", fmt::join(source_.participants(), ", "));
    return kExitOk;
  }

  int run_ticks(LockstepMaster& master) {
    steady_clock::time_point last_ack = steady_clock::now();
    milliseconds resend_after = kFirstResend;
    auto last_sent = last_ack;
    while (!(source_.finished() && master.all_acknowledged())) {
      if (stop_signal() != 0) return kExitSignal + stop_signal();
      const bool may_advance = !source_.finished() && master.has_room();
      if (may_advance) {
        send_tick(master);
        last_sent = steady_clock::now();
      }
      if (handle_messages(master, may_advance ? milliseconds{0} : kReceiveFor)) {
        last_ack = steady_clock::now();
        resend_after = kFirstResend;
      }
      const auto now = steady_clock::now();
      if (!master.all_acknowledged() && now - last_ack > kSilenceTimeout) {
        return report_silent(master);
      }
      if (!may_advance && now - std::max(last_ack, last_sent) > resend_after) {
        publish(master.resend());
        inbox_.counters().add("TICK resent");
        last_sent = now;
        resend_after = std::min(2 * resend_after, kLongestResend);
      }
      report("lockstep");
    }
    return kExitOk;
  }

  static void log_state_hashes(const LockstepMaster& master) {
    for (const auto& [who, hash] : master.state_hashes()) {
      if (hash == 0) continue;  // it has published nothing, like the recorder
      logging::info("state hash of {}: {:016x}", who, static_cast<std::uint64_t>(hash));
    }
  }

  void send_tick(LockstepMaster& master) {
    std::vector<Message> messages = source_.advance(tick_end_);
    commands_.move_into(messages, tick_end_);
    publish(master.open_tick(tick_end_, std::move(messages), source_.finished()));
  }

  /// Handles the messages that come within the timeout. @return true when a missing acknowledgement
  /// was among them.
  bool handle_messages(LockstepMaster& master, milliseconds timeout) {
    bool acknowledged = false;
    for (auto message = bus_.receive(timeout); message; message = bus_.receive(milliseconds{0})) {
      if (message->channel == channels::kAck.name) {
        acknowledged = master.handle(*message) || acknowledged;
      } else if (message->channel == channels::kSlamCommand.name) {
        commands_.handle(*message);
      } else {
        inbox_.deliver(*message);
      }
    }
    return acknowledged;
  }

  void handle_commands(milliseconds timeout) {
    if (auto message = bus_.receive(timeout)) inbox_.deliver(*message);
  }

  int report_silent(const LockstepMaster& master) const {
    const std::vector<std::string> silent = master.silent();
    const std::span waiting = std::span{silent}.subspan(1);
    logging::error(
        "no acknowledgement of tick {} ({:.1f} s simulated) for {} s from {}{}",
        master.oldest_open_tick(), to_seconds(tick_end_), kSilenceTimeout.count(), silent.front(),
        waiting.empty() ? "" : fmt::format("; waiting behind it: {}", fmt::join(waiting, ", ")));
    return kExitTimeout;
  }

  void publish(const std::vector<Message>& messages) {
    for (const Message& message : messages)
      bus_.publish(message);
  }

  void report(std::string_view state) {
    const double simulated_s = to_seconds(tick_end_);
    progress_.show(
        source_.progress_fraction(),
        fmt::format("{:.1f} s simulated, {:.1f} x real time, {}", simulated_s,
                    simulated_s / std::max(progress_.elapsed_s(), 1e-9), source_.progress_text()));
    reporter_.report(bus_, inbox_.counters(), tick_end_, state);
  }

  TickSource& source_;
  Inbox& inbox_;
  StatusReporter reporter_;
  Bus bus_;
  CommandRelay commands_;
  Progress progress_{"sim"};
  Timestamp tick_end_{};
};

/// Null in real time, where receivers accept one publisher per channel (ChannelOwners).
std::unique_ptr<SimulatorLock> lock_of(const ProcessOptions& options,
                                       const SimulatorDescription& description) {
  if (options.real_time) return nullptr;
  return std::make_unique<SimulatorLock>(lcm_url_or_default(options.lcm_url),
                                         description.config.channel_names(options));
}

/// Option --check: builds the world and joins the network, but writes no file.
int check(ProcessOptions options, const SimulatorDescription& description) {
  options.out_dir.clear();
  Inbox inbox;
  description.make_source(options, inbox);
  check_network(lcm_url_or_default(options.lcm_url));
  lock_of(options, description);
  return kExitOk;
}

}  // namespace

int run_described_simulator(int argc, char** argv, const SimulatorDescription& description) {
  const ParsedOptions parsed = parse_options(argc, argv, description.traits, kSimulatorOptions);
  if (parsed.exit_code) return *parsed.exit_code;
  const ProcessOptions& options = parsed.options;
  return run_guarded(description.traits, [&] {
    if (options.check) return check(options, description);
    if (!options.print_config.empty()) {
      fmt::print("{}\n", description.config.value(options, options.print_config));
      return int{kExitOk};
    }
    if (options.dump_config || options.dump_robot_config) {
      fmt::print("{}", options.dump_config ? description.config.dump(options)
                                           : description.dump_robot_config(options));
      return int{kExitOk};
    }
    for (const std::string_view file : description.files)
      protect_inputs("--out", options.out_dir / file, inputs_of(options));
    Inbox inbox;
    const auto source = description.make_source(options, inbox);
    const auto lock = lock_of(options, description);
    Run run{description.traits, lcm_url_or_default(options.lcm_url),
            description.config.channel_names(options), *source, inbox};
    source->begin();
    const int code = options.real_time ? run.in_real_time() : run.in_lockstep();
    source->finish();
    run.close();
    return code;
  });
}

}  // namespace waymark
