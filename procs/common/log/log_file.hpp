// SPDX-License-Identifier: BSD-3-Clause
// LCM event logs, as lcm-logger writes and lcm-logplayer reads them. liblcm is not used: its reader
// crashes on hostile lengths and discards intact events in front of garbage. Format: big-endian
// {u32 0xEDA1DA01, i64 event number, i64 time us, i32 channel length, i32 data length}, channel
// without terminating zero, data.
#pragma once

#include "common/messages/message.hpp"

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// Reads events in file order; skips and counts bytes that belong to no complete event.
class LogReader {
 public:
  /// @throws std::runtime_error saying why the file cannot be opened.
  explicit LogReader(const std::filesystem::path& path);

  /// Next event on a channel that `wanted` accepts (others are skipped without being read); nullopt
  /// at the end. The message's time is the event's time.
  std::optional<Message> next(const std::function<bool(std::string_view)>& wanted);
  std::optional<Message> next();

  /// Bytes so far that are not part of a complete event: garbage, or an event cut off by the end of
  /// the file.
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
  std::int64_t position_{0};  ///< of file_; tellg() would cost a system call
  std::int64_t size_bytes_{0};
  std::int64_t offset_{0};
  std::int64_t skipped_bytes_{0};
  std::int64_t first_skipped_offset_{0};
};

/// Channels that occur in a log.
std::vector<std::string> channels_in(const std::filesystem::path& path);

/// Where a LogWriter on `path` writes until it is closed.
std::filesystem::path part_path_of(const std::filesystem::path& path);

/// True when a LogWriter on `out` would overwrite `file`, also when the paths are spelled
/// differently.
bool would_overwrite(const std::filesystem::path& out, const std::filesystem::path& file);

/// @param option  the command-line option that gave `out`, for the error message.
/// @throws SetupError when writing `out` would overwrite one of the input files.
void protect_inputs(std::string_view option, const std::filesystem::path& out,
                    const std::vector<std::filesystem::path>& inputs);

/// Writes events to part_path_of(path) and renames it when closed, so that a log under its final
/// name is complete.
class LogWriter {
 public:
  /// @throws std::runtime_error when the file cannot be created, or `path` exists and is not a
  /// regular file.
  explicit LogWriter(const std::filesystem::path& path);
  /// Without close(), events stay in part_path_of(path); an empty part is removed.
  ~LogWriter();
  LogWriter(const LogWriter&) = delete;
  LogWriter& operator=(const LogWriter&) = delete;

  /// Appends an event with the time of the message.
  /// @throws std::runtime_error naming the file when it cannot be written, e.g. on a full disk.
  void write(const Message& message);
  /// Completes the part and renames it to the final name.
  /// @throws std::runtime_error when not everything could be written, or the rename failed.
  void close();
  /// Like close(), and safe against power failure: the final name refers to the old file or to the
  /// complete new one. Flushes file and folder to the disk; this may take a second.
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
