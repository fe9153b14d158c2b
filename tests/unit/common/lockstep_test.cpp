// SPDX-License-Identifier: BSD-3-Clause
// The lockstep protocol over a simulated network that loses, repeats and reorders.
#include "common/lockstep/master.hpp"
#include "common/lockstep/participant.hpp"
#include "common/random/random.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

namespace waymark {
namespace {

Message odometry(std::int64_t utime_us, float x_m) {
  pose2D_t pose{};
  pose.utime = utime_us;
  pose.x = x_m;
  return encode(channels::kOdometry, pose);
}

Message marker_answer(const Message& odometry_message) {
  marker_detections_t markers{};
  markers.utime = to_us(odometry_message.time);
  return encode(channels::kMarkers, markers);
}

std::vector<Message> publish_nothing(const std::vector<Message>&, bool) {
  return {};
}

/// Master, detector and slam; every message reaches all of them, as on a multicast bus.
class Stack {
 public:
  explicit Stack(double loss, std::uint64_t seed) : loss_{loss}, random_{{seed}} {
    restart_detector();
    slam_ = std::make_unique<LockstepParticipant>(
        "slam", std::vector<std::string>{"ODOMETRY", "MARKERS"}, false,
        [this](const std::vector<Message>& messages, bool) {
          slam_input_.insert(slam_input_.end(), messages.begin(), messages.end());
          return std::vector<Message>{};
        },
        slam_counters_);
  }

  void restart_detector() {
    detector_ = std::make_unique<LockstepParticipant>(
        "detector", std::vector<std::string>{"ODOMETRY"}, true,
        [](const std::vector<Message>& messages, bool) {
          std::vector<Message> answers;
          for (const Message& message : messages)
            answers.push_back(marker_answer(message));
          return answers;
        },
        detector_counters_);
  }

  void send(std::vector<Message> messages) {
    std::vector<Message> wave = std::move(messages);
    while (!wave.empty()) {
      std::vector<Message> answers;
      for (const Message& message : wave) {
        if (message.channel == "ACK" && !lost()) master_.handle(message);
        for (auto* participant : {detector_.get(), slam_.get()}) {
          if (lost()) continue;
          const int copies = random_.uniform() < 0.1 ? 2 : 1;
          for (int i = 0; i < copies; ++i) {
            const auto published = participant->handle(message);
            answers.insert(answers.end(), published.begin(), published.end());
          }
        }
      }
      // Arrival order between processes is arbitrary.
      for (std::size_t i = answers.size(); i > 1; --i)
        std::swap(answers[i - 1], answers[random_() % i]);
      wave = std::move(answers);
    }
  }

  void run(int num_ticks) {
    while (!master_.all_ready())
      send({master_.probe()});
    int sent = 0;
    for (int guard = 0; guard < 100000 && !(sent == num_ticks && master_.all_acknowledged());
         ++guard) {
      if (sent < num_ticks && master_.has_room()) {
        const std::int64_t base_us = 1000 * sent;
        send(master_.open_tick(timestamp_from_us(base_us + 999),
                               {odometry(base_us + 500, 2.0F), odometry(base_us, 1.0F)},
                               ++sent == num_ticks));
      } else {
        send(master_.resend());
      }
      if (sent == num_ticks / 2 && !restarted_ && restart_) {
        restart_detector();
        restarted_ = true;
      }
    }
    send({master_.closing()});
  }

  bool restart_{false};
  bool restarted_{false};
  double loss_;
  Random random_{{0}};
  LockstepMaster master_{77, {"detector", "slam"}, 4};
  Counters detector_counters_;
  Counters slam_counters_;
  std::unique_ptr<LockstepParticipant> detector_;
  std::unique_ptr<LockstepParticipant> slam_;
  std::vector<Message> slam_input_;

