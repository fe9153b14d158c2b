// SPDX-License-Identifier: BSD-3-Clause
// Bags that are damaged, incomplete or unusual. tests/python/rosbag_test.py reads normal bags.
#include "import/rosbag/rosbag_reader.hpp"

#include "common/errors/setup_error.hpp"
#include "small_bag.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::HasSubstr;
using ::testing::SizeIs;
using ::testing::ThrowsMessage;

struct ReadBag {
  ImportedLog log{};
  ImportReport report{"bag.db3", AddressUnit::kRow};
};

ReadBag read_file_of_bag(const std::filesystem::path& file) {
  ReadBag result{};
  result.log = read_rosbag(file, {}, result.report);
  return result;
}

/// Ten scans with odometry, and these messages.
ReadBag read_with(std::vector<BagMessage> messages) {
  for (int i = 0; i < 10; ++i) {
    messages.push_back(bag_scan(i));
    messages.push_back(bag_odometry(i));
  }
  return read_file_of_bag(write_bag(messages));
}

TEST(RosbagReader, ABagWhoseRecorderWasKilledIsRefusedUntilItsLogIsMovedIntoIt) {
  const auto file = write_bag({bag_scan(0), bag_scan(1), bag_odometry(0), bag_odometry(1)});
  write_file("bag.db3-wal", "");
  EXPECT_THAT(read_file_of_bag(file).log.scans, SizeIs(2));

  write_file("bag.db3-wal", "messages");
  EXPECT_THAT([&] { read_file_of_bag(file); },
              ThrowsMessage<SetupError>(AllOf(HasSubstr("bag.db3-wal: holds messages"),
                                              HasSubstr("wal_checkpoint(TRUNCATE)"))));
}

TEST(RosbagReader, ABagThatIsCompressedAsAWholeIsNamedWithWhatUnpacksIt) {
  const auto file = write_file("bag.db3.zstd", "\x28\xB5\x2F\xFD and so on");
  EXPECT_THAT([&] { read_file_of_bag(file); },
              ThrowsMessage<SetupError>(HasSubstr("unzstd bag.db3.zstd -o bag.db3")));
}

TEST(RosbagReader, RectifiedImagesAreThoseOfAPinholeCamera) {
  const auto info = bag_camera_info(64, 48, {50, 30, 51, 22});
  const auto rectified = read_with({bag_image("/camera/image_rect", "mono8", 64, 48, 1), info});
  const CameraConfig& camera = rectified.log.robot.camera;
  EXPECT_EQ(camera.fx_px, 50.0);
  EXPECT_EQ(camera.cx_px, 30.0);
  EXPECT_EQ(camera.fy_px, 51.0);
  EXPECT_EQ(camera.cy_px, 22.0);
  EXPECT_THAT(camera.distortion, AllOf(SizeIs(5), Each(0.0)));
  EXPECT_THAT(rectified.report.notes(), Contains(HasSubstr("the images are rectified")));

  const auto raw = read_with({bag_image("/camera/image_raw", "mono8", 64, 48, 1), info});
  EXPECT_EQ(raw.log.robot.camera.fx_px, 55.0);
  EXPECT_EQ(raw.log.robot.camera.distortion[1], -0.2);
}

TEST(RosbagReader, RectifiedImagesWithoutAProjectionHaveNoDistortionEither) {
  const auto info = bag_camera_info(64, 48, {0, 0, 0, 0});
  const auto read = read_with({bag_image("/camera/image_rect", "mono8", 64, 48, 1), info});
  EXPECT_EQ(read.log.robot.camera.fx_px, 55.0);
  EXPECT_THAT(read.log.robot.camera.distortion, Each(0.0));
  EXPECT_THAT(read.report.notes(), Contains(HasSubstr("CameraInfo has no P")));
}

TEST(RosbagReader, RectifiedImagesNeedNoCameraMatrix) {
  const auto info = bag_camera_info(64, 48, {50, 30, 51, 22}, 0.0);
  const auto read = read_with({bag_image("/camera/image_rect", "mono8", 64, 48, 1), info});
  EXPECT_EQ(read.log.robot.camera.fx_px, 50.0);
}

TEST(RosbagReader, ATransformWithoutARotationIsNamedAndTheOthersOfItsMessageAreRead) {
  const auto read = read_with({bag_transforms({0, 0, 0, 0})});
  EXPECT_EQ(read.log.robot.lidar.x_m, 0.25);
  EXPECT_EQ(read.report.skipped_by_kind().at("bad transform of arm"), 1);
  EXPECT_EQ(read_with({bag_transforms({0, 0, 0, 1})}).report.num_skipped(), 0);
}

TEST(RosbagReader, ImagesOfAnEncodingThatIsNotReadAreNamedWithIt) {
  const auto read = read_with({bag_image("/camera/image_raw", "16UC1", 64, 48, 2)});
  EXPECT_THAT(read.log.images, SizeIs(0));
  EXPECT_THAT(read.report.messages(), Contains(HasSubstr("/camera/image_raw: '16UC1'")));
}

TEST(RosbagReader, MosaicAndYuvImagesAreRead) {
  for (const char* encoding : {"bayer_rggb8", "bayer_bggr8", "bayer_gbrg8", "bayer_grbg8"}) {
    EXPECT_THAT(read_with({bag_image("/image", encoding, 64, 48, 1)}).log.images, SizeIs(1));
    EXPECT_NO_THROW(read_with({bag_image("/image", encoding, 1, 1, 1)})) << encoding;
  }
  for (const char* encoding : {"yuv422", "uyvy", "yuv422_yuy2", "yuyv"}) {
    EXPECT_THAT(read_with({bag_image("/image", encoding, 64, 48, 2)}).log.images, SizeIs(1));
    EXPECT_NO_THROW(read_with({bag_image("/image", encoding, 1, 1, 2)})) << encoding;
  }
}

TEST(RosbagReader, ScansWithTooManyBeamsAreNamedWithTheLimit) {
  const auto read = read_with({bag_scan(5, 6284)});
  EXPECT_EQ(read.report.skipped_by_kind().at("too many beams"), 1);
  EXPECT_THAT(read.report.messages(), Contains(HasSubstr("6284, at most 4000 are read")));
}

}  // namespace
}  // namespace waymark
