// SPDX-License-Identifier: BSD-3-Clause
// What an import skipped and why, and what it assumed: nothing is dropped silently.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// Unit of a position in the imported file.
enum class AddressUnit { kLine, kByte, kRow };

/// What is wrong with a line or a message.
struct LineProblem {
  std::string_view kind{};  ///< problems are counted by kind
  std::string detail{};
};

class ImportReport {
 public:
  ImportReport(const std::filesystem::path& file, AddressUnit unit)
      : file_{file.filename().string()}, unit_{unit} {}

  void set_address_unit(AddressUnit unit) { unit_ = unit; }

  /// A line or event that is skipped. All are counted; the first of each kind get a message.
  /// @param at  line number (from 1), byte offset (from 0) or row of a table
  void skip(std::string_view kind, std::int64_t at, std::string_view detail);

  /// A decision of the import that the user should know of.
  void note(std::string text) { notes_.push_back(std::move(text)); }

  std::int64_t num_skipped() const;

  const std::map<std::string, std::int64_t, std::less<>>& skipped_by_kind() const {
    return skipped_by_kind_;
  }

  /// One line each for the first skipped records of a kind: "fr079.clf:17: skipped: ...".
  const std::vector<std::string>& messages() const { return messages_; }

  const std::vector<std::string>& notes() const { return notes_; }

 private:
  std::string file_;
  AddressUnit unit_;
  std::map<std::string, std::int64_t, std::less<>> skipped_by_kind_{};
  std::vector<std::string> messages_{};
  std::vector<std::string> notes_{};
};

}  // namespace waymark
