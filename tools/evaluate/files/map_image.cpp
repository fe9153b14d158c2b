// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/files/map_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <string>

namespace waymark::evaluate {
namespace {

namespace fs = std::filesystem;

/// Larger than any building at 1 cm; bounds the memory for a wrong header.
constexpr long kMaxSide_px = 100'000;
constexpr long kMaxCells = 400'000'000;

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kBlank = " \t\"'";
  const std::size_t begin = text.find_first_not_of(kBlank);
  if (begin == std::string_view::npos) return {};
  return text.substr(begin, text.find_last_not_of(kBlank) - begin + 1);
}

/// The keys of map_server's format. Only flat `key: value` lines occur in it.
class MapYaml {
 public:
  explicit MapYaml(const fs::path& file) : file_{file} {
    const std::vector<std::string> lines = read_lines(file);
    for (std::size_t i = 0; i < lines.size(); ++i) {
      const std::string line = lines[i].substr(0, lines[i].find('#'));
      if (trimmed(line).empty() || trimmed(line) == "---") continue;
      const std::size_t colon = line.find(':');
      if (colon == std::string::npos)
        throw SetupError{at_line(file, i + 1, fmt::format("got '{}', expected key: value", line))};
      values_[std::string{trimmed(line.substr(0, colon))}] = trimmed(line.substr(colon + 1));
    }
  }

  std::string text(const std::string& key) const {
    const auto found = values_.find(key);
    if (found == values_.end() || found->second.empty())
      throw SetupError{fmt::format("{}: key '{}' is missing", file_.string(), key)};
    return found->second;
  }

  double number(const std::string& key) const {
    const auto numbers = parse_numbers(text(key));
    if (!numbers || numbers->size() != 1)
      throw SetupError{fmt::format("{}: {}: got '{}', expected a finite number", file_.string(),
                                   key, text(key))};
    return numbers->front();
  }

  std::string text_or(const std::string& key, const std::string& fallback) const {
    return values_.contains(key) ? text(key) : fallback;
  }

  /// Lower left corner of the image [m]; (0, 0) without the key. The yaw is ignored.
  Eigen::Vector2d origin() const {
    if (!values_.contains("origin")) return Eigen::Vector2d::Zero();
    std::string list = text("origin");
    std::erase_if(list, [](char c) { return c == '[' || c == ']'; });
    const auto numbers = parse_numbers(list);
    if (!numbers || numbers->size() < 2) refuse("origin", "[x, y, yaw]");
    return {numbers->at(0), numbers->at(1)};
  }

  [[noreturn]] void refuse(const std::string& key, std::string_view expected) const {
    throw SetupError{
        fmt::format("{}: {}: got '{}', expected {}", file_.string(), key, text(key), expected)};
  }

 private:
  fs::path file_;
  std::map<std::string, std::string> values_;
};

struct Picture {
  int width_px{};
  int height_px{};
  int max_value{};
  std::string pixels{};  ///< row by row, from the top
};

/// Next number of a PGM header, past white space and comments; -1 if there is none.
long header_number(const std::string& bytes, std::size_t& at) {
  while (at < bytes.size() &&
         (std::isspace(static_cast<unsigned char>(bytes[at])) != 0 || bytes[at] == '#'))
    at = bytes[at] == '#' ? std::min(bytes.find('\n', at), bytes.size()) : at + 1;
  long number = -1;
  for (; at < bytes.size() && std::isdigit(static_cast<unsigned char>(bytes[at])) != 0; ++at) {
    number = (number < 0 ? 0 : number) * 10 + (bytes[at] - '0');
    if (number > kMaxSide_px) return -1;
  }
  return number;
}

Picture read_pgm(const fs::path& file) {
  const std::string bytes = read_text(file);
  std::size_t at = 2;
  const long width = bytes.starts_with("P5") ? header_number(bytes, at) : -1;
  const long height = header_number(bytes, at);
  const long max_value = header_number(bytes, at);
  if (width <= 0 || height <= 0 || width * height > kMaxCells || max_value <= 0 || max_value > 255)
    throw SetupError{file.string() + ": not a binary 8-bit PGM (header 'P5 width height 255')"};
  const std::size_t begin = at + 1;  // one white-space character ends the header
  const auto size = static_cast<std::size_t>(width * height);
  if (bytes.size() < begin + size)
    throw SetupError{fmt::format("{}: truncated: {} of {} pixels", file.string(),
                                 bytes.size() - std::min(bytes.size(), begin), size)};
  return {static_cast<int>(width), static_cast<int>(height), static_cast<int>(max_value),
          bytes.substr(begin, size)};
}

/// @param folder  of the file that `yaml` was read from.
MapImage image_of(const MapYaml& yaml, const fs::path& folder) {
  const double resolution_m = yaml.number("resolution");
  if (resolution_m <= 0.0) yaml.refuse("resolution", "a length above 0 [m]");
  const double negate = yaml.number("negate");
  if (negate != 0.0 && negate != 1.0) yaml.refuse("negate", "0 or 1");
  const double occupied_above = yaml.number("occupied_thresh");
  const double free_below = yaml.number("free_thresh");
  if (free_below < 0.0 || free_below > occupied_above || occupied_above > 1.0)
    yaml.refuse("free_thresh", "0 <= free_thresh <= occupied_thresh <= 1");
  if (yaml.text_or("mode", "trinary") != "trinary") yaml.refuse("mode", "trinary");

  const Picture picture = read_pgm(folder / yaml.text("image"));
  MapImage map{picture.width_px, picture.height_px, resolution_m, {}};
  map.cells.reserve(picture.pixels.size());
  for (int row = picture.height_px - 1; row >= 0; --row) {
    for (int x = 0; x < picture.width_px; ++x) {
      const auto pixel = static_cast<unsigned char>(
          picture.pixels[static_cast<std::size_t>(row) * picture.width_px + x]);
      const double bright = static_cast<double>(pixel) / picture.max_value;
      const double occupancy = negate != 0.0 ? bright : 1.0 - bright;
      map.cells.push_back(occupancy > occupied_above ? Cell::kOccupied
                          : occupancy < free_below   ? Cell::kFree
                                                     : Cell::kUnknown);
    }
  }
  return map;
}

}  // namespace

MapImage read_map(const fs::path& yaml_file) {
  return image_of(MapYaml{yaml_file}, yaml_file.parent_path());
}

MapWithOrigin read_map_with_origin(const fs::path& yaml_file) {
  const MapYaml yaml{yaml_file};
  return {image_of(yaml, yaml_file.parent_path()), yaml.origin()};
}

}  // namespace waymark::evaluate
