// SPDX-License-Identifier: BSD-3-Clause
#include "common/log/log_file.hpp"

#include "common/bytes/big_endian.hpp"
#include "common/errors/setup_error.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <set>
#include <stdexcept>
#include <system_error>

namespace waymark {
namespace {

constexpr std::uint32_t kSyncWord = 0xEDA1DA01U;
constexpr std::int64_t kHeaderBytes = 28;
constexpr std::int64_t kMaxChannelBytes = 999;                  // limit of liblcm's reader
constexpr std::int64_t kMaxDataBytes = std::int64_t{64} << 20;  // raw images of other robots fit
constexpr std::size_t kBufferBytes = std::size_t{1} << 20;
constexpr std::size_t kReadBufferBytes = std::size_t{32} << 10;  // small: images are often skipped
constexpr std::size_t kFirstSearchBytes = 256;

template <class Unsigned>
void append_big_endian(std::string& bytes, Unsigned value) {
  for (int shift = 8 * (static_cast<int>(sizeof(Unsigned)) - 1); shift >= 0; shift -= 8) {
    bytes += static_cast<char>(value >> shift);
  }
}

std::string last_system_error() {
  return std::generic_category().message(errno);
}

/// @param path  a file, or a folder, whose directory entries are flushed.
void flush_to_disk(const std::filesystem::path& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool is_flushed = descriptor >= 0 && ::fsync(descriptor) == 0;
  const std::string why = is_flushed ? "" : last_system_error();
  if (descriptor >= 0) ::close(descriptor);
  if (!is_flushed) throw std::runtime_error{path.string() + ": cannot be flushed: " + why};
}

}  // namespace

struct LogReader::Header {
  std::int64_t time_us;
  std::int64_t channel_bytes;
  std::int64_t data_bytes;
};

LogReader::LogReader(const std::filesystem::path& path) : path_{path}, buffer_(kReadBufferBytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error) && !error) {
    throw std::runtime_error{path.string() + ": is a folder or a device, not an LCM log"};
  }
  file_.rdbuf()->pubsetbuf(buffer_.data(), std::ssize(buffer_));
  file_.open(path, std::ios::binary);
  if (!file_) throw std::runtime_error{path.string() + ": cannot be read: " + last_system_error()};
  size_bytes_ = static_cast<std::int64_t>(std::filesystem::file_size(path));
}

std::optional<Message> LogReader::next() {
  return next([](std::string_view) { return true; });
}

std::optional<Message> LogReader::next(const std::function<bool(std::string_view)>& wanted) {
  while (offset_ < size_bytes_) {
    Header header{};
    if (!read_header(offset_, header)) {
      skip_to(find_event(offset_ + 1).value_or(size_bytes_));
      continue;
    }
    Message event{std::string(static_cast<std::size_t>(header.channel_bytes), '\0'),
                  timestamp_from_us(header.time_us),
                  {}};
    read(event.channel.data(), header.channel_bytes);
    const bool is_wanted = wanted(event.channel);
    if (is_wanted) {
      event.payload.resize(static_cast<std::size_t>(header.data_bytes));
      read(event.payload.data(), header.data_bytes);
    }
    if (!file_) throw std::runtime_error{path_.string() + ": read error"};
    offset_ += kHeaderBytes + header.channel_bytes + header.data_bytes;
    if (is_wanted) return event;
  }
  return std::nullopt;
}

/// True when a whole event starts at the offset; file_ then stands behind the event's header.
bool LogReader::read_header(std::int64_t offset, Header& header) {
  if (size_bytes_ - offset < kHeaderBytes) return false;
  std::array<char, kHeaderBytes> bytes{};
  seek(offset);
  read(bytes.data(), kHeaderBytes);
  if (read_big_endian<std::uint32_t>(bytes.data()) != kSyncWord) return false;
  header.time_us = read_big_endian<std::int64_t>(&bytes[12]);
  header.channel_bytes = read_big_endian<std::int32_t>(&bytes[20]);
  header.data_bytes = read_big_endian<std::int32_t>(&bytes[24]);
  return header.channel_bytes >= 1 && header.channel_bytes <= kMaxChannelBytes &&
         header.data_bytes >= 0 && header.data_bytes <= kMaxDataBytes &&
         header.channel_bytes + header.data_bytes <= size_bytes_ - offset - kHeaderBytes;
}

