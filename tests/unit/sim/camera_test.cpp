// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/camera/camera.hpp"

#include "sim/core/camera/image_noise.hpp"
#include "sim/core/camera/lens.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <cmath>

namespace waymark {
namespace {

cv::Mat grey(int level) {
  return {cv::Size{640, 480}, CV_8UC1, cv::Scalar(level)};
}

TEST(ImageNoise, HasTheConfiguredSpreadAndNoBias) {
  cv::Mat picture = grey(128);
  ImageNoise{3.0, 1}.add_to(picture, 0);
  cv::Scalar mean, sigma;
  cv::meanStdDev(picture, mean, sigma);
  EXPECT_NEAR(mean[0], 128.0, 0.05);                         // sigma of the mean: 0.006
  EXPECT_NEAR(sigma[0], std::sqrt(9.0 + 1.0 / 12.0), 0.03);  // rounding adds 1/12
}

TEST(ImageNoise, FramesAreIndependentAndRepeatable) {
  const ImageNoise noise{3.0, 1};
  cv::Mat first = grey(128), again = grey(128), second = grey(128);
  noise.add_to(first, 0);
  noise.add_to(again, 0);
  noise.add_to(second, 1);
  EXPECT_EQ(cv::norm(first, again), 0.0);
  cv::Mat product;
  cv::multiply(first - 118, second - 118, product, 1.0, CV_64F);
  EXPECT_NEAR(cv::mean(product)[0], 100.0, 0.5);  // E[(10+a)(10+b)] of uncorrelated a, b
}

TEST(ImageNoise, WhitePixelsDoNotWrapToBlackNorBlackOnesToWhite) {
  cv::Mat white = grey(255), black = grey(0);
  ImageNoise{10.0, 1}.add_to(white, 0);
  ImageNoise{10.0, 1}.add_to(black, 0);
  double low = 0.0, high = 0.0;
  cv::minMaxLoc(white, &low, &high);
  EXPECT_GT(low, 150.0);
  cv::minMaxLoc(black, &low, &high);
  EXPECT_LT(high, 100.0);
}

TEST(Lens, WithoutDistortionThePictureIsPassedThroughUncopied) {
  const Lens lens{CameraConfig{}};
  EXPECT_EQ(lens.pinhole().width_px, 640);
  EXPECT_EQ(lens.pinhole().cx_px, 319.5);
  const cv::Mat picture = grey(7);
  EXPECT_EQ(lens.apply(picture).data, picture.data);
}

TEST(Lens, DistortionFollowsOpenCvsProjection) {
  CameraConfig camera{};
  camera.distortion = {0.16, -0.25, 0.001, -0.002, 0.05};
  camera.fy_px = 520.0;
  const Lens lens{camera};
  const Pinhole& pinhole = lens.pinhole();
  const cv::Matx33d intrinsics{
      camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
  for (const cv::Point3d ray : {cv::Point3d{0.3, 0.2, 1}, {-0.5, 0.35, 1}, {0.0, -0.4, 1}}) {
    // A soft dot where the ray meets the pinhole's picture ...
    cv::Mat dot{cv::Size{pinhole.width_px, pinhole.height_px}, CV_8UC1, cv::Scalar(0)};
    const cv::Point2d at{pinhole.cx_px + pinhole.focal_px * ray.x,
                         pinhole.cy_px + pinhole.focal_px * ray.y};
    cv::circle(dot, at * 256, 4 * 256, cv::Scalar(255), cv::FILLED, cv::LINE_AA, 8);
    const cv::Moments moments = cv::moments(lens.apply(dot));
    // ... is found where OpenCV projects the ray.
    std::vector<cv::Point2d> projected;
    cv::projectPoints(std::vector<cv::Point3d>{ray}, cv::Vec3d{}, cv::Vec3d{}, intrinsics,
                      camera.distortion, projected);
    EXPECT_NEAR(moments.m10 / moments.m00, projected[0].x, 0.1);
    EXPECT_NEAR(moments.m01 / moments.m00, projected[0].y, 0.1);
  }
}

TEST(Camera, CompressesAtTheConfiguredQuality) {
  const Camera camera{{}, {}, 1};
  const cv::Mat rendered{cv::Size{640, 480}, CV_8UC3, cv::Scalar(100, 120, 140)};
  const cv::Mat picture = camera.expose(rendered, 0);
  const CameraFrame frame = camera.compress(picture, timestamp_from_us(5));
  EXPECT_EQ(frame.time, timestamp_from_us(5));
  EXPECT_EQ(frame.jpeg_quality, CameraNoiseConfig{}.jpeg_quality);
  const cv::Mat decoded = cv::imdecode(frame.jpeg, cv::IMREAD_UNCHANGED);
  EXPECT_EQ(decoded.size(), picture.size());
  EXPECT_EQ(decoded.channels(), 1);
  EXPECT_LT(cv::norm(decoded, picture, cv::NORM_L1), 3.0 * 640 * 480);
}

TEST(Camera, LowersTheQualityUntilTheFrameFits) {
  CameraNoiseConfig noise{};
  noise.sigma_grey_levels = 25.0;
  noise.colour = ImageColour::kColour;
  noise.jpeg_quality = 95;
  const Camera camera{{}, noise, 1};
  const cv::Mat rendered{cv::Size{640, 480}, CV_8UC3, cv::Scalar(100, 120, 140)};
  const CameraFrame frame = camera.compress(camera.expose(rendered, 0), {});
  EXPECT_LE(frame.jpeg.size(), kMaxJpegBytes);
  EXPECT_LT(frame.jpeg_quality, 95);
  EXPECT_EQ(cv::imdecode(frame.jpeg, cv::IMREAD_UNCHANGED).channels(), 3);
}

TEST(Camera, ARandomPictureHasTheCamerasSizeAndFits) {
  for (const cv::Size size : {cv::Size{640, 480}, cv::Size{1283, 727}, cv::Size{1920, 1080}}) {
    for (const ImageColour colour : {ImageColour::kGrey, ImageColour::kColour}) {
      CameraConfig config{};
      config.width_px = size.width;
      config.height_px = size.height;
      const Camera camera{config, {.colour = colour}, 1};
      Random random{1};
      const CameraFrame frame = camera.compress(camera.random_picture(random), {});
      EXPECT_LE(frame.jpeg.size(), kMaxJpegBytes) << size;
      const cv::Mat decoded = cv::imdecode(frame.jpeg, cv::IMREAD_GRAYSCALE);
      EXPECT_EQ(decoded.size(), size);
      cv::Scalar mean, sigma;
      cv::meanStdDev(decoded, mean, sigma);
      EXPECT_NEAR(mean[0], 127.5, 3.0) << size;
      EXPECT_GT(sigma[0], 25.0) << size;  // 74 before compression
    }
  }
}

TEST(Camera, APictureTooLargeForADatagramNamesTheKey) {
  const Camera camera{{}, {}, 1};
  const cv::Mat picture{cv::Size{4000, 3000}, CV_8UC1, cv::Scalar(100)};
  try {
    camera.compress(picture, {});
    FAIL() << "no error";
  } catch (const SimulatorError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("robot.camera.width_px"));
  }
}

TEST(Camera, BlurSmoothsEdges) {
  CameraNoiseConfig noise{};
  noise.sigma_grey_levels = 0.0;
  noise.blur_sigma_px = 2.0;
  cv::Mat rendered{cv::Size{640, 480}, CV_8UC3, cv::Scalar::all(0)};
  rendered.colRange(320, 640).setTo(cv::Scalar::all(200));
  const cv::Mat picture = Camera{{}, noise, 1}.expose(rendered, 0);
  EXPECT_GT(picture.at<std::uint8_t>(240, 318), 10);
  EXPECT_LT(picture.at<std::uint8_t>(240, 321), 190);
}

}  // namespace
}  // namespace waymark