 private:
  bool lost() { return random_.uniform() < loss_; }
};

std::vector<Message> expected_input(int num_ticks) {
  std::vector<Message> messages;
  for (int tick = 0; tick < num_ticks; ++tick) {
    for (const int offset_us : {0, 500}) {
      const Message message = odometry(1000 * tick + offset_us, offset_us == 0 ? 1.0F : 2.0F);
      messages.push_back(marker_answer(message));
      messages.push_back(message);
    }
  }
  return messages;
}

TEST(Lockstep, SlamSeesEverythingOnceAndInOrder) {
  Stack stack{0.0, 1};
  stack.run(50);
  EXPECT_EQ(stack.slam_input_, expected_input(50));
  EXPECT_TRUE(stack.slam_->finished());
  EXPECT_TRUE(stack.slam_->closed());
}

TEST(Lockstep, MessageLossDoesNotChangeTheResults) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    Stack stack{0.2, seed};
    stack.run(50);
    EXPECT_EQ(stack.slam_input_, expected_input(50)) << "seed " << seed;
  }
}

TEST(Lockstep, ARestartedDetectorDoesNotChangeTheResults) {
  Stack stack{0.05, 9};
  stack.restart_ = true;
  stack.run(50);
  EXPECT_TRUE(stack.restarted_);
  EXPECT_EQ(stack.slam_input_, expected_input(50));
}

TEST(Lockstep, StateHashesDependOnTheOutputs) {
  Stack a{0.0, 1};
  Stack b{0.3, 2};
  Stack c{0.0, 1};
  a.run(20);
  b.run(20);
  c.run(21);
  EXPECT_EQ(a.master_.state_hashes(), b.master_.state_hashes());
  EXPECT_NE(a.master_.state_hashes().at("detector"), c.master_.state_hashes().at("detector"));
}

TEST(Lockstep, MessagesOfOtherPublishersAreIgnored) {
  Stack stack{0.0, 1};
  while (!stack.master_.all_ready())
    stack.send({stack.master_.probe()});
  for (int i = 0; i < 1000; ++i)
    stack.send({odometry(100 + i, 9.0F)});
  stack.run(10);
  EXPECT_EQ(stack.slam_input_, expected_input(10));
}

TEST(Lockstep, TicksOfAnotherRunAreIgnoredAndCounted) {
  Stack stack{0.0, 1};
  while (!stack.master_.all_ready())
    stack.send({stack.master_.probe()});
  LockstepMaster other{78, {"detector", "slam"}, 4};
  stack.send(other.open_tick(timestamp_from_us(1), {odometry(0, 9.0F)}, true));
  stack.run(10);
  EXPECT_EQ(stack.slam_input_, expected_input(10));
  EXPECT_GT(stack.slam_counters_.get("TICK or ACK of another run"), 0);
}

// The first tick that a restarted process sees may be newer than others that are still open.
TEST(Lockstep, ARestartedProcessStartsAtTheOldestOpenTick) {
  LockstepMaster master{1, {"viewer"}, 4};
  Counters counters;
  const auto make = [&counters] {
    return LockstepParticipant{"viewer", {}, true, publish_nothing, counters};
  };
  const auto tick_0 = master.open_tick(timestamp_from_us(1), {}, false);
  const auto tick_1 = master.open_tick(timestamp_from_us(2), {}, false);
  LockstepParticipant first = make();
  for (const Message& answer : first.handle(tick_0.back()))
    master.handle(answer);

  LockstepParticipant restarted = make();
  for (const Message& message : master.resend()) {
    for (const Message& answer : restarted.handle(message))
      master.handle(answer);
  }

  EXPECT_TRUE(master.all_acknowledged());
}

// A process may be a whole window ahead of the acknowledgements that the simulator has received.
TEST(Lockstep, EveryTickOfTheWidestWindowIsAnsweredAgain) {
  LockstepMaster master{1, {"viewer"}, kMaxWindowTicks};
  Counters counters;
  LockstepParticipant viewer{"viewer", {}, true, publish_nothing, counters};
  for (int end_us = 0; master.has_room(); ++end_us)
    viewer.handle(master.open_tick(timestamp_from_us(end_us), {}, false).back());

  for (const Message& message : master.resend()) {
    for (const Message& answer : viewer.handle(message))
      master.handle(answer);
  }

  EXPECT_TRUE(master.all_acknowledged());
}

