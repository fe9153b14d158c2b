// SPDX-License-Identifier: BSD-3-Clause
#include "export/mcap_writer.hpp"

#include "common/log/log_file.hpp"

#include <zlib.h>

#include <algorithm>
#include <stdexcept>
#include <system_error>

namespace waymark::exporting {
namespace {

constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

// Opcodes of records (https://mcap.dev/spec#records).
enum class Op : unsigned char {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

/// Content of a record, little-endian.
class Fields {
 public:
  template <class Unsigned>
  Fields& number(Unsigned value) {
    for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
      bytes_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8 * i));
    return *this;
  }

  /// Appends a text, preceded by its length: 32 bit for texts and arrays, 64 bit for the records of
  /// a chunk.
  template <class Length = std::uint32_t>
  Fields& text(std::string_view value) {
    number(static_cast<Length>(value.size()));
    bytes_ += value;
    return *this;
  }

  const std::string& bytes() const { return bytes_; }

  std::string record(Op op) const {
    Fields head;
    head.number(static_cast<std::uint8_t>(op)).number(static_cast<std::uint64_t>(bytes_.size()));
    return head.bytes_ + bytes_;
  }

 private:
  std::string bytes_{};
};

std::uint32_t crc_of(std::uint32_t crc, std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()),
                                            static_cast<z_size_t>(bytes.size())));
}

std::uint64_t nanoseconds(Timestamp time) {
  return static_cast<std::uint64_t>(to_us(time)) * 1000U;
}

std::string joined(const std::vector<std::string>& records) {
  std::string bytes;
  for (const std::string& record : records)
    bytes += record;
  return bytes;
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& path)
    : path_{path}, part_path_{part_path_of(path)} {
  if (std::filesystem::exists(path) && !std::filesystem::is_regular_file(path)) {
    throw std::runtime_error{path.string() + ": is a folder or a device; give the name of a file"};
  }
  file_.open(part_path_, std::ios::binary | std::ios::trunc);
  if (!file_) throw std::runtime_error{part_path_.string() + ": cannot be created"};
  put(kMagic);
  put(Fields{}.text("").text("waymark-export").record(Op::kHeader));
}

McapWriter::~McapWriter() {
  if (!file_.is_open()) return;
  file_.close();
  std::error_code ignored;
  std::filesystem::remove(part_path_, ignored);
}

void McapWriter::put(std::string_view bytes) {
  file_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file_) throw std::runtime_error{part_path_.string() + ": cannot be written (disk full?)"};
  data_crc_ = crc_of(data_crc_, bytes);
  offset_ += bytes.size();
}

McapWriter::ChannelId McapWriter::add_channel(const std::string& topic,
                                              const std::string& schema_name,
                                              const std::string& schema_json) {
  std::uint16_t& schema_id = schema_ids_[schema_name];
  if (schema_id == 0) {  // new; ids begin at 1, because 0 means "no schema" in MCAP
    schema_id = static_cast<std::uint16_t>(schemas_.size() + 1);
    schemas_.push_back(Fields{}
                           .number(schema_id)
                           .text(schema_name)
                           .text("jsonschema")
                           .text(schema_json)
                           .record(Op::kSchema));
    chunk_ += schemas_.back();
  }
  const auto channel_id = static_cast<ChannelId>(channels_.size() + 1);
  channels_.push_back(Fields{}
                          .number(channel_id)
                          .number(schema_id)
                          .text(topic)
                          .text("json")
                          .text("")  // no metadata
                          .record(Op::kChannel));
  chunk_ += channels_.back();
  return channel_id;
}

void McapWriter::write(ChannelId channel, Timestamp time, std::string_view json) {
  const std::uint64_t time_ns = nanoseconds(time);
  const bool is_first = chunk_entries_.empty();
  chunk_first_ns_ = is_first ? time_ns : std::min(chunk_first_ns_, time_ns);
  chunk_last_ns_ = is_first ? time_ns : std::max(chunk_last_ns_, time_ns);
  chunk_entries_[channel].push_back({time_ns, chunk_.size()});
  const auto sequence = static_cast<std::uint32_t>(counts_[channel]++);
  Fields message;
  message.number(channel).number(sequence).number(time_ns).number(time_ns);
  const std::string head = message.bytes();
  chunk_ += Fields{}
                .number(static_cast<std::uint8_t>(Op::kMessage))
                .number(static_cast<std::uint64_t>(head.size() + json.size()))
                .bytes();
  chunk_ += head;
  chunk_ += json;
  ++num_messages_;
  if (chunk_.size() >= kChunkBytes) flush_chunk();
}

