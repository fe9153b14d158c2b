// SPDX-License-Identifier: BSD-3-Clause
#include "slam/survey_file.hpp"

#include "common/errors/setup_error.hpp"
#include "common/files/whole_file.hpp"
#include "common/markers/marker_dictionary.hpp"
#include "common/messages/bounds.hpp"
#include "slam/sigma_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <sstream>
#include <system_error>

namespace waymark {
namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> fields;
  std::string field;
  std::istringstream stream{line};
  while (std::getline(stream, field, ',')) {
    const auto begin = field.find_first_not_of(" \t\r");
    const auto end = field.find_last_not_of(" \t\r");
    fields.push_back(begin == std::string::npos ? "" : field.substr(begin, end - begin + 1));
  }
  return fields;
}

/// One file, line by line.
class SurveyReader {
 public:
  SurveyReader(const std::filesystem::path& file, int num_ids) : file_{file}, num_ids_{num_ids} {}

  void take_line(const std::string& line) {
    ++line_;
    if (line.find_first_not_of(" \t\r") == std::string::npos || line.front() == '#') return;
    const std::vector<std::string> fields = split(line);
    if (columns_.empty()) return take_header(fields);
    markers_.push_back(marker_of(fields));
  }

  std::vector<SurveyedMarker> finish() {
    if (columns_.empty()) fail("has no line with the names of its columns");
    const bool has_yaw = std::any_of(markers_.begin(), markers_.end(),
                                     [](const SurveyedMarker& marker) { return marker.has_yaw; });
    if (markers_.size() < 2 && !has_yaw)
      fail("defines no frame: that takes two markers, or one with yaw_rad");
    return std::move(markers_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw SetupError{fmt::format("survey '{}', line {}: {}", file_.string(), line_, what)};
  }

  void take_header(const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i)
      columns_[names[i]] = i;
    for (const char* needed : {"id", "x_m", "y_m", "sigma_x_m", "sigma_y_m"})
      if (!columns_.contains(needed)) fail(fmt::format("there is no column {}", needed));
    if (columns_.contains("yaw_rad") != columns_.contains("sigma_yaw_rad"))
      fail("yaw_rad and sigma_yaw_rad go together");
  }

  /// None if there is no such column, or its field is empty.
  std::optional<double> number(const std::vector<std::string>& fields,
                               const std::string& column) const {
    const auto at = columns_.find(column);
    if (at == columns_.end() || at->second >= fields.size() || fields[at->second].empty())
      return std::nullopt;
    const std::string& text = fields[at->second];
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
      fail(fmt::format("{} is '{}', which is not a number", column, text));
    return value;
  }

  double needed(const std::vector<std::string>& fields, const std::string& column) const {
    const auto value = number(fields, column);
    if (!value) fail(fmt::format("there is no {}", column));
    return *value;
  }

  double needed_coordinate(const std::vector<std::string>& fields,
                           const std::string& column) const {
    const double value_m = needed(fields, column);
    if (std::abs(value_m) > bounds::kMapCoordinate_m)
      fail(
          fmt::format("{} is {}, but poses are precise to a millimetre only up to {} m from the "
                      "origin; subtract a constant from all {}",
                      column, value_m, bounds::kMapCoordinate_m, column));
    return value_m;
  }

  double needed_sigma(const std::vector<std::string>& fields, const std::string& column) const {
    const double value = needed(fields, column);
    if (value < kSigmaRange.low || value > kSigmaRange.high)
      fail(fmt::format("{} is {}, but must be from {} to {}", column, value, kSigmaRange.low,
                       kSigmaRange.high));
    return value;
  }

  SurveyedMarker marker_of(const std::vector<std::string>& fields) {
    SurveyedMarker marker;
    const double id = needed(fields, "id");
    if (id != std::floor(id) || id < 0.0 || id >= num_ids_)
      fail(fmt::format("id is {}, but the dictionary has 0 to {}", id, num_ids_ - 1));
    marker.id = static_cast<int>(id);
    if (!ids_.insert(marker.id).second) fail(fmt::format("id {} comes twice", marker.id));
    const auto yaw_rad = number(fields, "yaw_rad");
    marker.has_yaw = yaw_rad.has_value();
    marker.survey_from_marker = {needed_coordinate(fields, "x_m"), needed_coordinate(fields, "y_m"),
                                 yaw_rad.value_or(0.0)};
    marker.sigmas.x() = needed_sigma(fields, "sigma_x_m");
    marker.sigmas.y() = needed_sigma(fields, "sigma_y_m");
    if (marker.has_yaw) marker.sigmas.z() = needed_sigma(fields, "sigma_yaw_rad");
    return marker;
  }

  std::filesystem::path file_;
  int num_ids_;
  int line_{0};
  std::map<std::string, std::size_t> columns_{};
  std::set<int> ids_{};
  std::vector<SurveyedMarker> markers_{};
};

}  // namespace

std::vector<SurveyedMarker> read_survey(const std::filesystem::path& file,
                                        const std::string& dictionary) {
  const auto known = find_dictionary(dictionary);
  if (!known)
    throw SetupError{fmt::format("robot.markers.dictionary: there is no '{}'", dictionary)};
  SurveyReader reader{file, size_of(*known)};
  std::string text;
  try {
    text = read_whole_file(file);
  } catch (const std::system_error& error) {
    throw SetupError{fmt::format("robot.markers.survey_file: {}", error.what())};
  }
  std::istringstream stream{text};
  for (std::string line; std::getline(stream, line);)
    reader.take_line(line);
  return reader.finish();
}

}  // namespace waymark