TEST(Lockstep, AStatefulProcessRefusesToJoinMidway) {
  LockstepMaster master{1, {"slam"}, 1};
  Counters counters;
  LockstepParticipant first{"slam", {}, false, publish_nothing, counters};
  for (const Message& message : master.open_tick(timestamp_from_us(1), {}, false)) {
    for (const Message& answer : first.handle(message))
      master.handle(answer);
  }
  LockstepParticipant late{"slam", {}, false, publish_nothing, counters};
  const auto tick = master.open_tick(timestamp_from_us(2), {}, false);
  EXPECT_THROW(late.handle(tick.back()), std::runtime_error);
}

TEST(Lockstep, AProcessThatHasDoneNothingYetFollowsTheNextSimulator) {
  Counters counters;
  LockstepParticipant slam{"slam", {}, false, publish_nothing, counters};
  LockstepMaster stopped{1, {"slam"}, 1};
  slam.handle(stopped.probe());

  LockstepMaster next{2, {"slam"}, 1};
  for (const Message& answer : slam.handle(next.probe()))
    next.handle(answer);
  for (const Message& answer : slam.handle(next.open_tick({}, {}, true).back()))
    next.handle(answer);

  EXPECT_TRUE(next.all_ready());
  EXPECT_TRUE(next.all_acknowledged());
  EXPECT_TRUE(slam.finished());
}

TEST(Lockstep, TheEndOfAnEarlierRunDoesNotEndAProcessThatWaits) {
  Counters counters;
  LockstepParticipant slam{"slam", {}, false, publish_nothing, counters};
  slam.handle(LockstepMaster{1, {"slam"}, 1}.closing());
  EXPECT_FALSE(slam.closed());
  EXPECT_FALSE(slam.has_seen_tick());
}

// The simulator was killed and started again, and begins with tick 0. The simulator of this
// process's run would not send that tick again.
TEST(Lockstep, AProcessInTheMiddleOfARunRefusesToBeginItAgain) {
  Counters counters;
  LockstepParticipant slam{"slam", {}, false, publish_nothing, counters};
  LockstepMaster killed{1, {"slam"}, 1};
  for (int tick = 0; tick <= kMaxWindowTicks; ++tick) {
    for (const Message& answer : slam.handle(killed.open_tick({}, {}, false).back()))
      killed.handle(answer);
  }
  LockstepMaster again{1, {"slam"}, 1};
  slam.handle(again.probe());
  const Message first = again.open_tick({}, {}, false).back();
  try {
    slam.handle(first);
    FAIL() << "it waits for ever";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("begun again"));
  }
}

TEST(Lockstep, TheMasterNamesSilentParticipantsInOrderOfTheirDependencies) {
  LockstepMaster master{1, {"slam", "recorder", "detector"}, 2};
  EXPECT_THAT(master.not_ready(), ::testing::ElementsAre("slam", "recorder", "detector"));
  master.open_tick(timestamp_from_us(1), {}, false);
  EXPECT_THAT(master.silent(), ::testing::ElementsAre("slam", "recorder", "detector"));
  EXPECT_TRUE(master.has_room());
  master.open_tick(timestamp_from_us(2), {}, false);
  EXPECT_FALSE(master.has_room());
}

