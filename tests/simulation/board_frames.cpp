// SPDX-License-Identifier: BSD-3-Clause
// Writes a log of camera frames that show a ChArUco board, with the camera of a robot.toml: the
// simulator's world has no board.
#include "common/config/config.hpp"
#include "common/log/log_file.hpp"
#include "common/messages/channels.hpp"
#include "common/messages/codec.hpp"
#include "unit/calibrate/rendered_board.hpp"

#include <fmt/format.h>

#include <cstdlib>

int main(int argc, char** argv) {
  using namespace waymark;
  if (argc != 5) {
    fmt::print(stderr, "usage: {} ROBOT_TOML LOG NUM_FRAMES SEED\n", argv[0]);
    return 2;
  }
  const CameraConfig camera = load_config<RobotOnly>({{argv[1]}, {}}).robot.camera;
  Random random{std::strtoull(argv[4], nullptr, 10), 26};
  const calibrate::BoardRenderer renderer{camera};
  constexpr double kShareOfImage = 0.75;
  constexpr double kMaxTilt_rad = 0.7;
  constexpr std::int64_t kPeriod_us = 100'000;
  LogWriter writer{argv[2]};
  image_t image{};
  for (const Eigen::Isometry3d& view :
       calibrate::hand_held(std::atoi(argv[3]), kShareOfImage, kMaxTilt_rad, random, camera)) {
    const cv::Mat gray = renderer.picture(view, random);
    image.utime += kPeriod_us;
    image.width = image.row_stride = gray.cols;
    image.height = gray.rows;
    image.pixelformat = image_t::PIXEL_FORMAT_GRAY;
    image.data.assign(gray.datastart, gray.dataend);
    image.size = static_cast<std::int32_t>(image.data.size());
    writer.write(encode(channels::kCamera, image));
  }
  writer.close();
  return 0;
}
