// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/camera_report.hpp"
#include "common/command_line/command_line.hpp"
#include "common/errors/exit_codes.hpp"
#include "common/errors/setup_error.hpp"
#include "common/files/whole_file.hpp"
#include "common/files/writable_folder.hpp"
#include "common/logging/logging.hpp"
#include "common/pictures/png.hpp"
#include "common/runtime/guard.hpp"

#include <fmt/format.h>
#include <opencv2/core/utils/logger.hpp>

namespace waymark::calibrate {
namespace {

constexpr ProcessTraits kTraits{"calibrate", "Measures a robot's camera with a board.", false};

struct Options {
  std::filesystem::path input{};
  std::string board_type{"charuco"};
  BoardOptions board{};
  std::filesystem::path out{};
  std::filesystem::path coverage{};
};

void write_coverage(const CameraCalibration& calibration, const std::filesystem::path& file) {
  if (file.empty() || calibration.frames.size.empty()) return;
  write_whole_file(file, png_bytes(coverage_picture(calibration)));
}

int run(const Options& options) {
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  cv::setNumThreads(1);
  if (std::filesystem::exists(options.out))
    throw SetupError{options.out.string() +
                     ": is there already; give --out another name, or move it away"};
  check_output_file("--out", options.out);
  if (!options.coverage.empty()) check_output_file("--coverage", options.coverage);
  const auto board = make_board(options.board);
  const CameraCalibration calibration = calibrate_camera(options.input, board);
  fmt::print("{}", to_text(calibration));
  write_coverage(calibration, options.coverage);
  if (!calibration.missing.empty()) {
    logging::error("{}", refusal(calibration, options.input.string()));
    return kExitFailed;
  }
  write_whole_file(options.out, to_camera_toml(calibration, options.input.filename().string()));
  fmt::print("{}: [robot.camera] written\n", options.out.string());
  return kExitOk;
}

}  // namespace
}  // namespace waymark::calibrate

int main(int argc, char** argv) {
  using namespace waymark;
  calibrate::Options options;
  Program app{
      "Measures a robot's camera with a board.\nExit code: 0 written; 1 views are missing, or a "
      "file cannot be written; 2 wrong usage, or no frames.",
      "waymark-calibrate"};
  app.require_subcommand();
  Command camera = app.add_subcommand(
      "camera", "focal length, principal point and distortion, from frames that show a board");
  camera.add_option("INPUT", options.input, "folder with pictures, or LCM log with CAMERA")
      .required();
  camera.add_option("--board", options.board_type, "kind of board")
      .one_of({"charuco"})
      .show_default();
  camera.add_option("--squares", options.board.squares, "columns x rows").show_default();
  camera.add_option("--square-m", options.board.square_m, "side of a square [m]").show_default();
  camera.add_option("--marker-m", options.board.marker_m, "side of a marker [m]").show_default();
  camera.add_option("--dictionary", options.board.dictionary, "of its markers, OpenCV's name")
      .show_default();
  camera.add_option("--out", options.out, "TOML file for [robot.camera]; replaces none").required();
  camera.add_option("--coverage", options.coverage,
                    "PNG of the corners seen, with their residuals 100 times as long");
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  return run_guarded(calibrate::kTraits, [&] { return calibrate::run(options); });
}
