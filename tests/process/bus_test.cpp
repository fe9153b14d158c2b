// SPDX-License-Identifier: BSD-3-Clause
// The bus over real LCM: no datagram may crash a receiver or make its memory grow.
#include "common/bus/bus.hpp"

#include "common/bus/simulator_lock.hpp"
#include "common/messages/codec.hpp"
#include "common/runtime/progress.hpp"
#include "common/runtime/run_process.hpp"
#include "support/lcm_network.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <thread>

namespace waymark {
namespace {

using std::chrono::milliseconds;
using testing_support::lcm_datagram;
using testing_support::lcm_fragment;
using testing_support::PrivateNetwork;

struct NoConfig {
  void describe(Fields&) {}
};

Message pose(std::int64_t utime_us) {
  pose2D_t message{};
  message.utime = utime_us;
  return encode(channels::kOdometry, message);
}

#ifdef __SANITIZE_ADDRESS__
constexpr bool kKeepsFreedMemory = true;  // AddressSanitizer does, to find uses of it
#else
constexpr bool kKeepsFreedMemory = false;
#endif

constexpr const char* kMalformed = "datagrams rejected: no whole message of LCM";
constexpr const char* kFragments =
    "datagrams rejected: parts of messages above 65 kB, which need --large-messages";
constexpr const char* kSomebodyElse = "ODOMETRY rejected: somebody else publishes, too";

class BusTest : public ::testing::Test {
 protected:
  /// All messages that arrive until 0.3 s pass without one.
  std::vector<Message> drain() {
    std::vector<Message> messages;
    while (auto message = bus_.receive(milliseconds{300}))
      messages.push_back(*message);
    return messages;
  }

  std::int64_t counted(const std::string& name) {
    bus_.collect_counts(counters_);
    return counters_.get(name);
  }

  PrivateNetwork network_;
  Bus bus_{network_.url(), {{"ODOMETRY", Backlog::kKeepAll}, {"CAMERA", Backlog::kNewestOnly}}};
  Counters counters_;
};

TEST_F(BusTest, DeliversInOrder) {
  for (int i = 0; i < 100; ++i)
    bus_.publish(pose(i));
  const auto messages = drain();
  ASSERT_EQ(messages.size(), 100U);
  for (int i = 0; i < 100; ++i)
    EXPECT_EQ(messages[static_cast<std::size_t>(i)], pose(i));
}

TEST_F(BusTest, NewestOnlyKeepsTheNewest) {
  image_t image{};
  image.width = image.height = 1;
  for (int i = 0; i < 10; ++i) {
    image.utime = i;
    bus_.publish(encode(channels::kCamera, image));
  }
  std::this_thread::sleep_for(
      milliseconds{200});  // so that all have arrived before the first is received
  const auto messages = drain();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(to_us(messages[0].time), 9);
  EXPECT_EQ(counted("CAMERA skipped: newer one came"), 9);
}

TEST_F(BusTest, PublishingAMessageAboveTheSizeLimitThrows) {
  Message large = pose(1);
  large.payload.resize(kMaxPayloadBytes + 1);
  EXPECT_THROW(bus_.publish(large), std::logic_error);
}

// The cases of research/lcm.md A11.
TEST_F(BusTest, CorruptDatagramsAreCountedAndTheNextMessageIsReceived) {
  const auto good = pose(5).payload;
  auto bad_magic = lcm_datagram("ODOMETRY", good);
  bad_magic[0] = 0;
  auto no_channel_end = lcm_datagram("ODOMETRY", {});
  no_channel_end.pop_back();
  for (const auto& datagram :
       {bad_magic, no_channel_end, std::vector<std::uint8_t>{1, 2}, std::vector<std::uint8_t>{},
        lcm_fragment(100, 0, 0, 0, good), lcm_fragment(0x7fffffff, 0, 0, 2, good),
        lcm_fragment(10, 0, 0, 2, std::vector<std::uint8_t>(1000)), lcm_datagram("ODOMETRY", {}),
        lcm_datagram("ODOMETRY", {1, 2, 3})}) {
    network_.send_datagram(datagram);
  }
  network_.send_datagram(lcm_datagram("ODOMETRY", good));
  const auto messages = drain();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0], pose(5));
  EXPECT_EQ(counted("ODOMETRY rejected: bad time"), 2);
  EXPECT_EQ(counted(kMalformed), 4);
  EXPECT_EQ(counted(kFragments), 3);
}

