// SPDX-License-Identifier: BSD-3-Clause
#include "import/log/import_report.hpp"

#include <fmt/format.h>

namespace waymark {
namespace {

constexpr std::int64_t kNamedPerKind = 10;

std::string address_of(const std::string& file, AddressUnit unit, std::int64_t at) {
  if (unit == AddressUnit::kLine) return fmt::format("{}:{}", file, at);
  return fmt::format("{}: {} {}", file, unit == AddressUnit::kByte ? "byte" : "row", at);
}

}  // namespace

void ImportReport::skip(std::string_view kind, std::int64_t at, std::string_view detail) {
  const std::int64_t count = ++skipped_by_kind_.try_emplace(std::string{kind}, 0).first->second;
  if (count > kNamedPerKind) return;
  messages_.push_back(
      fmt::format("{}: skipped: {}: {}", address_of(file_, unit_, at), kind, detail));
  if (count == kNamedPerKind) {
    messages_.push_back(fmt::format("{}: further cases of \"{}\" are only counted", file_, kind));
  }
}

std::int64_t ImportReport::num_skipped() const {
  std::int64_t sum = 0;
  for (const auto& [kind, count] : skipped_by_kind_)
    sum += count;
  return sum;
}

}  // namespace waymark
