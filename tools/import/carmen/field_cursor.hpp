// SPDX-License-Identifier: BSD-3-Clause
// Reads the fields of a line one after the other, and keeps the first error.
#pragma once

#include "import/log/import_report.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace waymark {

class FieldCursor {
 public:
  /// @param line  must outlive the cursor
  explicit FieldCursor(std::string_view line) : rest_{line} {}

  /// Next field. Empty after the last field (an error), and after an error.
  std::string_view word(std::string_view name);
  /// A finite number; 0 after an error.
  double number(std::string_view name);
  /// A number or infinity.
  double any_number(std::string_view name);
  int integer(std::string_view name, int low, int high);
  /// Number of fields that have not been read.
  std::size_t num_left() const;
  /// True if the line's last field is a number.
  bool ends_with_number() const;
  /// An error if there are further fields.
  void expect_end();

  void fail(std::string_view kind, std::string detail);

  bool failed() const { return problem_.has_value(); }

  const std::optional<LineProblem>& problem() const { return problem_; }

 private:
  std::string_view take();

  std::string_view rest_;
  std::optional<LineProblem> problem_{};
};

/// Text in quotes for messages: printable ASCII, at most 24 characters.
std::string quoted(std::string_view text);

}  // namespace waymark
