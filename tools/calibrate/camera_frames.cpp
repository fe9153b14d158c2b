// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/camera_frames.hpp"

#include "common/errors/setup_error.hpp"
#include "common/log/log_file.hpp"
#include "common/messages/channels.hpp"
#include "common/messages/codec.hpp"
#include "detector/image_message.hpp"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <array>
#include <cctype>

namespace waymark::calibrate {
namespace {

constexpr std::int64_t kMaxFrames = 400;  // frames of a log that are read
constexpr int kMinSide_px = 16;           // limits of robot.camera.width_px, height_px
constexpr int kMaxSide_px = 8192;
constexpr std::array<std::string_view, 8> kPictures{".png", ".jpg", ".jpeg", ".pgm",
                                                    ".ppm", ".bmp", ".tif",  ".tiff"};

class FrameSink {
 public:
  explicit FrameSink(const UseFrame& use) : use_{use} {}

  void refuse(const std::string& name, std::string_view reason) {
    ++counts_.num_frames;
    counts_.problems[std::string{reason}].push_back(name);
  }

  void use(const std::string& name, const cv::Mat& gray) {
    if (!is_possible(gray.size())) return refuse(name, "not 16 to 8192 pixels wide and high");
    if (counts_.size.empty()) counts_.size = gray.size();
    if (gray.size() != counts_.size) return refuse(name, "another size than the first frame's");
    ++counts_.num_frames;
    use_(name, gray);
  }

  static bool is_possible(cv::Size size) {
    return std::min(size.width, size.height) >= kMinSide_px &&
           std::max(size.width, size.height) <= kMaxSide_px;
  }

  const FrameCounts& counts() const { return counts_; }

 private:
  const UseFrame& use_;
  FrameCounts counts_{};
};

bool is_picture(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(), [](unsigned char letter) {
    return static_cast<char>(std::tolower(letter));
  });
  return std::ranges::find(kPictures, extension) != kPictures.end();
}

cv::Mat read_picture(const std::filesystem::path& file) {
  try {
    return cv::imread(file.string(), cv::IMREAD_GRAYSCALE | cv::IMREAD_IGNORE_ORIENTATION);
  } catch (const cv::Exception&) {
    return {};  // as for an unreadable file
  }
}

void read_folder(const std::filesystem::path& folder, FrameSink& sink) {
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator{folder}) {
    if (entry.is_regular_file() && is_picture(entry.path())) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  for (const auto& file : files) {
    const cv::Mat gray = read_picture(file);
    if (gray.empty()) {
      sink.refuse(file.filename().string(), "no picture that can be read");
    } else {
      sink.use(file.filename().string(), gray);
    }
  }
}

void read_image(const std::string& name, const image_t& image, FrameSink& sink) {
  const cv::Size size{image.width, image.height};
  if (!FrameSink::is_possible(size))
    return sink.refuse(name, "not 16 to 8192 pixels wide and high");
  const DecodedFrame frame = decode_image(image, size);
  if (frame.problem == FrameProblem::kNone) return sink.use(name, frame.gray);
  sink.refuse(name, frame.problem == FrameProblem::kWrongSize ? "another size than it says"
                                                              : to_string(frame.problem));
}

void read_log(const std::filesystem::path& log, FrameSink& sink) {
  const auto is_camera = [](std::string_view channel) {
    return channel == channels::kCamera.name;
  };
  std::int64_t num_frames = 0;
  for (LogReader reader{log}; reader.next(is_camera);)
    ++num_frames;
  const std::int64_t every = 1 + num_frames / kMaxFrames;
  LogReader reader{log};
  for (std::int64_t number = 0; const auto event = reader.next(is_camera); ++number) {
    if (number % every != 0) continue;
    const std::string name = fmt::format("frame {}", number);
    const auto image = decode<image_t>(event->payload);
    if (image.message) {
      read_image(name, *image.message, sink);
    } else {
      sink.refuse(name, "damaged message");
    }
  }
}

}  // namespace

FrameCounts read_frames(const std::filesystem::path& input, const UseFrame& use) {
  if (!std::filesystem::exists(input))
    throw SetupError{fmt::format("{}: there is no such folder or log", input.string())};
  FrameSink sink{use};
  const bool is_folder = std::filesystem::is_directory(input);
  if (is_folder) {
    read_folder(input, sink);
  } else {
    read_log(input, sink);
  }
  if (sink.counts().num_frames == 0)
    throw SetupError{fmt::format("{}: {}", input.string(),
                                 is_folder ? "no pictures in it (PNG, JPEG, PGM, PPM, BMP, TIFF)"
                                           : "no frames of CAMERA in it; is it an LCM log?")};
  return sink.counts();
}

}  // namespace waymark::calibrate
