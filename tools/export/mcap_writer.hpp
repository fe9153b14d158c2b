// SPDX-License-Identifier: BSD-3-Clause
// Writer of MCAP files (https://mcap.dev/spec) with JSON messages: indexed chunks, summary,
// checksums.
#pragma once

#include "common/time/time.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace waymark::exporting {

/// Writes to part_path_of(path) and renames it when closed, so that a file under its final name is
/// complete.
class McapWriter {
 public:
  using ChannelId = std::uint16_t;

  /// @throws std::runtime_error when the file cannot be created.
  explicit McapWriter(const std::filesystem::path& path);
  /// Without close(), the partial file is removed.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// @param schema_json  JSON schema of the messages; written once per name.
  ChannelId add_channel(const std::string& topic, const std::string& schema_name,
                        const std::string& schema_json);

  /// @throws std::runtime_error naming the file when the disk is full.
  void write(ChannelId channel, Timestamp time, std::string_view json);

  /// @throws std::runtime_error when not everything reached the file.
  void close();

  std::uint64_t num_messages() const { return num_messages_; }

 private:
  /// Index entry of a message in a chunk.
  struct Entry {
    std::uint64_t time_ns;
    std::uint64_t offset;
  };

  struct Chunk {
    std::uint64_t first_ns{0};
    std::uint64_t last_ns{0};
    std::uint64_t start{0};
    std::uint64_t bytes{0};
    std::map<ChannelId, std::uint64_t> index_offsets{};
    std::uint64_t index_bytes{0};
    std::uint64_t content_bytes{0};
  };

  void put(std::string_view bytes);
  void flush_chunk();
  std::string statistics() const;
  /// Summary section and footer.
  std::string summary() const;

  std::filesystem::path path_;
  std::filesystem::path part_path_;
  std::ofstream file_;
  std::uint64_t offset_{0};
  std::uint32_t data_crc_{0};
  std::vector<std::string> schemas_{};   ///< records
  std::vector<std::string> channels_{};  ///< records
  std::map<std::string, std::uint16_t> schema_ids_{};
  std::string chunk_{};
  std::map<ChannelId, std::vector<Entry>> chunk_entries_{};
  std::uint64_t chunk_first_ns_{0};
  std::uint64_t chunk_last_ns_{0};
  std::vector<Chunk> chunks_{};
  std::map<ChannelId, std::uint64_t> counts_{};
  std::uint64_t num_messages_{0};
};

}  // namespace waymark::exporting
