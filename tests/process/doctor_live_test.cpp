// SPDX-License-Identifier: BSD-3-Clause
// The doctor listens to a running robot.
#include "common/bus/bus.hpp"
#include "common/errors/setup_error.hpp"
#include "common/messages/convert.hpp"
#include "doctor/doctor.hpp"
#include "doctor/live_log.hpp"
#include "doctor/report.hpp"
#include "support/lcm_network.hpp"
#include "synthetic_drive.hpp"

#include <gtest/gtest.h>

#include <thread>

namespace waymark {
namespace {

using testing_support::PrivateNetwork;

/// Publishes a drive's messages in order, as fast as a receiver handles them.
void publish(const std::string& url, const ImportedLog& log) {
  std::vector<Message> messages;
  for (const ImportedScan& scan : log.scans)
    messages.push_back(scan.message);
  for (const ImportedPose& pose : log.odometry)
    messages.push_back(encode(channels::kOdometry, to_pose_message(pose.time, pose.pose)));
  std::ranges::sort(messages, comes_before);
  Bus bus{url, {}};
  for (const Message& message : messages) {
    bus.publish(message);
    std::this_thread::sleep_for(std::chrono::microseconds{200});
  }
}

TEST(DoctorLive, AMirroredLidarIsFoundInALogRecordedLive) {
  const PrivateNetwork network;
  const ImportedLog drive = drive_in_room({.is_mirrored = true}).log;
  std::jthread robot{[&] {
    std::this_thread::sleep_for(std::chrono::milliseconds{500});
    publish(network.url(), drive);
  }};
  const LiveLog live{network.url(), {}, std::chrono::seconds{6}};
  ASSERT_TRUE(std::filesystem::exists(live.file()));

  const Diagnosis diagnosis = diagnose(read_input(live.file(), {}, {}));

  const auto mirrored =
      std::ranges::find(diagnosis.checks, std::string{"lidar_mirrored"}, &Check::name);
  EXPECT_EQ(mirrored->verdict, Verdict::kFail) << to_text(diagnosis.checks);
}

TEST(DoctorLive, ASilentNetworkIsReportedInASentence) {
  const PrivateNetwork network;
  try {
    const LiveLog live{network.url(), {.lidar = "SCAN"}, std::chrono::seconds{1}};
    FAIL() << "nothing was sent";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string{error.what()}.find("nothing came on CAMERA, MARKERS, SCAN, ODOMETRY"),
              std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace waymark
