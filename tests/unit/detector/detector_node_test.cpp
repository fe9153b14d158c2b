// SPDX-License-Identifier: BSD-3-Clause
#include "detector/detector_node.hpp"

#include "support/marker_image.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <filesystem>
#include <numbers>

namespace waymark {
namespace {

using ::testing::HasSubstr;

image_t jpeg_message(const cv::Mat& gray, std::int64_t utime) {
  image_t image{};
  image.utime = utime;
  image.width = gray.cols;
  image.height = gray.rows;
  image.pixelformat = image_t::PIXEL_FORMAT_MJPEG;
  cv::imencode(".jpg", gray, image.data, {cv::IMWRITE_JPEG_QUALITY, 90});
  image.size = static_cast<std::int32_t>(image.data.size());
  return image;
}

cv::Mat picture_of_marker_seven() {
  const RobotConfig robot;
  return testing::render_markers(
      robot,
      {{7, robot.camera.base_from_camera().inverse() *
               testing::base_from_upright_marker({2.0, 0.0, 0.2}, std::numbers::pi)}},
      {}, Random{1});
}

class DetectorNodeTest : public ::testing::Test {
 protected:
  marker_detections_t answer_to(const image_t& image) {
    inbox_.deliver(encode(channels::kCamera, image));
    const auto messages = outbox_.take();
    EXPECT_EQ(messages.size(), 1U);
    if (messages.empty()) return {};
    EXPECT_EQ(messages[0].channel, "MARKERS");
    const auto decoded = decode<marker_detections_t>(messages[0].payload);
    EXPECT_TRUE(decoded.message);
    return decoded.message.value_or(marker_detections_t{});
  }

  Inbox inbox_;
  Outbox outbox_;
};

TEST_F(DetectorNodeTest, AMarkerWhereTheLensCannotBeInvertedIsDroppedAndCounted) {
  DetectorConfig config;
  config.robot.camera.distortion = {-30.0, 0.0, 0.0, 0.0, 0.0};  // up to 37 px from the centre
  DetectorNode node{config, inbox_, outbox_};
  EXPECT_EQ(answer_to(jpeg_message(picture_of_marker_seven(), 1)).num_detections, 0);
  EXPECT_EQ(
      inbox_.counters().get("markers dropped: robot.camera.distortion cannot be inverted there"),
      1);
}

TEST_F(DetectorNodeTest, AFrameIsAnsweredWithItsTimeAndMarkers) {
  DetectorNode node{DetectorConfig{}, inbox_, outbox_};

  const auto answer = answer_to(jpeg_message(picture_of_marker_seven(), 1234567));

  EXPECT_EQ(answer.utime, 1234567);
  EXPECT_EQ(answer.image_width, 640);
  ASSERT_EQ(answer.num_detections, 1);
  EXPECT_EQ(answer.detections[0].id, 7);
  EXPECT_NEAR(answer.detections[0].position_m[0], 2.0, 0.005);
  EXPECT_NEAR(answer.detections[0].position_m[1], 0.0, 0.005);
}

TEST_F(DetectorNodeTest, BadFramesAreCountedAndAnsweredAndTheNextGoodOneIsRead) {
  DetectorNode node{DetectorConfig{}, inbox_, outbox_};
  const image_t good = jpeg_message(picture_of_marker_seven(), 1000);

  image_t truncated = good;
  truncated.data.resize(good.data.size() / 2);
  truncated.size = static_cast<std::int32_t>(truncated.data.size());
  EXPECT_EQ(answer_to(truncated).num_detections, 0);

  ::testing::internal::CaptureStdout();
  const auto small = answer_to(jpeg_message(cv::Mat(48, 64, CV_8UC1, cv::Scalar{0}), 2000));
  EXPECT_THAT(
      ::testing::internal::GetCapturedStdout(),
      HasSubstr("64 x 48 px is refused: robot.camera.width_px and height_px say 640 x 480"));
  EXPECT_EQ(small.utime, 2000);
  EXPECT_EQ(small.num_detections, 0);

  EXPECT_EQ(inbox_.counters().get("CAMERA rejected: truncated JPEG"), 1);
  EXPECT_EQ(inbox_.counters().get("CAMERA rejected: image size is not the configured camera's"), 1);
  EXPECT_EQ(answer_to(good).num_detections, 1);
}

TEST_F(DetectorNodeTest, DetectionsAreCounted) {
  DetectorNode node{DetectorConfig{}, inbox_, outbox_};
  answer_to(jpeg_message(picture_of_marker_seven(), 1000));
  answer_to(jpeg_message(picture_of_marker_seven(), 2000));
  answer_to(jpeg_message(cv::Mat(480, 640, CV_8UC1, cv::Scalar{77}), 3000));

  EXPECT_EQ(inbox_.counters().get("markers detected"), 2);
  EXPECT_EQ(inbox_.counters().get("frames with markers"), 2);
  EXPECT_EQ(inbox_.counters().get("frames without markers"), 1);
}

TEST_F(DetectorNodeTest, DebugPicturesAreWrittenOnRequest) {
  const auto folder = std::filesystem::path{::testing::TempDir()} / "waymark_debug_pictures";
  std::filesystem::remove_all(folder);
  DetectorConfig config;
  config.detector.debug_dir = folder.string();
  config.detector.debug_every = 2;
  DetectorNode node{config, inbox_, outbox_};
  for (const std::int64_t utime : {1000, 2000, 3000})
    answer_to(jpeg_message(picture_of_marker_seven(), utime));

  EXPECT_TRUE(std::filesystem::exists(folder / "frame_000000001000.png"));
  EXPECT_FALSE(std::filesystem::exists(folder / "frame_000000002000.png"));
  EXPECT_TRUE(std::filesystem::exists(folder / "frame_000000003000.png"));
  std::filesystem::remove_all(folder);
}

cv::Mat picture_of_a_wall_of_markers() {
  const RobotConfig robot;
  std::vector<testing::PlacedMarker> wall;
  for (int i = 0; i < 15 * 11; ++i) {
    const Eigen::Vector3d place{8.5, 0.62 * (i % 15 - 7), 0.103 + 0.62 * (i / 15 - 5)};
    wall.push_back({i, robot.camera.base_from_camera().inverse() *
                           testing::base_from_upright_marker(place, std::numbers::pi)});
  }
  return testing::render_markers(robot, wall, {}, Random{1});
}

TEST_F(DetectorNodeTest, MoreMarkersThanAMessageHoldsAreCounted) {
  DetectorNode node{DetectorConfig{}, inbox_, outbox_};

  EXPECT_EQ(answer_to(jpeg_message(picture_of_a_wall_of_markers(), 1000)).num_detections, 130);

  EXPECT_GT(inbox_.counters().get("markers dropped: more than a message holds"), 10);
}

TEST_F(DetectorNodeTest, AFolderThatCannotBeMadeIsASetupError) {
  DetectorConfig config;
  config.detector.debug_dir = "/proc/no_such_folder";
  EXPECT_THROW((DetectorNode{config, inbox_, outbox_}), SetupError);
}

}  // namespace
}  // namespace waymark
