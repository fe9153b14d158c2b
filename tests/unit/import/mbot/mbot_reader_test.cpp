// SPDX-License-Identifier: BSD-3-Clause
#include "import/mbot/mbot_reader.hpp"

#include "common/errors/setup_error.hpp"
#include "common/messages/convert.hpp"
#include "foreign_payloads.hpp"
#include "import_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace waymark {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr std::int64_t kStart_us = 1'000'000'000;

MbotOptions encoder_options() {
  MbotOptions options{};
  options.encoder_channel = "TICKS";
  options.meters_per_tick = 0.001;
  options.wheel_base_m = 0.1;
  return options;
}

MbotOptions encoders_on(const std::string& channel) {
  MbotOptions options{};
  options.encoder_channel = channel;
  return options;
}

Message event(const std::string& channel, std::vector<std::uint8_t> payload) {
  return {channel, timestamp_from_us(5), std::move(payload)};  // the logger has another clock
}

/// Two beams, the second 0.1 s after the first.
lidar_t rotating_scan(std::int64_t utime_us, float first_range_m = 1.0F) {
  lidar_t scan{};
  scan.utime = utime_us;
  scan.num_ranges = 2;
  scan.ranges = {first_range_m, 0.0F};
  scan.thetas = {0.0F, 1.5F};
  scan.times = {utime_us, utime_us + 100'000};
  scan.intensities = {0.0F, 0.0F};
  return scan;
}

Message rotating_event(std::int64_t utime_us, float first_range_m = 1.0F) {
  return event("RPLIDAR_LASER",
               encode(channels::kMbotLidar, rotating_scan(utime_us, first_range_m)).payload);
}

Message planar_event(std::int64_t utime_us, std::vector<float> ranges) {
  planar_lidar_t scan{};
  scan.utime = utime_us;
  scan.nranges = static_cast<int>(ranges.size());
  scan.ranges = std::move(ranges);
  scan.radstep = 0.1F;
  return event("RPLIDAR_LASER", encode(channels::kLidar, scan).payload);
}

Message ticks_event(std::int64_t utime_us, int left, int right) {
  return event("TICKS", maebot_encoders(utime_us, left, right));
}

Message pose_event(const std::string& channel, std::int64_t utime_us, double x_m) {
  return event(channel, encode(channels::kOdometry,
                               to_pose_message(timestamp_from_us(utime_us), {x_m, 0, 0}))
                            .payload);
}

struct Imported {
  ImportedLog log;
  ImportReport report;
};

Imported read(const std::vector<Message>& events, const MbotOptions& options) {
  const auto file = write_log("log.lcm", events);
  ImportReport report{file, AddressUnit::kByte};
  ImportedLog log = read_mbot_log(file, options, report);
  return {std::move(log), std::move(report)};
}

TEST(MbotReader, ScansWithATimePerBeamKeepTheirBytes) {
  const auto [log, report] = read({ticks_event(kStart_us, 0, 0), rotating_event(kStart_us + 1000),
                                   ticks_event(kStart_us + 500'000, 200, 200)},
                                  encoder_options());

  ASSERT_THAT(log.scans, SizeIs(1));
  EXPECT_EQ(log.scans[0].message.channel, "LIDAR");
  EXPECT_EQ(log.scans[0].message.time, timestamp_from_us(kStart_us + 1000));
  EXPECT_EQ(log.scans[0].message.payload, rotating_event(kStart_us + 1000).payload);
  const LidarScan scan = to_scan(decode<lidar_t>(log.scans[0].message.payload).message.value());
  EXPECT_EQ(scan.angles_rad[1], -1.5) << "thetas are clockwise";
  EXPECT_TRUE(std::isinf(scan.ranges_m[1])) << "0 = no return";
  EXPECT_EQ(scan.beam_time_offsets[1], Duration{100'000});
  EXPECT_EQ(report.num_skipped(), 0);
}

TEST(MbotReader, EncoderTicksBecomePoses) {
  const auto [log, report] = read({ticks_event(kStart_us, 7, 7), rotating_event(kStart_us),
                                   ticks_event(kStart_us + 500'000, 207, 207)},
                                  encoder_options());

  ASSERT_THAT(log.odometry, SizeIs(2));
  EXPECT_NEAR(log.odometry[1].pose.x(), 0.2, 1e-12);
  EXPECT_EQ(log.robot.base.wheel_separation_m, 0.1);
}

TEST(MbotReader, OdometryThatStartsLateIsExtendedBackToTheFirstScan) {
  const auto [log, report] =
      read({rotating_event(kStart_us), ticks_event(kStart_us + 127'000, 0, 0)}, encoder_options());

  ASSERT_THAT(log.odometry, SizeIs(2));
  EXPECT_EQ(log.odometry[0].time, timestamp_from_us(kStart_us));
  EXPECT_THAT(report.notes(), Contains(HasSubstr("0.127 s after the first scan")));
}

TEST(MbotReader, OdometryCoversTheLastBeamOfAScan) {
  const auto [log, report] = read(
      {ticks_event(kStart_us - 1, 0, 0), ticks_event(kStart_us, 5, 5), rotating_event(kStart_us)},
      encoder_options());

  ASSERT_THAT(log.odometry, SizeIs(3));
  EXPECT_EQ(log.odometry[2].time, timestamp_from_us(kStart_us + 100'000));
}

TEST(MbotReader, ScansFarFromAnyOdometryAreSkipped) {
  const auto [log, report] =
      read({rotating_event(kStart_us), ticks_event(kStart_us + 2'000'000, 0, 0),
            rotating_event(kStart_us + 2'000'000), ticks_event(kStart_us + 3'000'000, 0, 0)},
           encoder_options());

  EXPECT_THAT(log.scans, SizeIs(1));
  EXPECT_EQ(report.skipped_by_kind().at("no odometry at its time"), 1);
}

TEST(MbotReader, PosesOfEitherTypeAreOdometryOrReference) {
  MbotOptions options{};
  options.odometry_channel = "ODO";
  options.reference_channel = "POSE";
  const double half = std::numbers::pi / 8.0;

  const auto [log, report] =
      read({event("ODO", bot_core_pose(kStart_us, 1.5, -2.5, std::cos(half), std::sin(half))),
            rotating_event(kStart_us), pose_event("ODO", kStart_us + 100'000, 4.0),
            pose_event("POSE", kStart_us + 50'000, 8.0)},
           options);

  ASSERT_THAT(log.odometry, SizeIs(2));
  EXPECT_EQ(log.odometry[0].pose.x(), 1.5);
  EXPECT_EQ(log.odometry[0].pose.y(), -2.5);
  EXPECT_NEAR(log.odometry[0].pose.theta(), std::numbers::pi / 4.0, 1e-12);
  EXPECT_EQ(log.odometry[1].pose.x(), 4.0);
  ASSERT_THAT(log.reference, SizeIs(1));
  EXPECT_EQ(log.reference[0].pose.x(), 8.0);
}

TEST(MbotReader, PlanarScansFollowRep117) {
  MbotOptions options = encoder_options();
  options.range_max_m = 6.0;
  const auto [log, report] =
      read({ticks_event(kStart_us, 0, 0), planar_event(kStart_us, {1.0F, 6.0F, 0.0F})}, options);

  const auto scan = decode<planar_lidar_t>(log.scans[0].message.payload).message.value();
  EXPECT_EQ(scan.ranges[0], 1.0F);
  EXPECT_TRUE(std::isinf(scan.ranges[1]));
  EXPECT_TRUE(std::isnan(scan.ranges[2]));
}

TEST(MbotReader, ANanRangeInvalidatesItsBeamOnly) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const auto [log, report] = read({ticks_event(kStart_us, 0, 0), rotating_event(kStart_us, kNan),
                                   rotating_event(kStart_us + 200'000)},
                                  encoder_options());

  ASSERT_THAT(log.scans, SizeIs(2));
  const LidarScan scan = to_scan(decode<lidar_t>(log.scans[0].message.payload).message.value());
  EXPECT_TRUE(std::isnan(scan.ranges_m[0]));
  EXPECT_EQ(report.num_skipped(), 0);
  const auto planar = read({ticks_event(kStart_us, 0, 0), planar_event(kStart_us, {1.0F, kNan})},
                           encoder_options());
  ASSERT_THAT(planar.log.scans, SizeIs(1));
}

TEST(MbotReader, UnknownTypesAreNamedInHexadecimal) {
  const auto [log, report] = read({ticks_event(kStart_us, 0, 0), rotating_event(kStart_us),
                                   event("RPLIDAR_LASER", maebot_encoders(kStart_us, 0, 0))},
                                  encoder_options());

  EXPECT_THAT(report.messages(),
              ElementsAre(HasSubstr("RPLIDAR_LASER: fingerprint 7d090bfb221d74f9, 24 bytes")));
}

TEST(MbotReader, BadEventsAreNamedCountedAndLeftOut) {
  Message cut = rotating_event(kStart_us + 5);
  cut.payload.pop_back();
  Message cut_ticks = ticks_event(kStart_us + 5, 0, 0);
  cut_ticks.payload.pop_back();

  const auto [log, report] = read(
      {ticks_event(kStart_us, 0, 0), rotating_event(kStart_us), cut, cut_ticks,
       rotating_event(kStart_us + 20, -1.0F), rotating_event(kStart_us - 300'000),
       rotating_event(kStart_us + 40), ticks_event(-5, 0, 0), planar_event(kStart_us + 50, {1.0F})},
      encoder_options());

  EXPECT_EQ(report.skipped_by_kind().at("bad scan message"), 1);
  EXPECT_EQ(report.skipped_by_kind().at("wrong size"), 1);
  EXPECT_EQ(report.skipped_by_kind().at("negative range"), 1);
  EXPECT_EQ(report.skipped_by_kind().at("time out of order"), 1);
  EXPECT_EQ(report.skipped_by_kind().at("bad time"), 1);
  EXPECT_EQ(report.skipped_by_kind().at("changed beam count"), 1);
  EXPECT_EQ(report.num_skipped(), 6);
  EXPECT_THAT(log.scans, SizeIs(2));
}

TEST(MbotReader, BytesThatAreNoEventAreNamedWithTheirOffset) {
  const std::string good =
      read_file(write_log("good.lcm", {ticks_event(kStart_us, 0, 0), rotating_event(kStart_us)}));
  const std::size_t first_bytes = 28 + 5 + 24;  // header, "TICKS", payload
  std::string bytes = good.substr(0, first_bytes) + "garbage" + good.substr(first_bytes) + "end";
  const auto file = write_file("torn.lcm", bytes);
  ImportReport report{file, AddressUnit::kByte};

  const ImportedLog log = read_mbot_log(file, encoder_options(), report);

  EXPECT_THAT(log.scans, SizeIs(1));
  EXPECT_THAT(report.messages(), ElementsAre("torn.lcm: byte 57: skipped: no LCM event: 7 bytes",
                                             HasSubstr("skipped: no LCM event: 3 bytes")));
}

TEST(MbotReader, TheOnlyEncoderTicksAreOdometryByDefault) {
  const auto [log, report] =
      read({ticks_event(kStart_us, 0, 0), rotating_event(kStart_us),
            ticks_event(kStart_us + 500'000, 1200, 1200), pose_event("POSE", kStart_us, 8.0)},
           {});

  EXPECT_NEAR(log.odometry.back().pose.x(), 0.100528, 1e-9) << "one turn of a MAEBot's wheels";
  EXPECT_THAT(report.notes(), Contains(HasSubstr("the encoder ticks of TICKS, the only ones")));
}

TEST(MbotReader, MotorFeedbackOf2014HasItsOwnWheels) {
  const auto feedback = [](std::int64_t utime_us, std::int32_t left, std::int32_t right) {
    return event("MAEBOT_MOTOR_FEEDBACK", maebot_motor_feedback(utime_us, left, right));
  };
  const auto [log, report] = read({feedback(kStart_us, 10, -20), rotating_event(kStart_us),
                                   feedback(kStart_us + 500'000, 490, 460)},
                                  {});

  EXPECT_EQ(report.num_skipped(), 0);
  EXPECT_NEAR(log.odometry.back().pose.translation().norm(), std::numbers::pi * 0.032, 1e-6);
  EXPECT_NEAR(log.odometry.back().pose.theta(), 0.0, 1e-9);
  EXPECT_EQ(log.robot.base.wheel_separation_m, 0.08);
  auto cut = maebot_motor_feedback(kStart_us, 1, 2);
  cut.resize(20);
  EXPECT_EQ(read({event("MAEBOT_MOTOR_FEEDBACK", cut), feedback(kStart_us, 0, 0),
                  rotating_event(kStart_us)},
                 encoders_on("MAEBOT_MOTOR_FEEDBACK"))
                .report.skipped_by_kind()
                .at("wrong size"),
            1);
}

TEST(MbotReader, WithoutOdometryTheErrorListsTheChannels) {
  const auto sentence = [](const std::vector<Message>& events) -> std::string {
    try {
      read(events, {});
    } catch (const SetupError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_THAT(sentence({rotating_event(kStart_us)}),
              HasSubstr("the log has no odometry: none of its channels (RPLIDAR_LASER)"));
  EXPECT_THAT(sentence({rotating_event(kStart_us), pose_event("POSE", kStart_us, 1.0)}),
              HasSubstr("there are poses in POSE, encoder ticks in none"));
}

TEST(MbotReader, OdometryOfAnotherClockIsShiftedToTheLidarsClock) {
  std::vector<Message> events;
  for (int i = 0; i < 10; ++i) {
    events.push_back(rotating_event(kStart_us + 200'000 * i));
    events.back().time = timestamp_from_us(9'000'000 + 200'000 * i);
    events.push_back(ticks_event(77 + 200'000 * i, i, i));
    events.back().time = timestamp_from_us(9'000'000 + 200'000 * i);
  }
  const auto [log, report] = read(events, encoder_options());

  EXPECT_THAT(log.scans, SizeIs(10));
  EXPECT_EQ(log.odometry.front().time, timestamp_from_us(kStart_us));
  EXPECT_THAT(report.notes(), Contains(HasSubstr("of another clock than the LiDAR's")));
}

Message image_event(const std::string& channel, std::int64_t utime_us) {
  image_t image{};
  image.utime = utime_us;
  image.width = 320;
  image.height = 240;
  image.row_stride = 320;
  image.pixelformat = image_t::PIXEL_FORMAT_GRAY;
  image.size = 320 * 240;
  image.data.assign(320 * 240, 7);
  return event(channel, encode(channels::kCamera, image).payload);
}

TEST(MbotReader, ImagesAreImported) {
  const std::vector<Message> drive{ticks_event(kStart_us, 0, 0), rotating_event(kStart_us + 1000),
                                   ticks_event(kStart_us + 500'000, 200, 200)};
  for (const std::string channel : {"CAMERA", "FRONT"}) {
    std::vector<Message> events = drive;
    events.push_back(image_event(channel, kStart_us + 2000));
    MbotOptions options = encoder_options();
    if (channel != "CAMERA") options.camera_channel = channel;
    const auto [log, report] = read(events, options);

    ASSERT_THAT(log.images, SizeIs(1)) << channel;
    EXPECT_EQ(log.images[0].message.channel, "CAMERA");
    EXPECT_EQ(log.images[0].message.time, timestamp_from_us(kStart_us + 2000));
    EXPECT_EQ(log.images[0].message.payload, events.back().payload);
    EXPECT_EQ(log.robot.camera.width_px, 320);
    EXPECT_THAT(report.notes(), Contains(HasSubstr("[robot.camera]")));
  }
}

TEST(MbotReader, ImagesOfAnotherClockAreShiftedToTheLidarsClock) {
  std::vector<Message> events;
  for (int i = 0; i < 10; ++i) {
    events.push_back(rotating_event(kStart_us + 200'000 * i));
    events.push_back(ticks_event(kStart_us + 200'000 * i, i, i));
    events.push_back(image_event("CAMERA", 77 + 200'000 * i));
    for (std::size_t k = events.size() - 3; k < events.size(); ++k)
      events[k].time = timestamp_from_us(9'000'000 + 200'000 * i);
  }
  const auto [log, report] = read(events, encoder_options());

  ASSERT_THAT(log.images, SizeIs(10));
  EXPECT_EQ(log.images[3].time, log.scans[3].time);
  EXPECT_EQ(decode<image_t>(log.images[3].message.payload).message->utime, kStart_us + 200'000 * 3);
  EXPECT_THAT(report.notes(), Contains(HasSubstr("stamps of images are of another clock")));
}

TEST(MbotReader, OtherMessagesOnCameraAreNoted) {
  const auto [log, report] =
      read({ticks_event(kStart_us, 0, 0), rotating_event(kStart_us + 1000),
            ticks_event(kStart_us + 500'000, 200, 200), pose_event("CAMERA", kStart_us, 0.0)},
           encoder_options());
  EXPECT_THAT(log.images, SizeIs(0));
  EXPECT_EQ(report.num_skipped(), 0);
  EXPECT_THAT(report.notes(), Contains(HasSubstr("1 messages of CAMERA are no image_t")));
}

TEST(MbotReader, AChannelThatIsNotThereIsAUsageError) {
  MbotOptions options = encoder_options();
  options.lidar_channel = "LASER";
  try {
    read({ticks_event(kStart_us, 0, 0)}, options);
    ADD_FAILURE() << "a log without the channel was accepted";
  } catch (const SetupError& error) {
    EXPECT_STREQ(error.what(),
                 "there is no channel LASER in the log; it holds TICKS 1: give --lidar-channel");
  }
  EXPECT_THROW(read({}, encoder_options()), SetupError) << "an empty log";
  MbotOptions both = encoder_options();
  both.odometry_channel = "TICKS";
  EXPECT_THROW(read({ticks_event(kStart_us, 0, 0)}, both), SetupError) << "two sources";
}

}  // namespace
}  // namespace waymark
