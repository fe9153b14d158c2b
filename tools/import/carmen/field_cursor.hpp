// SPDX-License-Identifier: BSD-3-Clause
// The fields of a line, taken one after the other; the first error is kept.
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

  /// Empty behind the last field, and once something was wrong.
  std::string_view word(std::string_view name);
  /// Any finite number; 0 once something was wrong.
  double number(std::string_view name);
  /// A number or infinity.
  double any_number(std::string_view name);
  int integer(std::string_view name, int low, int high);
  /// Fields that nobody took yet.
  std::size_t num_left() const;
  /// Whether the line's last field is a number.
  bool ends_with_number() const;
  /// Complains about fields that nobody took.
  void expect_end();

  void fail(std::string_view kind, std::string detail);

  bool failed() const { return problem_.has_value(); }

  const std::optional<LineProblem>& problem() const { return problem_; }

 private:
  std::string_view take();

  std::string_view rest_;
  std::optional<LineProblem> problem_{};
};

/// For messages: printable, and not longer than a few words.
std::string quoted(std::string_view text);

}  // namespace waymark