/// Offset of the next complete event at or after `offset`. O(bytes skipped), also in a log with a
/// byte of garbage after every event, since each search starts with a small window.
std::optional<std::int64_t> LogReader::find_event(std::int64_t offset) {
  const std::array<char, 4> sync{'\xED', '\xA1', '\xDA', '\x01'};
  std::vector<char> window(kFirstSearchBytes);
  while (size_bytes_ - offset >= kHeaderBytes) {
    seek(offset);
    const std::int64_t wanted_bytes = std::min(std::ssize(window), size_bytes_ - offset);
    read(window.data(), wanted_bytes);
    const auto end = window.begin() + wanted_bytes;
    for (auto at = window.begin();; ++at) {
      at = std::search(at, end, sync.begin(), sync.end());
      if (at == end) break;
      Header header{};
      const std::int64_t candidate = offset + (at - window.begin());
      if (read_header(candidate, header)) return candidate;
    }
    offset += std::max<std::int64_t>(1, wanted_bytes - 3);
    window.resize(std::min(2 * window.size(), kBufferBytes));
  }
  return std::nullopt;
}

void LogReader::skip_to(std::int64_t offset) {
  if (skipped_bytes_ == 0) first_skipped_offset_ = offset_;
  skipped_bytes_ += offset - offset_;
  offset_ = offset;
}

void LogReader::seek(std::int64_t offset) {
  if (offset != position_) file_.seekg(offset);
  position_ = offset;
}

void LogReader::read(void* bytes, std::int64_t size) {
  file_.read(static_cast<char*>(bytes), size);
  position_ += size;
}

std::vector<std::string> channels_in(const std::filesystem::path& path) {
  LogReader reader{path};
  std::set<std::string> channels;
  reader.next([&channels](std::string_view channel) {
    channels.emplace(channel);
    return false;
  });
  return {channels.begin(), channels.end()};
}

std::filesystem::path part_path_of(const std::filesystem::path& path) {
  return path.string() + ".part";
}

bool would_overwrite(const std::filesystem::path& out, const std::filesystem::path& file) {
  std::error_code none;  // equivalent() is false for files that do not exist
  return std::filesystem::equivalent(out, file, none) ||
         std::filesystem::equivalent(part_path_of(out), file, none);
}

void protect_inputs(std::string_view option, const std::filesystem::path& out,
                    const std::vector<std::filesystem::path>& inputs) {
  for (const std::filesystem::path& input : inputs) {
    if (!would_overwrite(out, input)) continue;
    throw SetupError{std::string{option} + ": " + out.string() + " would overwrite " +
                     input.string() + ", which is to be read: give another name"};
  }
}

LogWriter::LogWriter(const std::filesystem::path& path)
    : path_{path}, part_path_{part_path_of(path)}, buffer_(kBufferBytes) {
  std::error_code unknown;
  if (std::filesystem::exists(path, unknown) && !std::filesystem::is_regular_file(path, unknown)) {
    throw std::runtime_error{path.string() +
                             ": is a folder or a device; give the name of a file for the log"};
  }
  file_.rdbuf()->pubsetbuf(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  file_.open(part_path_, std::ios::binary | std::ios::trunc);
  if (!file_) {
    throw std::runtime_error{part_path_.string() + ": cannot be created: " + last_system_error()};
  }
}

LogWriter::~LogWriter() {
  if (!file_.is_open() || next_event_number_ > 0) return;
  file_.close();
  std::error_code ignored;
  std::filesystem::remove(part_path_, ignored);
}

void LogWriter::write(const Message& message) {
  std::string header;
  header.reserve(static_cast<std::size_t>(kHeaderBytes) + message.channel.size());
  append_big_endian(header, kSyncWord);
  append_big_endian(header, static_cast<std::uint64_t>(next_event_number_++));
  append_big_endian(header, static_cast<std::uint64_t>(to_us(message.time)));
  append_big_endian(header, static_cast<std::uint32_t>(message.channel.size()));
  append_big_endian(header, static_cast<std::uint32_t>(message.payload.size()));
  header += message.channel;
  file_.write(header.data(), static_cast<std::streamsize>(header.size()));
  file_.write(reinterpret_cast<const char*>(message.payload.data()),
              static_cast<std::streamsize>(message.payload.size()));
  if (!file_) throw std::runtime_error{part_path_.string() + ": cannot be written (disk full?)"};
}

void LogWriter::finish_part() {
  file_.close();
  if (!file_) throw std::runtime_error{part_path_.string() + ": cannot be written (disk full?)"};
}

void LogWriter::close() {
  finish_part();
  std::filesystem::rename(part_path_, path_);
}

void LogWriter::close_on_disk() {
  finish_part();
  flush_to_disk(part_path_);
  std::filesystem::rename(part_path_, path_);
  flush_to_disk(path_.has_parent_path() ? path_.parent_path() : ".");
}

}  // namespace waymark
