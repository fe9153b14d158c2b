// SPDX-License-Identifier: BSD-3-Clause
#include "common/messages/codec.hpp"
#include "import/rosbag/mounting.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const SensorFrames kFrames{.base = "base", .lidar = "laser", .camera = "optical"};

StaticFrames frames_with(const std::string& child, const Eigen::Isometry3d& base_from_child) {
  StaticFrames frames;
  frames.add({.parent = "base", .child = child, .parent_from_child = base_from_child},
             TransformSource::kStatic);
  return frames;
}

Eigen::Isometry3d pose_of_laser(double roll_rad, double yaw_rad) {
  Eigen::Isometry3d base_from_laser = Eigen::Isometry3d::Identity();
  base_from_laser.translate(Eigen::Vector3d{0.1, -0.2, 0.3});
  base_from_laser.rotate(Eigen::AngleAxisd{yaw_rad, Eigen::Vector3d::UnitZ()});
  base_from_laser.rotate(Eigen::AngleAxisd{roll_rad, Eigen::Vector3d::UnitX()});
  return base_from_laser;
}

struct DescribedLidar {
  LidarConfig lidar{};
  LidarOrientation orientation{};
  ImportReport report{"bag", AddressUnit::kRow};
};

DescribedLidar lidar_in(const StaticFrames& frames, const LidarMounting& given = {}) {
  DescribedLidar described;
  described.orientation = describe_lidar(described.lidar, frames, kFrames, given, described.report);
  return described;
}

TEST(RosbagMounting, TheLidarsPlaceAndYawAreThoseOfItsTransform) {
  const auto upright = lidar_in(frames_with("laser", pose_of_laser(0.0, 2.0)));
  EXPECT_EQ(upright.orientation, LidarOrientation::kUpright);
  EXPECT_NEAR(upright.lidar.x_m, 0.1, 1e-12);
  EXPECT_NEAR(upright.lidar.y_m, -0.2, 1e-12);
  EXPECT_NEAR(upright.lidar.z_m, 0.3, 1e-12);
  EXPECT_NEAR(upright.lidar.yaw_rad, 2.0, 1e-12);
  EXPECT_THAT(upright.report.notes(), IsEmpty());

  const auto hanging = lidar_in(frames_with("laser", pose_of_laser(std::numbers::pi, 2.0)));
  EXPECT_EQ(hanging.orientation, LidarOrientation::kUpsideDown);
  EXPECT_NEAR(hanging.lidar.yaw_rad, 2.0, 1e-12);
  EXPECT_THAT(hanging.report.notes(), ElementsAre(HasSubstr("upside down")));
}

TEST(RosbagMounting, ALidarThatIsNotLevelIsNoted) {
  EXPECT_THAT(lidar_in(frames_with("laser", pose_of_laser(0.1, 0.0))).report.notes(), IsEmpty());
  EXPECT_THAT(lidar_in(frames_with("laser", pose_of_laser(0.3, 0.0))).report.notes(),
              ElementsAre(HasSubstr("laser is not level in base")));
}

TEST(RosbagMounting, ValuesOfTheUserOverrideTheTransform) {
  const auto described =
      lidar_in(frames_with("laser", pose_of_laser(0.0, 2.0)), {.y_m = 0.5, .yaw_rad = -1.0});
  EXPECT_NEAR(described.lidar.x_m, 0.1, 1e-12);
  EXPECT_EQ(described.lidar.y_m, 0.5);
  EXPECT_EQ(described.lidar.yaw_rad, -1.0);
  EXPECT_EQ(lidar_in({}, {.x_m = 0.4}).lidar.x_m, 0.4);
}

struct DescribedCamera {
  CameraConfig camera{};
  ImportReport report{"bag", AddressUnit::kRow};
};

DescribedCamera camera_in(const StaticFrames& frames,
                          const std::optional<RosCameraInfo>& info = std::nullopt) {
  image_t image{};
  image.width = 64;
  image.height = 48;
  DescribedCamera described;
  describe_camera(described.camera, frames, kFrames, info,
                  {.message = encode(channels::kCamera, image)}, ImageRectification::kRaw,
                  described.report);
  return described;
}

TEST(RosbagMounting, ACameraLooksWhereItsTransformSays) {
  CameraConfig expected{};
  expected.x_m = 0.3;
  expected.y_m = -0.1;
  expected.z_m = 0.5;
  for (const double yaw_rad : {-2.0, 0.0, 0.5}) {
    for (const double pitch_rad : {-0.4, 0.0, 0.3}) {
      for (const double roll_rad : {-1.5, 0.0, 0.2}) {
        expected.yaw_rad = yaw_rad;
        expected.pitch_rad = pitch_rad;
        expected.roll_rad = roll_rad;
        const CameraConfig found =
            camera_in(frames_with("optical", expected.base_from_camera())).camera;
        EXPECT_NEAR(found.yaw_rad, yaw_rad, 1e-9);
        EXPECT_NEAR(found.pitch_rad, pitch_rad, 1e-9);
        EXPECT_NEAR(found.roll_rad, roll_rad, 1e-9);
        EXPECT_TRUE(found.base_from_camera().isApprox(expected.base_from_camera(), 1e-9));
      }
    }
  }
}

TEST(RosbagMounting, ALensOfAnotherModelOrImageSizeIsNotGuessedSilently) {
  RosCameraInfo info{.width_px = 64,
                     .height_px = 48,
                     .distortion_model = "plumb_bob",
                     .distortion = {0.1, -0.2},
                     .camera_matrix = {55, 0, 31, 0, 56, 23, 0, 0, 1}};
  const StaticFrames frames = frames_with("optical", CameraConfig{}.base_from_camera());
  const auto known = camera_in(frames, info);
  EXPECT_EQ(known.camera.fx_px, 55.0);
  EXPECT_EQ(known.camera.fy_px, 56.0);
  EXPECT_THAT(known.camera.distortion, ElementsAre(0.1, -0.2, 0.0, 0.0, 0.0));
  EXPECT_THAT(known.report.notes(), IsEmpty());

  info.distortion_model = "equidistant";
  const auto fisheye = camera_in(frames, info);
  EXPECT_EQ(fisheye.camera.fx_px, 55.0);
  EXPECT_THAT(fisheye.camera.distortion, ElementsAre(0.0, 0.0, 0.0, 0.0, 0.0));
  EXPECT_THAT(fisheye.report.notes(), ElementsAre(HasSubstr("'equidistant' is not known")));

  info.height_px = 49;
  const auto other_size = camera_in(frames, info);
  EXPECT_EQ(other_size.camera.fx_px, CameraConfig{}.fx_px);
  EXPECT_THAT(other_size.report.notes(), ElementsAre(HasSubstr("images of 64x49")));
}

}  // namespace
}  // namespace waymark
