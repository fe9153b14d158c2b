// SPDX-License-Identifier: BSD-3-Clause
// How a configuration struct lists its fields: once, for reading, checking, dumping and
// documentation.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace waymark {

/// Closed interval of allowed values.
struct Range {
  double low{-std::numeric_limits<double>::infinity()};
  double high{std::numeric_limits<double>::infinity()};
};

inline constexpr Range kAnyNumber{};
inline constexpr Range kNotNegative{0.0, std::numeric_limits<double>::infinity()};
inline constexpr Range kPositive{std::numeric_limits<double>::min(),
                                 std::numeric_limits<double>::infinity()};
inline constexpr Range kFraction{0.0, 1.0};

/// Visitor of a configuration struct. A struct has a member `void describe(Fields& fields)` that
/// calls field(), choice(), section() or list() for each member, in file order, with the TOML key
/// equal to the member's name and a one-line description with its meaning.
class Fields {
 public:
  virtual ~Fields() = default;

  virtual void field(std::string_view key, bool& value, std::string_view meaning) = 0;
  virtual void field(std::string_view key, std::string& value, std::string_view meaning) = 0;
  virtual void field(std::string_view key, int& value, Range range, std::string_view meaning) = 0;
  virtual void field(std::string_view key, std::int64_t& value, Range range,
                     std::string_view meaning) = 0;
  virtual void field(std::string_view key, double& value, Range range,
                     std::string_view meaning) = 0;
  virtual void field(std::string_view key, std::vector<int>& value, Range range,
                     std::string_view meaning) = 0;
  virtual void field(std::string_view key, std::vector<double>& value, Range range,
                     std::string_view meaning) = 0;
  virtual void field(std::string_view key, std::vector<std::string>& value,
                     std::string_view meaning) = 0;

  /// A member of an enumeration, written as one of a few words.
  template <class Enum>
  void choice(std::string_view key, Enum& value,
              std::initializer_list<std::pair<std::string_view, Enum>> words,
              std::string_view meaning) {
    std::vector<std::string_view> names;
    std::size_t index = 0;
    for (const auto& [name, meant] : words) {
      if (meant == value) index = names.size();
      names.push_back(name);
    }
    word(key, names, index, meaning);
    value = (words.begin() + index)->second;
  }

  /// Fields that only some settings use. Where they are not used, setting one is an error, and a
  /// dump leaves them out; their types are checked in any case.
  /// @param unused  the reason, e.g. "slam.estimator = waymark does not use it".
  template <class Describe>
  void when(bool is_used, std::string_view unused, Describe describe) {
    if (!enter_use(is_used, unused)) return;
    describe();
    leave_use();
  }

  /// A nested table.
  template <class Struct>
  void section(std::string_view key, Struct& value) {
    if (!enter(key)) return;
    value.describe(*this);
    leave();
  }

  /// An array of tables; each element starts from the struct's defaults.
  template <class Struct>
  void list(std::string_view key, std::vector<Struct>& values, std::string_view meaning) {
    if (const auto new_size = list_size(key, values.size(), meaning)) {
      values.assign(*new_size, Struct{});
    }
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!enter_element(key, i)) continue;
      values[i].describe(*this);
      leave();
    }
  }

 protected:
  /// Visits a choice. @param index  of the chosen word; a reader replaces it.
  virtual void word(std::string_view key, std::span<const std::string_view> words,
                    std::size_t& index, std::string_view meaning) = 0;
  /// False when there is nothing to visit in that table.
  virtual bool enter(std::string_view key) = 0;
  virtual bool enter_element(std::string_view key, std::size_t index) = 0;
  virtual void leave() = 0;
  /// False when unused fields are not to be visited.
  virtual bool enter_use(bool is_used, std::string_view unused) = 0;
  virtual void leave_use() = 0;
  /// Number of elements of the list that replaces the current one; nullopt: the current one stays.
  virtual std::optional<std::size_t> list_size(std::string_view key, std::size_t current_size,
                                               std::string_view meaning) = 0;
};

}  // namespace waymark
