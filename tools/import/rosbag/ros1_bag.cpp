// SPDX-License-Identifier: BSD-3-Clause
// ROS 1 bags, version 2.0 (http://wiki.ros.org/Bags/Format/2.0): records of a header with fields
// NAME=VALUE and data. Messages and connections are in chunks.
#include "import/rosbag/bag.hpp"
#include "import/rosbag/decompress.hpp"
#include "import/rosbag/mapped_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string_view>

namespace waymark {
namespace {

constexpr std::size_t kMagicBytes = 13;  // "#ROSBAG V2.0\n"

enum Op : std::uint8_t {
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndex = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

using RecordFields = std::map<std::string, ByteView, std::less<>>;

struct Record {
  std::uint8_t op{0};
  RecordFields fields{};
  ByteView data{};
};

std::optional<RecordFields> read_fields(ByteView header) {
  RecordFields fields;
  ByteCursor cursor{header};
  while (!cursor.at_end()) {
    const std::string_view field = cursor.text();
    const std::size_t equals = field.find('=');
    if (!cursor.good() || equals == std::string_view::npos) return std::nullopt;
    const ByteView bytes{reinterpret_cast<const std::uint8_t*>(field.data()), field.size()};
    fields.emplace(field.substr(0, equals), bytes.subspan(equals + 1));
  }
  return fields;
}

/// Nothing if no record starts at the cursor, whose position is then undefined.
std::optional<Record> read_record(ByteCursor& cursor) {
  const ByteView header = cursor.block();
  const ByteView data = cursor.block();
  if (!cursor.good()) return std::nullopt;
  auto fields = read_fields(header);
  if (!fields) return std::nullopt;
  const auto op = fields->find("op");
  if (op == fields->end() || op->second.size() != 1) return std::nullopt;
  const std::uint8_t code = op->second[0];
  if (code < kMessage || code > kConnection) return std::nullopt;
  return Record{code, std::move(*fields), data};
}

template <class Number>
std::optional<Number> number_in(const RecordFields& fields, std::string_view name) {
  const auto found = fields.find(name);
  if (found == fields.end() || found->second.size() != sizeof(Number)) return std::nullopt;
  return ByteCursor{found->second}.number<Number>();
}

std::string text_in(const RecordFields& fields, std::string_view name) {
  const auto found = fields.find(name);
  if (found == fields.end()) return {};
  return ros_name({reinterpret_cast<const char*>(found->second.data()), found->second.size()});
}

/// Offset of the next chunk; the end if there is none. A chunk's header begins with the field
/// `compression`, after the two lengths.
std::size_t next_chunk(ByteView bag, std::size_t from) {
  constexpr std::string_view kField = "compression=";
  const auto matches = [](std::uint8_t byte, char c) {
    return byte == static_cast<std::uint8_t>(c);
  };
  for (auto at = bag.begin() + static_cast<std::ptrdiff_t>(from);; ++at) {
    at = std::search(at, bag.end(), kField.begin(), kField.end(), matches);
    if (at == bag.end()) return bag.size();
    const auto offset = static_cast<std::size_t>(at - bag.begin());
    if (offset < from + 8) continue;
    ByteCursor cursor{bag.subspan(offset - 8)};
    const auto record = read_record(cursor);
    if (record && record->op == kChunk) return offset - 8;
  }
}

class Ros1Reader {
 public:
  Ros1Reader(const HandleRecord& handle, ImportReport& report) : handle_{handle}, report_{report} {}

  void read(ByteView bag) {
    std::size_t offset = kMagicBytes;
    while (offset < bag.size()) {
      ByteCursor cursor{bag.subspan(offset)};
      const auto record = read_record(cursor);
      if (!record) {
        const std::size_t next = next_chunk(bag, offset);
        report_.skip("no bag record", static_cast<std::int64_t>(offset),
                     fmt::format("{} bytes", next - offset));
        offset = next;
        continue;
      }
      handle_record(*record, static_cast<std::int64_t>(offset));
      offset += cursor.offset();
    }
  }

 private:
  struct Connection {
    std::string topic{};
    std::string type{};
  };

  void handle_record(const Record& record, std::int64_t at) {
    switch (record.op) {
      case kChunk:
        return handle_chunk(record, at);
      case kConnection:
        return handle_connection(record, at);
      case kMessage:
        return handle_message(record, at);
      default:
        return;  // index: not needed to read everything
    }
  }

  void handle_chunk(const Record& record, std::int64_t at) {
    const std::string compression = text_in(record.fields, "compression");
    const auto size = number_in<std::uint32_t>(record.fields, "size");
    if (compression == "none") return handle_records_of_chunk(record.data, at);
    if (!size || !is_known_compression(compression)) {
      return report_.skip("unknown compression", at, compression);
    }
    const auto unpacked = decompress(compression, record.data, *size);
    if (!unpacked) {
      return report_.skip("damaged chunk", at, fmt::format("{} bytes", record.data.size()));
    }
    handle_records_of_chunk(*unpacked, at);
  }

  void handle_records_of_chunk(ByteView chunk, std::int64_t at) {
    ByteCursor cursor{chunk};
    while (!cursor.at_end()) {
      const std::size_t start = cursor.offset();
      const auto record = read_record(cursor);
      if (!record) {
        return report_.skip("no bag record", at,
                            fmt::format("{} bytes of its chunk", chunk.size() - start));
      }
      handle_record(*record, at);
    }
  }

  void handle_connection(const Record& record, std::int64_t at) {
    const auto id = number_in<std::uint32_t>(record.fields, "conn");
    const auto description = read_fields(record.data);
    if (!id || !description) return report_.skip("bad connection", at, "");
    connections_[*id] = {text_in(record.fields, "topic"), text_in(*description, "type")};
  }

  void handle_message(const Record& record, std::int64_t at) {
    const auto id = number_in<std::uint32_t>(record.fields, "conn");
    const auto stamp = number_in<std::uint64_t>(record.fields, "time");
    const auto connection = id ? connections_.find(*id) : connections_.end();
    if (!stamp || connection == connections_.end()) {
      return report_.skip("message of no connection", at, "");
    }
    const auto sec = static_cast<std::int64_t>(*stamp & 0xffffffffU);
    const auto nsec = static_cast<std::int64_t>(*stamp >> 32U);
    const auto recorded = time_from_ns(sec * 1'000'000'000 + nsec);
    if (!recorded) return report_.skip("bad time", at, connection->second.topic);
    handle_({connection->second.topic, connection->second.type, RosEncoding::kRos1, *recorded, at,
             record.data});
  }

  const HandleRecord& handle_;
  ImportReport& report_;
  std::map<std::uint32_t, Connection> connections_{};
};

}  // namespace

void read_ros1_bag(const std::filesystem::path& file, const HandleRecord& handle,
                   ImportReport& report) {
  const MappedFile bag{file};
  Ros1Reader{handle, report}.read(bag.bytes());
}

}  // namespace waymark
