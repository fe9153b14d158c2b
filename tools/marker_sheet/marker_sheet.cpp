// SPDX-License-Identifier: BSD-3-Clause
#include "marker_sheet/marker_sheet.hpp"

#include "common/files/whole_file.hpp"
#include "common/markers/marker_dictionary.hpp"
#include "common/pictures/png.hpp"

#include <fmt/format.h>
#include <opencv2/aruco.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <string_view>

namespace waymark::marker_sheet {
namespace {

constexpr double kInch_m = 0.0254;
constexpr int kMaxSide_px = 20'000;  ///< 1.7 m at 300 dpi; guards the memory
constexpr double kMaxSide_m = 10.0;  ///< limit of robot.markers.size_m
constexpr int kMaxQuietZone_modules = 20;
constexpr int kMaxId = 100'000;  ///< more than any dictionary has; guards against endless ranges

cv::aruco::Dictionary dictionary_of(const std::string& name) {
  if (const auto dictionary = find_dictionary(name)) return *dictionary;
  throw std::runtime_error{fmt::format("--dictionary: got '{}', expected one of {}", name,
                                       fmt::join(dictionary_names(), ", "))};
}

int parse_id(std::string_view text, const std::string& whole) {
  int id{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), id);
  if (error != std::errc{} || stop != text.data() + text.size() || id < 0 || id > kMaxId)
    throw std::runtime_error{
        fmt::format("--ids: got '{}', expected ids and ranges as in 0-5,9", whole)};
  return id;
}

/// Side of a module at the wanted resolution [px], not rounded.
double module_px(const SheetOptions& options, int modules_per_side) {
  return options.size_m / modules_per_side * options.dpi / kInch_m;
}

void append_uint32(std::string& bytes, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes += static_cast<char>((value >> shift) & 0xffu);
}

/// Source: PNG specification (ISO/IEC 15948), annex D.
std::uint32_t crc32(std::string_view bytes) {
  std::uint32_t crc = 0xffffffffu;
  for (const char byte : bytes) {
    crc ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit)
      crc = (crc & 1u) != 0 ? (crc >> 1) ^ 0xedb88320u : crc >> 1;
  }
  return ~crc;
}

/// The pHYs chunk (resolution), which OpenCV cannot write.
std::string size_chunk(double pixels_per_m) {
  std::string content = "pHYs";
  const auto rounded = static_cast<std::uint32_t>(std::lround(pixels_per_m));
  append_uint32(content, rounded);
  append_uint32(content, rounded);
  content += '\1';  // the unit is the metre
  std::string chunk;
  append_uint32(chunk, static_cast<std::uint32_t>(content.size() - 4));
  chunk += content;
  append_uint32(chunk, crc32(content));
  return chunk;
}

}  // namespace

std::vector<int> parse_ids(const std::string& text) {
  std::vector<int> ids;
  std::istringstream parts{text};
  for (std::string part; std::getline(parts, part, ',');) {
    const std::size_t dash = part.find('-');
    const int first = parse_id(std::string_view{part}.substr(0, dash), text);
    const int last =
        dash == std::string::npos ? first : parse_id(std::string_view{part}.substr(dash + 1), text);
    if (last < first) throw std::runtime_error{fmt::format("--ids: range {} is empty", part)};
    for (int id = first; id <= last; ++id)
      ids.push_back(id);
  }
  if (ids.empty()) throw std::runtime_error{"--ids: no id in it; expected as in 0-5,9"};
  return ids;
}

cv::Mat marker_modules(const SheetOptions& options, int id) {
  const cv::aruco::Dictionary dictionary = dictionary_of(options.dictionary);
  if (id < 0 || id >= size_of(dictionary))
    throw std::runtime_error{fmt::format("--ids: {} has the ids 0 to {}, got {}",
                                         options.dictionary, size_of(dictionary) - 1, id)};
  if (options.quiet_zone_modules < 1 || options.quiet_zone_modules > kMaxQuietZone_modules)
    throw std::runtime_error{fmt::format("--quiet-zone-modules: got {}, expected 1 to {}",
                                         options.quiet_zone_modules, kMaxQuietZone_modules)};
  if (!(options.size_m > 0.0 && options.size_m <= kMaxSide_m))
    throw std::runtime_error{fmt::format("--size-m: got {}, expected more than 0, up to {} m",
                                         options.size_m, kMaxSide_m)};
  const int modules = modules_per_side(dictionary);
  cv::Mat marker;
  cv::aruco::drawMarker(cv::makePtr<cv::aruco::Dictionary>(dictionary), id, modules, marker, 1);
  return marker;
}

void check_sheet(const SheetOptions& options, int id) {
  const int modules = marker_modules(options, id).cols;
  const double exact_px = module_px(options, modules);
  const double sheet_px = exact_px * (modules + 2.0 * options.quiet_zone_modules);
  if (!(options.dpi > 0.0 && exact_px >= 1.0 && sheet_px <= kMaxSide_px))
    throw std::runtime_error{fmt::format(
        "--size-m {} at --dpi {}: a module must have at least a pixel, the sheet at most {} pixels",
        options.size_m, options.dpi, kMaxSide_px)};
}

Sheet draw_sheet(const SheetOptions& options, int id) {
  check_sheet(options, id);
  const cv::Mat drawn = marker_modules(options, id);
  const int of_module_px = static_cast<int>(std::lround(module_px(options, drawn.cols)));
  const int side_px = drawn.cols * of_module_px;
  const int margin_px = options.quiet_zone_modules * of_module_px;
  cv::Mat marker;
  cv::resize(drawn, marker, {side_px, side_px}, 0.0, 0.0, cv::INTER_NEAREST);
  const int text_px = std::max(of_module_px, 12);
  Sheet sheet{
      cv::Mat(side_px + 2 * margin_px + text_px, side_px + 2 * margin_px, CV_8UC1, cv::Scalar{255}),
      side_px / options.size_m};
  marker.copyTo(sheet.picture(cv::Rect{margin_px, margin_px, side_px, side_px}));
  const std::string text = fmt::format("{}  id {}  {} mm", options.dictionary, id,
                                       std::round(options.size_m * 1e4) / 10.0);
  int baseline_px{};
  const cv::Size unit = cv::getTextSize(text, cv::FONT_HERSHEY_SIMPLEX, 1.0, 1, &baseline_px);
  const double scale =
      std::min(1.0 * side_px / unit.width, 0.7 * text_px / (unit.height + baseline_px));
  cv::putText(sheet.picture, text, {margin_px, sheet.picture.rows - text_px / 3},
              cv::FONT_HERSHEY_SIMPLEX, scale, cv::Scalar{0},
              std::max(1, static_cast<int>(2.0 * scale)), cv::LINE_AA);
  return sheet;
}

void write_png(const Sheet& sheet, const std::filesystem::path& file) {
  std::string bytes = png_bytes(sheet.picture);
  constexpr std::size_t kAfterHeader = 8 + 25;  // signature and IHDR chunk
  bytes.insert(kAfterHeader, size_chunk(sheet.pixels_per_m));
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path());
  write_whole_file(file, bytes);
}

std::vector<std::filesystem::path> write_sheets(const SheetOptions& options,
                                                const std::vector<int>& ids,
                                                const std::filesystem::path& folder) {
  for (const int id : ids)
    check_sheet(options, id);
  std::vector<std::filesystem::path> files;
  for (const int id : ids) {
    files.push_back(folder / fmt::format("marker_{}_{:04}.png", options.dictionary, id));
    write_png(draw_sheet(options, id), files.back());
  }
  return files;
}

}  // namespace waymark::marker_sheet
