// SPDX-License-Identifier: BSD-3-Clause
// Processes in lockstep over real LCM: what they log while they run, and how a run ends.
#include "common/bus/bus.hpp"
#include "common/errors/exit_codes.hpp"
#include "common/lockstep/master.hpp"
#include "common/lockstep/participant.hpp"
#include "common/runtime/run_process.hpp"
#include "common/runtime/run_simulator.hpp"
#include "support/lcm_network.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

namespace waymark {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using ::testing::HasSubstr;
using testing_support::PrivateNetwork;

constexpr Channel<process_status_t> kListenerStatus{"LISTENER_STATUS"};

/// Receives odometry and ignores it.
class Listener final : public Node {
 public:
  explicit Listener(Inbox& inbox) {
    inbox.on<pose2D_t>(channels::kOdometry, [](const pose2D_t&) {});
  }

  void finish() override {}
};

struct Arguments {
  explicit Arguments(const std::string& url) : words{"program", "--lcm-url", url} {
    for (std::string& word : words)
      pointers.push_back(word.data());
  }

  std::vector<std::string> words;
  std::vector<char*> pointers{};
};

/// @param name  unique in this program, as a logger has the same name.
int run_listener(const std::string& url, std::string_view name) {
  Arguments arguments{url};
  return run_described_process(static_cast<int>(arguments.pointers.size()),
                               arguments.pointers.data(),
                               {.traits = {name, "Listens.", false},
                                .make_node = [](const ProcessOptions&, Inbox& inbox, Outbox&) {
                                  return std::make_unique<Listener>(inbox);
                                }});
}

Message with_a_byte_too_many(Message message) {
  message.payload.push_back(0);
  return message;
}

std::int64_t count_in(const process_status_t& status, const std::string& name) {
  const auto found = std::ranges::find(status.counters, name, &counter_t::name);
  return found == status.counters.end() ? 0 : found->value;
}

TEST(LockstepProcess, TheStatusCountsMessagesThatTheNodeRejected) {
  const PrivateNetwork network;
  Bus bus{network.url(), {{std::string{channels::kAck.name}}, {std::string{kListenerStatus.name}}}};
  std::thread process{run_listener, network.url(), "listener"};
  LockstepMaster master{1, {"listener"}, 1};

  std::int64_t refused = 0;
  const auto end = steady_clock::now() + std::chrono::seconds{20};
  while (refused == 0 && steady_clock::now() < end) {
    if (!master.all_ready()) {
      bus.publish(master.probe());
    } else if (master.has_room()) {
      const Message bad = with_a_byte_too_many(encode(channels::kOdometry, pose2D_t{}));
      for (const Message& message : master.open_tick({}, {bad}, false))
        bus.publish(message);
    }
    while (const auto message = bus.receive(milliseconds{100})) {
      if (message->channel == channels::kAck.name) {
        master.handle(*message);
      } else if (const auto status = decode<process_status_t>(message->payload); status.message) {
        refused = count_in(*status.message, "ODOMETRY rejected: trailing bytes");
      }
    }
  }
  bus.publish(master.closing());
  process.join();

  EXPECT_GT(refused, 0);
}

/// Opens one tick that the listener acknowledges.
void begin_run(LockstepMaster& master, Bus& bus) {
  const auto end = steady_clock::now() + std::chrono::seconds{20};
  bool is_open = false;
  while (!(is_open && master.all_acknowledged()) && steady_clock::now() < end) {
    if (!master.all_ready()) {
      bus.publish(master.probe());
    } else if (!is_open) {
      bus.publish(master.open_tick({}, {}, false).back());
      is_open = true;
    }
    while (const auto message = bus.receive(milliseconds{100}))
      master.handle(*message);
  }
  ASSERT_TRUE(is_open && master.all_acknowledged());
}

// The simulator is silent, as if killed, and another one begins.
TEST(LockstepProcess, SilenceAndAnotherRunAreReportedAndTheEndOfItsRunEndsIt) {
  const PrivateNetwork network;
  Bus bus{network.url(), {{std::string{channels::kAck.name}}}};
  int exit_code = kExitOk;
  ::testing::internal::CaptureStderr();
  std::thread process{[&] {
    exit_code = run_listener(network.url(), "waiting");
  }};
  LockstepMaster master{1, {"waiting"}, 1};
  begin_run(master, bus);

  std::this_thread::sleep_for(std::chrono::seconds{11});
  bus.publish(LockstepMaster{2, {"waiting"}, 1}.probe());
  std::this_thread::sleep_for(milliseconds{300});
  bus.publish(master.closing());
  process.join();

  const std::string output = ::testing::internal::GetCapturedStderr();
  EXPECT_EQ(exit_code, kExitFailed);
  EXPECT_THAT(output, HasSubstr("no TICK for 10 s"));
  EXPECT_THAT(output, HasSubstr("another run uses this network"));
  EXPECT_THAT(output, HasSubstr("ended the run before its last tick"));
}

/// A run without an end.
class Endless final : public TickSource {
 public:
  std::vector<std::string> participants() const override { return {"listener"}; }

  int window_ticks() const override { return 1; }

  std::int64_t run_id() const override { return 1; }

  void begin() override {}

  bool finished() const override { return false; }

  std::vector<Message> advance(Timestamp& tick_end) override {
    tick_end += milliseconds{100};
    return {};
  }

  double progress_fraction() const override { return 0.0; }

  std::string progress_text() const override { return ""; }

  void finish() override {}
};

int run_endless(const std::string& url) {
  Arguments arguments{url};
  return run_described_simulator(
      static_cast<int>(arguments.pointers.size()), arguments.pointers.data(),
      {.traits = {"sim", "Never ends.", false}, .make_source = [](const ProcessOptions&, Inbox&) {
         return std::make_unique<Endless>();
       }});
}

// The simulator is a process of its own, as it gets signals.
TEST(LockstepProcess, AStoppedSimulatorEndsTheRunOfTheOthers) {
  const PrivateNetwork network;
  const pid_t simulator = ::fork();
  ASSERT_GE(simulator, 0);
  if (simulator == 0) ::_exit(run_endless(network.url()));
  Bus bus{network.url(), {{std::string{channels::kTick.name}}}};
  Counters counters;
  int ticks = 0;
  LockstepParticipant listener{"listener",
                               {},
                               false,
                               [&ticks](const std::vector<Message>&, bool) {
                                 ++ticks;
                                 return std::vector<Message>{};
                               },
                               counters};
  bool is_stopped = false;
  const auto end = steady_clock::now() + std::chrono::seconds{20};
  while (!listener.closed() && steady_clock::now() < end) {
    if (auto message = bus.receive(milliseconds{100}))
      for (const Message& answer : listener.handle(std::move(*message)))
        bus.publish(answer);
    if (ticks < 5 || is_stopped) continue;
    ::kill(simulator, SIGTERM);
    is_stopped = true;
  }
  if (!is_stopped) ::kill(simulator, SIGKILL);
  int status = 0;
  ::waitpid(simulator, &status, 0);

  EXPECT_TRUE(listener.closed());
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), kExitSignal + SIGTERM);
}

}  // namespace
}  // namespace waymark
