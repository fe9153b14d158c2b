// SPDX-License-Identifier: BSD-3-Clause
#include "import/rosbag/bag.hpp"

#include "common/errors/setup_error.hpp"
#include "import/rosbag/decompress.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

namespace waymark {
namespace {

constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";
constexpr std::string_view kSqliteMagic = "SQLite format 3";
constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";
constexpr std::int64_t kLatest_ns = 4'102'444'800'000'000'000;  // the year 2100

std::string start_of(const std::filesystem::path& file) {
  std::ifstream stream{file, std::ios::binary};
  std::array<char, 16> head{};
  stream.read(head.data(), head.size());
  return {head.data(), static_cast<std::size_t>(stream.gcount())};
}

}  // namespace

bool is_bag(const std::filesystem::path& file) {
  const std::string start = start_of(file);
  return start.starts_with(kRos1Magic) || start.starts_with(kSqliteMagic) ||
         start.starts_with(kMcapMagic);
}

std::string ros_name(std::string_view bytes) {
  std::string name{bytes};
  std::ranges::replace_if(
      name, [](char c) { return c < ' ' || c > '~'; }, '?');
  return name;
}

std::string ros_type_name(std::string type) {
  const std::size_t at = type.find("/msg/");
  if (at != std::string::npos) type.erase(at, 4);
  return type;
}

std::optional<Timestamp> time_from_ns(std::int64_t ns) {
  if (ns < 0 || ns > kLatest_ns) return std::nullopt;
  return timestamp_from_us(ns / 1000);
}

void read_bag(const std::filesystem::path& file, const HandleRecord& handle, ImportReport& report) {
  if (std::filesystem::is_directory(file))
    throw SetupError{file.string() + ": is a folder; name the .db3 or .mcap file in it"};
  if (!std::filesystem::is_regular_file(file) || !std::ifstream{file})
    throw SetupError{file.string() + ": cannot be read as a bag"};
  const std::string start = start_of(file);
  if (start.starts_with(kRos1Magic)) return read_ros1_bag(file, handle, report);
  if (start.starts_with(kSqliteMagic)) return read_db3_bag(file, handle, report);
  if (start.starts_with(kMcapMagic)) return read_mcap_bag(file, handle, report);
  if (is_zstd_frame({reinterpret_cast<const std::uint8_t*>(start.data()), start.size()})) {
    throw SetupError{fmt::format("{}: is compressed by zstd; unpack it first (unzstd {} -o {})",
                                 file.string(), file.filename().string(), file.stem().string())};
  }
  throw SetupError{file.string() +
                   ": is no bag of ROS: neither .bag (version 2.0) nor .db3 nor .mcap"};
}

}  // namespace waymark
