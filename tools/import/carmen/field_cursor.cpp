// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/field_cursor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace waymark {
namespace {

constexpr std::string_view kBlanks = " \t\r";
constexpr std::size_t kMaxQuoted = 24;

template <class Number>
bool parse(std::string_view text, Number& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

}  // namespace

std::string quoted(std::string_view text) {
  std::string shown{text.substr(0, kMaxQuoted)};
  std::ranges::replace_if(
      shown, [](char c) { return c < ' ' || c > '~'; }, '?');
  return fmt::format("\"{}{}\"", shown, text.size() > kMaxQuoted ? "..." : "");
}

std::string_view FieldCursor::take() {
  rest_.remove_prefix(std::min(rest_.find_first_not_of(kBlanks), rest_.size()));
  const std::string_view field = rest_.substr(0, rest_.find_first_of(kBlanks));
  rest_.remove_prefix(field.size());
  return field;
}

std::string_view FieldCursor::word(std::string_view name) {
  if (failed()) return {};
  const std::string_view field = take();
  if (field.empty()) fail("missing field", fmt::format("the line ends before {}", name));
  return field;
}

double FieldCursor::any_number(std::string_view name) {
  const std::string_view field = word(name);
  double value = 0.0;
  if (failed()) return 0.0;
  if (parse(field, value)) return value;
  fail("not a number", fmt::format("{} is {}", name, quoted(field)));
  return 0.0;
}

double FieldCursor::number(std::string_view name) {
  const double value = any_number(name);
  if (std::isfinite(value)) return value;
  fail(std::isnan(value) ? "NaN" : "not finite", fmt::format("{} is {}", name, value));
  return 0.0;
}

int FieldCursor::integer(std::string_view name, int low, int high) {
  const std::string_view field = word(name);
  int value = 0;
  if (failed()) return low;
  if (!parse(field, value)) {
    fail("not a number", fmt::format("{} is {}", name, quoted(field)));
  } else if (value < low || value > high) {
    fail("number out of range", fmt::format("{} is {}, not in {}..{}", name, value, low, high));
  }
  return failed() ? low : value;
}

std::size_t FieldCursor::num_left() const {
  FieldCursor ahead{rest_};
  std::size_t count = 0;
  while (!ahead.take().empty())
    ++count;
  return count;
}

bool FieldCursor::ends_with_number() const {
  FieldCursor ahead{rest_};
  double value = 0.0;
  bool is_number = false;
  for (std::string_view field = ahead.take(); !field.empty(); field = ahead.take())
    is_number = parse(field, value);
  return is_number;
}

void FieldCursor::expect_end() {
  if (failed()) return;
  const std::string_view field = take();
  if (!field.empty()) {
    fail("surplus fields", fmt::format("{} stands where the line should end", quoted(field)));
  }
}

void FieldCursor::fail(std::string_view kind, std::string detail) {
  if (!problem_) problem_ = LineProblem{kind, std::move(detail)};
}

}  // namespace waymark
