// SPDX-License-Identifier: BSD-3-Clause
// rosbag2's SQLite files.
#include "common/errors/setup_error.hpp"
#include "import/rosbag/bag.hpp"
#include "import/rosbag/decompress.hpp"

#include <fmt/format.h>
#include <sqlite3.h>

#include <map>
#include <memory>

namespace waymark {
namespace {

using Database = std::unique_ptr<sqlite3, decltype(&sqlite3_close)>;
using Statement = std::unique_ptr<sqlite3_stmt, decltype(&sqlite3_finalize)>;

struct Topic {
  std::string name{};
  std::string type{};
  bool is_cdr{false};
};

/// @throws SetupError when messages are still in the write-ahead log of a recorder that was killed:
/// SQLite cannot read it without writing beside the file.
void check_is_checkpointed(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::path log{file.string() + "-wal"};
  const auto size = std::filesystem::file_size(log, error);
  if (error || size == 0) return;
  throw SetupError{fmt::format(
      "{}: holds messages that are not in the bag yet, for its recorder was interrupted; move them "
      "into it (sqlite3 {} 'PRAGMA wal_checkpoint(TRUNCATE)'), perhaps in a copy of both files",
      log.string(), file.string())};
}

/// Opens the file read-only, without a lock or a journal beside it.
Database open_database(const std::filesystem::path& file) {
  check_is_checkpointed(file);
  std::string name;
  for (const char c : std::filesystem::absolute(file).string()) {
    const bool is_special = c == '%' || c == '?' || c == '#';
    name += is_special ? fmt::format("%{:02X}", static_cast<unsigned char>(c)) : std::string{c};
  }
  sqlite3* raw = nullptr;
  const int result = sqlite3_open_v2(("file:" + name + "?immutable=1").c_str(), &raw,
                                     SQLITE_OPEN_READONLY | SQLITE_OPEN_URI, nullptr);
  Database database{raw, &sqlite3_close};
  if (result != SQLITE_OK) throw SetupError{file.string() + ": cannot be opened as a .db3 bag"};
  return database;
}

Statement prepare(const Database& database, const char* query, const std::filesystem::path& file) {
  sqlite3_stmt* raw = nullptr;
  const int result = sqlite3_prepare_v2(database.get(), query, -1, &raw, nullptr);
  Statement statement{raw, &sqlite3_finalize};
  if (result != SQLITE_OK) {
    throw SetupError{fmt::format("{}: is no bag of rosbag2, or damaged: {}", file.string(),
                                 sqlite3_errmsg(database.get()))};
  }
  return statement;
}

std::string text_at(const Statement& statement, int column) {
  const auto* text = sqlite3_column_text(statement.get(), column);
  return text == nullptr ? std::string{} : ros_name(reinterpret_cast<const char*>(text));
}

ByteView blob_at(const Statement& statement, int column) {
  const auto* bytes =
      static_cast<const std::uint8_t*>(sqlite3_column_blob(statement.get(), column));
  const int size = sqlite3_column_bytes(statement.get(), column);
  return bytes == nullptr ? ByteView{} : ByteView{bytes, static_cast<std::size_t>(size)};
}

std::map<std::int64_t, Topic> read_topics(const Database& database,
                                          const std::filesystem::path& file, ImportReport& report) {
  std::map<std::int64_t, Topic> topics;
  const Statement rows =
      prepare(database, "SELECT id, name, type, serialization_format FROM topics", file);
  int result = SQLITE_ROW;
  while ((result = sqlite3_step(rows.get())) == SQLITE_ROW) {
    const std::string format = text_at(rows, 3);
    const Topic topic{text_at(rows, 1), ros_type_name(text_at(rows, 2)), format == "cdr"};
    topics[sqlite3_column_int64(rows.get(), 0)] = topic;
    if (!topic.is_cdr)
      report.note(
          fmt::format("{} is left out: its messages are '{}', not 'cdr'", topic.name, format));
  }
  if (result != SQLITE_DONE) report.skip("damaged database", 0, sqlite3_errmsg(database.get()));
  return topics;
}

}  // namespace

void read_db3_bag(const std::filesystem::path& file, const HandleRecord& handle,
                  ImportReport& report) {
  report.set_address_unit(AddressUnit::kRow);
  const Database database = open_database(file);
  const std::map<std::int64_t, Topic> topics = read_topics(database, file, report);
  const Statement rows =
      prepare(database, "SELECT id, topic_id, timestamp, data FROM messages ORDER BY id", file);
  int result = SQLITE_ROW;
  std::int64_t row = 0;
  while ((result = sqlite3_step(rows.get())) == SQLITE_ROW) {
    row = sqlite3_column_int64(rows.get(), 0);
    const auto topic = topics.find(sqlite3_column_int64(rows.get(), 1));
    const auto recorded = time_from_ns(sqlite3_column_int64(rows.get(), 2));
    if (topic == topics.end() || !recorded) {
      report.skip("bad row", row, topic == topics.end() ? "of no topic" : "of no time");
      continue;
    }
    if (!topic->second.is_cdr) continue;
    const auto hand_out = [&](ByteView data) {
      handle({topic->second.name, topic->second.type, RosEncoding::kCdr, *recorded, row, data});
    };
    const ByteView data = blob_at(rows, 3);
    if (!is_zstd_frame(data)) {
      hand_out(data);
    } else if (const auto unpacked = decompress_zstd_frame(data)) {
      hand_out(*unpacked);
    } else {
      report.skip("damaged message", row, topic->second.name);
    }
  }
  if (result != SQLITE_DONE) report.skip("damaged database", row, sqlite3_errmsg(database.get()));
}

}  // namespace waymark
