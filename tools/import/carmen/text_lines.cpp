// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/text_lines.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 16;
constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;

}  // namespace

TextLines::TextLines(const std::filesystem::path& path)
    : bytes_{open_bytes(path)}, buffer_(kBufferBytes) {}

std::optional<std::string_view> TextLines::next() {
  line_.clear();
  bool any = false;
  while (!unread_.empty() || fill()) {
    any = true;
    const std::size_t end = unread_.find('\n');
    const std::string_view piece = unread_.substr(0, end);
    line_ += piece.substr(0, kMaxLineBytes - std::min(kMaxLineBytes, line_.size()));
    unread_.remove_prefix(std::min(unread_.size(), piece.size() + 1));
    if (end != std::string_view::npos) break;
  }
  if (!any) return std::nullopt;
  ++line_number_;
  return line_;
}

/// False at the end of the readable part.
bool TextLines::fill() {
  unread_ = {buffer_.data(), bytes_->read(buffer_)};
  return !unread_.empty();
}

}  // namespace waymark