// Two fragments whose offset lies beyond the end of their message: liblcm 1.3.1 writes out of
// bounds.
TEST_F(BusTest, ForgedFragmentOffsetsAreRefused) {
  const std::vector<std::uint8_t> body(1000, 0x41);
  for (int i = 0; i < 100; ++i) {
    network_.send_datagram(lcm_fragment(3000, 0, 0, 3, body));
    network_.send_datagram(lcm_fragment(3000, 0xfffffff0, 1, 3, body));
  }
  bus_.publish(pose(9));
  const auto messages = drain();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0], pose(9));
  EXPECT_EQ(counted(kFragments), 200);
  EXPECT_EQ(counted(kMalformed), 0);
}

TEST(BusSetup, FragmentedMessagesAreReceivedWhereLargeOnesAreAllowed) {
  const PrivateNetwork network;
  Bus bus{network.url(), {{"CAMERA"}}, LargeMessages::kAccepted};
  std::vector<std::uint8_t> payload(80000);
  const auto stamped = pose(5).payload;
  std::copy(stamped.begin(), stamped.end(), payload.begin());
  const Message large{"CAMERA", pose(5).time, payload};
  const std::string channel{"CAMERA"};
  std::vector<std::uint8_t> first(channel.size() + 1 + 40000);
  std::copy(channel.begin(), channel.end(), first.begin());
  std::copy_n(payload.begin(), 40000,
              first.begin() + static_cast<std::ptrdiff_t>(channel.size() + 1));
  network.send_datagram(lcm_fragment(80000, 0, 0, 2, first));
  network.send_datagram(lcm_fragment(80000, 40000, 1, 2, {payload.begin() + 40000, payload.end()}));
  EXPECT_EQ(bus.receive(milliseconds{2000}), large);
}

TEST_F(BusTest, FragmentedMessagesAreRefusedUnlessLargeOnesAreAllowed) {
  std::vector<std::uint8_t> body{'O', 'D', 'O', 'M', 'E', 'T', 'R', 'Y', 0};
  body.resize(9 + 40000);
  network_.send_datagram(lcm_fragment(80000, 0, 0, 2, body));
  network_.send_datagram(lcm_fragment(80000, 40000, 1, 2, std::vector<std::uint8_t>(40000)));
  EXPECT_TRUE(drain().empty());
  EXPECT_EQ(counted(kFragments), 2);
}

TEST_F(BusTest, QueuesStayBoundedInAFlood) {
  Message large = pose(1);
  large.payload.resize(60000);
  const double before_mb = peak_memory_mb();
  const auto flood = [&](int datagrams) {
    for (int i = 0; i < datagrams; ++i)
      network_.send_datagram(lcm_datagram("ODOMETRY", large.payload));
  };
  // A queue holds 16 MB. On a busy machine the kernel drops most datagrams before the bus gets
  // them.
  const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds{60};
  while (counted("ODOMETRY dropped: queue full") == 0) {
    ASSERT_LT(std::chrono::steady_clock::now(), give_up) << "the queue does not fill";
    flood(300);
  }
  flood(2000);  // 120 MB
  if (!kKeepsFreedMemory) {
    EXPECT_LT(peak_memory_mb() - before_mb, 100.0);
  }
  std::size_t held_bytes = 0;
  for (const Message& message : drain())
    held_bytes += message.payload.size();
  EXPECT_LT(held_bytes, 20U << 20);  // the queue, and what was on its way to it
  bus_.publish(pose(7));
  const auto messages = drain();
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0], pose(7));
}

