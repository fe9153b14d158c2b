// SPDX-License-Identifier: BSD-3-Clause
// A process in lockstep over real LCM: what it says of itself while it runs.
#include "common/bus/bus.hpp"
#include "common/lockstep/master.hpp"
#include "common/runtime/run_process.hpp"
#include "support/lcm_network.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

namespace waymark {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using testing_support::PrivateNetwork;

constexpr Channel<process_status_t> kListenerStatus{"LISTENER_STATUS"};

/// Hears odometry, and does nothing with it.
class Listener final : public Node {
 public:
  explicit Listener(Inbox& inbox) {
    inbox.on<pose2D_t>(channels::kOdometry, [](const pose2D_t&) {});
  }

  void finish() override {}
};

int run_listener(const std::string& url) {
  std::vector<std::string> words{"waymark-listener", "--lcm-url", url};
  std::vector<char*> arguments;
  for (std::string& word : words)
    arguments.push_back(word.data());
  return run_described_process(static_cast<int>(arguments.size()), arguments.data(),
                               {.traits = {"listener", "Listens.", false},
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
  std::thread process{run_listener, network.url()};
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
        master.take(*message);
      } else if (const auto status = decode<process_status_t>(message->payload); status.message) {
        refused = count_in(*status.message, "ODOMETRY rejected: trailing bytes");
      }
    }
  }
  bus.publish(master.closing());
  process.join();

  EXPECT_GT(refused, 0);
}

}  // namespace
}  // namespace waymark