void McapWriter::flush_chunk() {
  if (chunk_.empty()) return;
  Chunk chunk;
  chunk.first_ns = chunk_first_ns_;
  chunk.last_ns = chunk_last_ns_;
  chunk.start = offset_;
  chunk.content_bytes = chunk_.size();
  put(Fields{}
          .number(chunk.first_ns)
          .number(chunk.last_ns)
          .number(chunk.content_bytes)
          .number(crc_of(0, chunk_))
          .text("")  // not compressed
          .text<std::uint64_t>(chunk_)
          .record(Op::kChunk));
  chunk.bytes = offset_ - chunk.start;
  for (const auto& [channel, entries] : chunk_entries_) {
    chunk.index_offsets[channel] = offset_;
    Fields list;
    for (const Entry& entry : entries)
      list.number(entry.time_ns).number(entry.offset);
    put(Fields{}.number(channel).text(list.bytes()).record(Op::kMessageIndex));
  }
  chunk.index_bytes = offset_ - chunk.start - chunk.bytes;
  chunks_.push_back(std::move(chunk));
  chunk_.clear();
  chunk_entries_.clear();
  chunk_first_ns_ = chunk_last_ns_ = 0;
}

std::string McapWriter::statistics() const {
  Fields counts;
  for (const auto& [channel, count] : counts_)
    counts.number(channel).number(count);
  std::uint64_t first_ns = 0;
  std::uint64_t last_ns = 0;
  bool is_first = true;
  for (const Chunk& chunk : chunks_) {
    if (chunk.index_offsets.empty()) continue;  // a chunk with channels but no messages
    first_ns = is_first ? chunk.first_ns : std::min(first_ns, chunk.first_ns);
    last_ns = std::max(last_ns, chunk.last_ns);
    is_first = false;
  }
  return Fields{}
      .number(num_messages_)
      .number(static_cast<std::uint16_t>(schemas_.size()))
      .number(static_cast<std::uint32_t>(channels_.size()))
      .number(std::uint32_t{0})  // attachments
      .number(std::uint32_t{0})  // metadata
      .number(static_cast<std::uint32_t>(chunks_.size()))
      .number(first_ns)
      .number(last_ns)
      .text(counts.bytes())
      .record(Op::kStatistics);
}

std::string McapWriter::summary() const {
  std::vector<std::string> chunk_indices;
  for (const Chunk& chunk : chunks_) {
    Fields offsets;
    for (const auto& [channel, offset] : chunk.index_offsets)
      offsets.number(channel).number(offset);
    chunk_indices.push_back(Fields{}
                                .number(chunk.first_ns)
                                .number(chunk.last_ns)
                                .number(chunk.start)
                                .number(chunk.bytes)
                                .text(offsets.bytes())
                                .number(chunk.index_bytes)
                                .text("")
                                .number(chunk.content_bytes)
                                .number(chunk.content_bytes)
                                .record(Op::kChunkIndex));
  }
  const std::pair<Op, std::string> groups[] = {{Op::kSchema, joined(schemas_)},
                                               {Op::kChannel, joined(channels_)},
                                               {Op::kStatistics, statistics()},
                                               {Op::kChunkIndex, joined(chunk_indices)}};
  std::string section;
  std::string offsets;
  for (const auto& [op, records] : groups) {
    if (records.empty()) continue;
    offsets += Fields{}
                   .number(static_cast<std::uint8_t>(op))
                   .number(offset_ + section.size())
                   .number(static_cast<std::uint64_t>(records.size()))
                   .record(Op::kSummaryOffset);
    section += records;
  }
  const std::uint64_t offsets_start = offset_ + section.size();
  section += offsets;
  // The checksum covers the footer up to itself.
  section += Fields{}
                 .number(static_cast<std::uint8_t>(Op::kFooter))
                 .number(std::uint64_t{20})
                 .number(offset_)
                 .number(offsets_start)
                 .bytes();
  section += Fields{}.number(crc_of(0, section)).bytes();
  return section;
}

void McapWriter::close() {
  flush_chunk();
  put(Fields{}.number(data_crc_).record(Op::kDataEnd));
  put(summary());
  put(kMagic);
  file_.close();
  if (!file_) throw std::runtime_error{part_path_.string() + ": cannot be written (disk full?)"};
  std::filesystem::rename(part_path_, path_);
}

}  // namespace waymark::exporting