Bus one_publisher_per_channel(const PrivateNetwork& network) {
  return Bus{network.url(),
             {{"ODOMETRY"}, {"SLAM_COMMAND"}},
             LargeMessages::kRefused,
             {},
             Publishers::kOnePerChannel};
}

// Two publishers send on one channel in turn.
TEST(BusPublishers, OfTwoPublishersOnAChannelTheFirstIsAccepted) {
  const PrivateNetwork network;
  Bus bus = one_publisher_per_channel(network);
  Bus driver{network.url(), {}};
  Bus other{network.url(), {}};
  for (int i = 0; i < 50; ++i) {
    driver.publish(pose(i));
    other.publish(pose(1'000'000 + i));
  }
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(bus.receive(milliseconds{1000}), pose(i));
  EXPECT_FALSE(bus.receive(milliseconds{300}));
  Counters counters;
  bus.collect_counts(counters);
  EXPECT_EQ(counters.get(kSomebodyElse), 50);
}

TEST(BusPublishers, CommandsAreAcceptedFromAnyPublisher) {
  const PrivateNetwork network;
  Bus bus = one_publisher_per_channel(network);
  Bus first{network.url(), {}};
  Bus second{network.url(), {}};
  const Message command = encode(channels::kSlamCommand, command_t{});
  first.publish(command);
  second.publish(command);
  EXPECT_EQ(bus.receive(milliseconds{1000}), command);
  EXPECT_EQ(bus.receive(milliseconds{1000}), command);
}

// In liblcm 1.3.1, a socket receives the messages of all multicast groups on its port.
TEST(BusSetup, OtherMulticastGroupsOnTheSamePortAreIgnored) {
  const PrivateNetwork network;
  std::string elsewhere = network.url();
  elsewhere.replace(elsewhere.find("239.255.76.67"), 13, "239.255.76.99");
  Bus bus{network.url(), {{"ODOMETRY"}}};
  Bus other{elsewhere, {}};
  other.publish(pose(1));
  EXPECT_FALSE(bus.receive(milliseconds{300}));
}

ChannelNames named(const std::vector<std::string>& settings) {
  ProcessConfig<NoConfig> config = load_config<ProcessConfig<NoConfig>>({{}, settings});
  return config.channels;
}

TEST(BusNames, MappedChannelNamesDoNotAppearInMessages) {
  const PrivateNetwork network;
  Bus mapped{network.url(),
             {{"ODOMETRY"}},
             LargeMessages::kRefused,
             named({"channels.odometry=MBOT_ODOMETRY"})};
  Bus plain{network.url(), {{"MBOT_ODOMETRY"}, {"ODOMETRY"}}};
  mapped.publish(pose(1));
  const auto heard = plain.receive(milliseconds{1000});
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->channel, "MBOT_ODOMETRY");
  EXPECT_EQ(mapped.receive(milliseconds{1000}), pose(1));
}

TEST(BusNames, ChannelsOfOneNameAreDistinguishedByType) {
  const PrivateNetwork network;
  const ChannelNames names = named({"channels.slam_grid=SLAM_MAP"});
  Bus bus{network.url(), {{"SLAM_GRID"}, {"SLAM_MAP"}}, LargeMessages::kRefused, names};
  occupancy_grid_t grid{};
  grid.meters_per_cell = 0.1F;
  map_tiles_t tiles{};
  tiles.num_parts = 1;
  tiles.resolution_m = 0.1;
  tiles.tile_size_cells = 1;
  bus.publish(encode(channels::kSlamGrid, grid));
  bus.publish(encode(channels::kSlamMap, tiles));
  const auto first = bus.receive(milliseconds{1000});
  const auto second = bus.receive(milliseconds{1000});
  ASSERT_TRUE(first && second);
  EXPECT_EQ(first->channel, "SLAM_GRID");
  EXPECT_EQ(second->channel, "SLAM_MAP");
}

