// SPDX-License-Identifier: BSD-3-Clause
// MCAP (https://mcap.dev/spec), with messages of ROS 1 or ROS 2.
#include "import/rosbag/bag.hpp"
#include "import/rosbag/decompress.hpp"
#include "import/rosbag/mapped_file.hpp"

#include <fmt/format.h>
#include <zlib.h>

#include <map>

namespace waymark {
namespace {

constexpr std::size_t kMagicBytes = 8;

enum Op : std::uint8_t {
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kDataEnd = 0x0F,
};

class McapReader {
 public:
  McapReader(const HandleRecord& handle, ImportReport& report) : handle_{handle}, report_{report} {}

  void read(ByteView file) {
    ByteCursor cursor{file};
    cursor.take(kMagicBytes);
    while (!cursor.at_end()) {
      const auto at = static_cast<std::int64_t>(cursor.offset());
      const auto op = cursor.number<std::uint8_t>();
      const ByteView content = cursor.block<std::uint64_t>();
      if (!cursor.good()) {
        return report_.skip("no MCAP record", at,
                            fmt::format("{} bytes", file.size() - static_cast<std::size_t>(at)));
      }
      if (op == kDataEnd || op == kFooter) return;
      handle_record(op, content, at);
    }
    report_.skip("end of the data is missing", static_cast<std::int64_t>(file.size()),
                 "the file is cut off");
  }

 private:
  struct McapChannel {
    std::string topic{};
    std::string type{};
    RosEncoding encoding{RosEncoding::kCdr};
    bool is_ros{false};
  };

  void handle_record(std::uint8_t op, ByteView content, std::int64_t at) {
    switch (op) {
      case kSchema:
        return handle_schema(content, at);
      case kChannel:
        return handle_channel(content, at);
      case kMessage:
        return handle_message(content, at);
      case kChunk:
        return handle_chunk(content, at);
      default:
        return;  // index, attachment, metadata
    }
  }

  void handle_schema(ByteView content, std::int64_t at) {
    ByteCursor cursor{content};
    const auto id = cursor.number<std::uint16_t>();
    const std::string name = ros_name(cursor.text());
    if (!cursor.good()) return report_.skip("bad schema", at, "");
    types_[id] = ros_type_name(name);
  }

  void handle_channel(ByteView content, std::int64_t at) {
    ByteCursor cursor{content};
    const auto id = cursor.number<std::uint16_t>();
    const auto schema = cursor.number<std::uint16_t>();
    const std::string topic = ros_name(cursor.text());
    const std::string_view encoding = cursor.text();
    if (!cursor.good()) return report_.skip("bad channel", at, "");
    const auto type = types_.find(schema);
    channels_[id] = {topic, type == types_.end() ? "" : type->second,
                     encoding == "ros1" ? RosEncoding::kRos1 : RosEncoding::kCdr,
                     encoding == "ros1" || encoding == "cdr"};
  }

  void handle_message(ByteView content, std::int64_t at) {
    ByteCursor cursor{content};
    const auto id = cursor.number<std::uint16_t>();
    cursor.number<std::uint32_t>();  // sequence
    const auto log_ns = cursor.number<std::uint64_t>();
    cursor.number<std::uint64_t>();  // time of publishing
    const auto channel = channels_.find(id);
    if (!cursor.good() || channel == channels_.end()) {
      return report_.skip("message of no channel", at, "");
    }
    const McapChannel& of = channel->second;
    if (!of.is_ros) return;
    const auto recorded = time_from_ns(static_cast<std::int64_t>(log_ns));
    if (!recorded) return report_.skip("bad time", at, of.topic);
    handle_({of.topic, of.type, of.encoding, *recorded, at, cursor.take(cursor.left())});
  }

  void handle_chunk(ByteView content, std::int64_t at) {
    ByteCursor cursor{content};
    cursor.number<std::uint64_t>();  // first and last time
    cursor.number<std::uint64_t>();
    const auto size = cursor.number<std::uint64_t>();
    const auto crc = cursor.number<std::uint32_t>();
    const std::string compression = ros_name(cursor.text());
    const ByteView packed = cursor.block<std::uint64_t>();
    if (!cursor.good()) return report_.skip("damaged chunk", at, "shorter than its fields");
    if (compression.empty()) return handle_records_of_chunk(packed, crc, at);
    if (!is_known_compression(compression)) {
      return report_.skip("unknown compression", at, compression);
    }
    const auto unpacked = decompress(compression, packed, size);
    if (!unpacked) {
      return report_.skip("damaged chunk", at, fmt::format("{} bytes", packed.size()));
    }
    handle_records_of_chunk(*unpacked, crc, at);
  }

  void handle_records_of_chunk(ByteView records, std::uint32_t crc, std::int64_t at) {
    if (crc != 0 && crc != crc32_z(0, records.data(), records.size())) {
      return report_.skip("damaged chunk", at, "its checksum is another one");
    }
    ByteCursor cursor{records};
    while (!cursor.at_end()) {
      const auto op = cursor.number<std::uint8_t>();
      const ByteView content = cursor.block<std::uint64_t>();
      if (!cursor.good() || op == kChunk) return report_.skip("no MCAP record", at, "in its chunk");
      handle_record(op, content, at);
    }
  }

  const HandleRecord& handle_;
  ImportReport& report_;
  std::map<std::uint16_t, std::string> types_{};
  std::map<std::uint16_t, McapChannel> channels_{};
};

}  // namespace

void read_mcap_bag(const std::filesystem::path& file, const HandleRecord& handle,
                   ImportReport& report) {
  const MappedFile bag{file};
  McapReader{handle, report}.read(bag.bytes());
}

}  // namespace waymark
