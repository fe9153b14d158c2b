// SPDX-License-Identifier: BSD-3-Clause
// LCM event logs. Our own reader and writer of LCM's format, because liblcm's reader crashes on
// hostile lengths and throws good events away before garbage; lcm-logplayer and lcm-logger read and
// write the same. Format: big-endian {u32 0xEDA1DA01, i64 event number, i64 time us, i32 channel
// length, i32 data length}, channel without terminating zero, data.
#pragma once

#include "common/messages/message.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// Reads events in file order; skips and counts what is not an event.
class LogReader {
 public:
  /// @throws std::runtime_error saying why the file cannot be opened.
  explicit LogReader(const std::filesystem::path& path);

  /// Next event on a channel that `wanted` accepts (others are skipped without being read); nullopt
  /// at the end. The message's time is the event's time.
  std::optional<Message> next(const std::function<bool(std::string_view)>& wanted);
  std::optional<Message> next();

  /// Bytes that belonged to no whole event so far: garbage, or an event cut off by the end of the
  /// file.
  std::int64_t skipped_bytes() const { return skipped_bytes_; }

  /// Offset of the first skipped byte; meaningful when skipped_bytes() > 0.
  std::int64_t first_skipped_offset() const { return first_skipped_offset_; }

  std::int64_t size_bytes() const { return size_bytes_; }

  std::int64_t offset_bytes() const { return offset_; }

 private:
  struct Header;

  bool read_header(std::int64_t offset, Header& header);
  std::optional<std::int64_t> find_event(std::int64_t offset);
  void skip_to(std::int64_t offset);
  void seek(std::int64_t offset);
  void read(void* bytes, std::int64_t size);

  std::filesystem::path path_;
  std::vector<char> buffer_;
  std::ifstream file_;
  std::int64_t position_{0};  ///< of file_, which would ask the system for it
  std::int64_t size_bytes_{0};
  std::int64_t offset_{0};
  std::int64_t skipped_bytes_{0};
  std::int64_t first_skipped_offset_{0};
};

/// Channels that occur in a log.
std::vector<std::string> channels_in(const std::filesystem::path& path);

/// Where a LogWriter on `path` writes until it is closed.
std::filesystem::path part_path_of(const std::filesystem::path& path);

/// True when a LogWriter on `out` would destroy `file`, by whatever name either is given.
bool would_overwrite(const std::filesystem::path& out, const std::filesystem::path& file);

/// @param option  that named `out`, for the message.
/// @throws SetupError when writing `out` would destroy one of the files that are to be read.
void protect_inputs(std::string_view option, const std::filesystem::path& out,
                    const std::vector<std::filesystem::path>& inputs);

/// Writes events to part_path_of(path) and renames it when closed: a log that is there is whole.
class LogWriter {
 public:
  /// @throws std::runtime_error when the file cannot be created, or would take the place of
  /// something that is not a regular file.
  explicit LogWriter(const std::filesystem::path& path);
  /// Leaves what was written where it is, and nothing where nothing was.
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Log time = message time. @throws std::runtime_error naming the file when the disk is full.
  void write(const Message& message);
  /// @throws std::runtime_error when not everything reached the file.
  void close();
  /// The same, and after a power cut, too, the name stands for the old file or the whole new one:
  /// both are on the disk when this returns, which may take a second.
  void close_on_disk();

 private:
  void finish_part();

  std::filesystem::path path_;
  std::filesystem::path part_path_;
  std::vector<char> buffer_;
  std::ofstream file_;
  std::int64_t next_event_number_{0};
};

}  // namespace waymark