TEST(BusNames, AChannelWithoutANameIsNotPublished) {
  const PrivateNetwork network;
  Bus bus{network.url(), {}};
  EXPECT_THROW(bus.publish(encode(channels::kMbotSlamStatus, slam_status_t{})), std::logic_error);
}

TEST(BusSetup, AnUnusableUrlIsASetupError) {
  EXPECT_THROW((Bus{"no-such-scheme://", {}}), SetupError);
}

std::string why_refused(const std::string& url) {
  try {
    const Bus bus{url, {{"ODOMETRY"}}};
    return "";
  } catch (const SetupError& error) {
    return error.what();
  }
}

TEST(BusSetup, AWrongUrlIsNamedAndNoRouteIsAdvised) {
  for (const char* url : {"239.255.76.67:7667", "upd://239.255.76.67:7667", "nonsense",
                          "udpm://300.1.1.1:7667", "udpm://239.255.76.67:70000"}) {
    const std::string why = why_refused(url);
    EXPECT_NE(why.find(url), std::string::npos) << why;
    EXPECT_NE(why.find("expected udpm://ADDRESS:PORT"), std::string::npos) << why;
    EXPECT_EQ(why.find("route"), std::string::npos) << why;
  }
  const std::string no_server = why_refused("tcpq://127.0.0.1:1");
  EXPECT_NE(no_server.find("is its server there?"), std::string::npos) << no_server;
}

TEST(BusSetup, ForLargeMessagesALargeBufferIsAskedForUnlessTheUrlSaysHowLarge) {
  EXPECT_EQ(with_large_buffer("udpm://239.255.76.67:7667?ttl=0"),
            "udpm://239.255.76.67:7667?ttl=0&recv_buf_size=8388608");
  EXPECT_EQ(with_large_buffer("udpm://"), "udpm://?recv_buf_size=8388608");
  for (const char* url : {"udpm://239.255.76.67:7667?recv_buf_size=1000", "tcpq://"})
    EXPECT_EQ(with_large_buffer(url), url);
}

TEST(BusHeard, ChannelsWithoutASubscriptionAreHeard) {
  const PrivateNetwork network;
  Bus bus{network.url(), {{"ODOMETRY"}}};
  network.send_datagram(lcm_datagram("SCAN", {1, 2, 3}));
  network.send_datagram(lcm_datagram("SCAN", {1, 2, 3}));
  bus.publish(pose(1));
  EXPECT_EQ(bus.receive(milliseconds{1000}), pose(1));
  const HeardChannels heard = bus.heard();
  EXPECT_EQ(heard.size(), 2U);
  EXPECT_EQ(heard.at("SCAN").count, 2);
  EXPECT_EQ(heard.at("ODOMETRY").count, 1);
}

TEST(BusSetup, TheCommandLineWinsOverTheEnvironment) {
  setenv("LCM_DEFAULT_URL", "udpm://239.255.76.67:1?ttl=0", 1);
  EXPECT_EQ(lcm_url_or_default("memq://"), "memq://");
  EXPECT_EQ(lcm_url_or_default(""), "udpm://239.255.76.67:1?ttl=0");
  unsetenv("LCM_DEFAULT_URL");
  EXPECT_EQ(lcm_url_or_default(""), "udpm://239.255.76.67:7667?ttl=0");
}

TEST(SimulatorLockTest, WithoutTheLockNoSimulatorRuns) {
  rlimit files{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &files), 0);
  const rlimit none{0, files.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
  EXPECT_THROW(SimulatorLock("udpm://239.255.76.67:7667?ttl=0", ChannelNames{}), SetupError);
  setrlimit(RLIMIT_NOFILE, &files);
}

}  // namespace
}  // namespace waymark
