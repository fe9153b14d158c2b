// SPDX-License-Identifier: BSD-3-Clause
// waymark-calibrate: folders, logs, exit codes, and the files that it writes.
#include "common/config/config.hpp"
#include "common/log/log_file.hpp"
#include "common/messages/channels.hpp"
#include "common/messages/codec.hpp"
#include "rendered_board.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <cstdlib>
#include <fstream>

namespace waymark::calibrate {
namespace {

using ::testing::HasSubstr;

std::string read_file(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

struct Ended {
  int code{-1};
  std::string out{};
  std::string errors{};
};

Ended calibrate(const std::string& arguments) {
  const evaluate::TemporaryFolder folder;
  const std::string command = std::string{WAYMARK_BUILD_DIR} + "/waymark-calibrate " + arguments +
                              " >" + (folder.path() / "out").string() + " 2>" +
                              (folder.path() / "errors").string();
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, read_file(folder.path() / "out"),
          read_file(folder.path() / "errors")};
}

std::vector<cv::Mat> pictures(int num_views) {
  const BoardRenderer renderer{known_camera()};
  Random random{1, 26};
  std::vector<cv::Mat> pictures;
  for (const Eigen::Isometry3d& place : hand_held(num_views, 0.75, 0.7, random))
    pictures.push_back(renderer.picture(place, random));
  return pictures;
}

std::string write_frames(const std::filesystem::path& folder, const std::vector<cv::Mat>& frames) {
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < frames.size(); ++i)
    cv::imwrite((folder / ("view_" + std::to_string(100 + i) + ".png")).string(), frames[i]);
  return folder.string();
}

image_t message_of(const cv::Mat& gray, std::int64_t time_us) {
  image_t image{};
  image.utime = time_us;
  image.width = image.row_stride = gray.cols;
  image.height = gray.rows;
  image.pixelformat = image_t::PIXEL_FORMAT_GRAY;
  image.data.assign(gray.datastart, gray.dataend);
  image.size = static_cast<std::int32_t>(image.data.size());
  return image;
}

void expect_known_camera(const std::filesystem::path& toml) {
  const CameraConfig truth = known_camera();
  const CameraConfig camera = load_config<RobotOnly>({{toml}, {}}).robot.camera;
  EXPECT_EQ(camera.width_px, truth.width_px);
  EXPECT_EQ(camera.height_px, truth.height_px);
  EXPECT_NEAR(camera.fx_px / truth.fx_px, 1.0, 0.001);
  EXPECT_NEAR(camera.fy_px / truth.fy_px, 1.0, 0.001);
  EXPECT_NEAR(camera.cx_px, truth.cx_px, 1.0);
  EXPECT_NEAR(camera.cy_px, truth.cy_px, 1.0);
  EXPECT_NEAR(camera.distortion.at(0), truth.distortion.at(0), 0.03);
  EXPECT_GT(camera.focal_sigma, 0.0);
  EXPECT_LT(camera.focal_sigma, 0.001);
  EXPECT_EQ(camera.x_m, CameraConfig{}.x_m) << "the mounting is not measured";
}

TEST(CalibrateProgram, AFolderOfImagesGivesACameraAndUnusableImagesAreListed) {
  const evaluate::TemporaryFolder folder;
  const std::string frames = write_frames(folder.path() / "frames", pictures(24));
  folder.file("frames/broken.png", "no picture\n");
  cv::imwrite(frames + "/white.png", cv::Mat(480, 640, CV_8UC1, cv::Scalar{255}));
  cv::imwrite(frames + "/zz_small.png", cv::Mat(100, 100, CV_8UC1, cv::Scalar{255}));
  const std::string toml = (folder.path() / "camera.toml").string();
  const std::string coverage = (folder.path() / "coverage.png").string();

  const Ended ended = calibrate("camera " + frames +
                                " --board charuco --squares 7x5 --square-m 0.032 --marker-m "
                                "0.024 --dictionary DICT_5X5_100 --out " +
                                toml + " --coverage " + coverage);

  ASSERT_EQ(ended.code, 0) << ended.errors;
  EXPECT_THAT(ended.out, HasSubstr("27 frames"));
  EXPECT_THAT(ended.out, HasSubstr("1 frames not used, no picture that can be read: broken.png"));
  EXPECT_THAT(ended.out, HasSubstr("another size than the first frame's: zz_small.png"));
  EXPECT_THAT(ended.out, HasSubstr("1 frames without the board: white.png"));
  EXPECT_THAT(ended.out, HasSubstr("reprojection error 0.0"));
  expect_known_camera(toml);
  const cv::Mat picture = cv::imread(coverage);
  EXPECT_EQ(picture.size(), cv::Size(640, 480));
  EXPECT_LT(cv::mean(picture)[0], 254.0);

  const std::string before = read_file(toml);
  const Ended again = calibrate("camera " + frames + " --out " + toml);
  EXPECT_EQ(again.code, 2);
  EXPECT_THAT(again.errors, HasSubstr("is there already"));
  EXPECT_EQ(read_file(toml), before);
}

TEST(CalibrateProgram, AnLcmLogGivesACameraAndItsBadFramesAreNamed) {
  const evaluate::TemporaryFolder folder;
  const std::string log = (folder.path() / "run.lcm").string();
  LogWriter writer{log};
  std::int64_t time_us = 0;
  for (const cv::Mat& frame : pictures(24))
    writer.write(encode(channels::kCamera, message_of(frame, time_us += 100'000)));
  image_t no_jpeg = message_of(cv::Mat::zeros(480, 640, CV_8UC1), time_us += 100'000);
  no_jpeg.pixelformat = image_t::PIXEL_FORMAT_MJPEG;
  writer.write(encode(channels::kCamera, no_jpeg));
  image_t cut = message_of(cv::Mat::zeros(480, 640, CV_8UC1), time_us += 100'000);
  cut.data.resize(100);
  cut.size = 100;
  writer.write(encode(channels::kCamera, cut));
  Message damaged = encode(channels::kCamera, cut);
  damaged.payload.resize(damaged.payload.size() / 2);
  writer.write(damaged);
  writer.close();
  const std::string toml = (folder.path() / "camera.toml").string();

  const Ended ended = calibrate("camera " + log + " --out " + toml);

  ASSERT_EQ(ended.code, 0) << ended.errors;
  EXPECT_THAT(ended.out, HasSubstr("not a JPEG: frame 24"));
  EXPECT_THAT(ended.out, HasSubstr("image shorter than its size says: frame 25"));
  EXPECT_THAT(ended.out, HasSubstr("damaged message: frame 26"));
  expect_known_camera(toml);
}

TEST(CalibrateProgram, TooFewViewsGive1AndUnusableInputGives2) {
  const evaluate::TemporaryFolder folder;
  const std::string few = write_frames(folder.path() / "few", pictures(5));
  const std::string empty = write_frames(folder.path() / "empty", {});
  const auto text = folder.file("text.lcm", "no log\n").string();
  const std::string out = " --out " + (folder.path() / "camera.toml").string();

  const Ended refused = calibrate("camera " + few + out);
  EXPECT_EQ(refused.code, 1);
  EXPECT_THAT(refused.errors, HasSubstr("5 more different views of the board"));
  const Ended other = calibrate("camera " + few + " --dictionary DICT_4X4_50" + out);
  EXPECT_EQ(other.code, 1);
  EXPECT_THAT(other.out, HasSubstr("5 frames without the board: view_100.png"));
  const std::string nowhere = (folder.path() / "none/camera.toml").string();
  const Ended unwritable = calibrate("camera " + few + " --out " + nowhere);
  EXPECT_EQ(unwritable.code, 2);
  EXPECT_THAT(unwritable.errors, HasSubstr("--out: there is no folder"));
  EXPECT_EQ(unwritable.out, "") << "no work before the refusal";
  for (const std::string& arguments :
       {std::string{}, "camera" + out, "camera " + few, "camera " + empty + out,
        "camera " + text + out, "camera " + few + "/missing" + out,
        "camera " + few + " --board chess" + out, "camera " + few + " --squares 7" + out,
        "camera " + few + " --marker-m 0.05" + out,
        "camera " + few + " --dictionary DICT_9X9" + out}) {
    const Ended ended = calibrate(arguments);
    EXPECT_EQ(ended.code, 2) << arguments;
    EXPECT_FALSE(ended.errors.empty()) << arguments;
  }
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "camera.toml"));
}

}  // namespace
}  // namespace waymark::calibrate