/// slam publishes each marker map up to three times, in one tick or in several: the last tick of a
/// run repeats the one before it whenever no scan came in between.
TEST(Lockstep, EqualMessagesAreProcessedAsOftenAsTheyWerePublished) {
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    Random random{{seed}};
    const double loss = seed % 2 == 0 ? 0.2 : 0.0;
    const int num_ticks = 1 + static_cast<int>(random() % 30);
    const int period_ticks = 1 + static_cast<int>(random() % 5);
    const int copies = 1 + static_cast<int>(random() % 3);
    Counters counters;
    std::vector<Message> published;
    std::vector<Message> received;
    int tick = 0;
    LockstepParticipant slam{"slam",
                             {"ODOMETRY"},
                             false,
                             [&](const std::vector<Message>&, bool) {
                               std::vector<Message> now(
                                   static_cast<std::size_t>(copies),
                                   marker_answer(odometry(1000 * (tick++ / period_ticks), 0.0F)));
                               published.insert(published.end(), now.begin(), now.end());
                               return now;
                             },
                             counters};
    LockstepParticipant viewer{"viewer",
                               {"MARKERS"},
                               false,
                               [&](const std::vector<Message>& messages, bool) {
                                 received.insert(received.end(), messages.begin(), messages.end());
                                 return std::vector<Message>{};
                               },
                               counters};
    LockstepMaster master{77, {"slam", "viewer"}, 4};
    const auto send = [&](std::vector<Message> wave) {
      while (!wave.empty()) {
        std::vector<Message> answers;
        for (const Message& message : wave) {
          if (message.channel == "ACK" && random.uniform() >= loss) master.handle(message);
          for (LockstepParticipant* participant : {&slam, &viewer}) {
            if (random.uniform() < loss) continue;
            const std::vector<Message> more = participant->handle(message);
            answers.insert(answers.end(), more.begin(), more.end());
          }
        }
        wave = std::move(answers);
      }
    };
    while (!master.all_ready())
      send({master.probe()});
    int sent = 0;
    for (int guard = 0; guard < 10000 && !(sent == num_ticks && master.all_acknowledged());
         ++guard) {
      if (sent < num_ticks && master.has_room()) {
        const std::int64_t base_us = 1000 * sent;
        send(master.open_tick(timestamp_from_us(base_us + 999), {odometry(base_us, 1.0F)},
                              ++sent == num_ticks));
      } else {
        send(master.resend());
      }
    }
    EXPECT_TRUE(master.all_acknowledged())
        << "seed " << seed << ": " << num_ticks << " ticks, the same bytes for " << period_ticks
        << ", " << copies << " copies";
    EXPECT_EQ(received, published) << "seed " << seed;
  }
}

TEST(MessagePool, DropsTheOldestMessagesAndStaysBounded) {
  MessagePool pool;
  Message large = odometry(0, 0.0F);
  large.payload.resize(60000);
  std::int64_t first_hash = 0;
  for (std::uint32_t i = 0; i < 2000; ++i) {
    for (int k = 0; k < 4; ++k)
      large.payload[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(i >> (8 * k));
    if (i == 0) first_hash = content_hash(large);
    EXPECT_TRUE(pool.add(large));
    EXPECT_FALSE(pool.add(large));
  }
  EXPECT_FALSE(pool.has(first_hash));
  EXPECT_TRUE(pool.has(content_hash(large)));
}

TEST(MessagePool, NoMessageOfATickIsDroppedForAnotherOfTheTick) {
  MessagePool pool;
  Message large = odometry(0, 0.0F);
  large.payload.resize(60000);
  std::vector<std::int64_t> tick;
  for (std::uint8_t i = 0; i < 250; ++i) {  // 250 x 60 kB are within the bound, 300 are not
    large.payload[0] = i;
    pool.add(large);
    tick.push_back(content_hash(large));
  }
  EXPECT_EQ(pool.use(tick).size(), tick.size());
  std::vector<std::int64_t> next;
  for (std::uint8_t i = 0; i < 50; ++i) {
    large.payload[1] = 1;
    large.payload[0] = i;
    pool.add(large);
    next.push_back(content_hash(large));
  }
  next.push_back(tick.front());  // the oldest of those that were used
  EXPECT_EQ(pool.use(next).size(), next.size());
}

}  // namespace
}  // namespace waymark
