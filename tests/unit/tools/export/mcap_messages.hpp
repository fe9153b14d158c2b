// SPDX-License-Identifier: BSD-3-Clause
// Reads back the messages of an MCAP file that McapWriter has written (uncompressed chunks).
#pragma once

#include "common/time/time.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace waymark::exporting {

struct McapMessage {
  Timestamp time{};
  nlohmann::json content{};
};

/// The messages of each topic, in the order of the file.
class McapMessages {
 public:
  explicit McapMessages(const std::filesystem::path& file) {
    std::ifstream input{file, std::ios::binary};
    const std::string bytes{std::istreambuf_iterator<char>{input}, {}};
    constexpr std::size_t kMagicBytes = 8;
    read_records(std::string_view{bytes}.substr(kMagicBytes, bytes.size() - 2 * kMagicBytes));
  }

  const std::vector<McapMessage>& on(const std::string& topic) { return by_topic_[topic]; }

 private:
  static std::uint64_t number(std::string_view bytes, std::size_t at, std::size_t size) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i)
      value |= std::uint64_t{static_cast<unsigned char>(bytes[at + i])} << (8 * i);
    return value;
  }

  void read_records(std::string_view bytes) {
    constexpr std::size_t kHeadBytes = 9;  // opcode and length
    while (bytes.size() > kHeadBytes) {
      const std::size_t length = number(bytes, 1, 8);
      read_record(bytes[0], bytes.substr(kHeadBytes, length));
      bytes.remove_prefix(kHeadBytes + length);
    }
  }

  void read_record(char opcode, std::string_view content) {
    constexpr char kChannel = 4, kMessage = 5, kChunk = 6;
    if (opcode == kChannel)
      topics_[number(content, 0, 2)] = content.substr(8, number(content, 4, 4));
    if (opcode == kMessage) {
      by_topic_[topics_.at(number(content, 0, 2))].push_back(
          {Timestamp{Duration{static_cast<std::int64_t>(number(content, 6, 8) / 1000)}},
           nlohmann::json::parse(content.substr(22))});
    }
    constexpr std::size_t kChunkHeadBytes = 40;  // times, size, checksum, no compression, length
    if (opcode == kChunk) read_records(content.substr(kChunkHeadBytes));
  }

  std::map<std::uint64_t, std::string> topics_{};
  std::map<std::string, std::vector<McapMessage>> by_topic_{};
};

}  // namespace waymark::exporting
