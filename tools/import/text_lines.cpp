// SPDX-License-Identifier: BSD-3-Clause
#include "import/text_lines.hpp"

#include "common/process/node.hpp"

#include <zlib.h>

#include <algorithm>

namespace waymark {
namespace {

constexpr std::size_t kBufferBytes = std::size_t{1} << 16;
constexpr std::size_t kMaxLineBytes = std::size_t{1} << 20;

}  // namespace

void TextLines::Close::operator()(gzFile_s* file) const {
  gzclose(file);
}

TextLines::TextLines(const std::filesystem::path& path) : buffer_(kBufferBytes) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw SetupError{path.string() + ": there is no such file"};
  }
  if (std::filesystem::file_size(path, error) == 0) throw SetupError{path.string() + ": is empty"};
  file_.reset(gzopen(path.c_str(), "rb"));
  if (!file_) throw SetupError{path.string() + ": cannot be read"};
}

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

std::string TextLines::fault() const {
  int code = Z_OK;
  const char* text = gzerror(file_.get(), &code);
  return code == Z_OK || code == Z_STREAM_END ? std::string{} : std::string{text};
}

/// False at the end of what can be read.
bool TextLines::fill() {
  const int size = gzread(file_.get(), buffer_.data(), static_cast<unsigned>(buffer_.size()));
  unread_ = {buffer_.data(), static_cast<std::size_t>(std::max(size, 0))};
  return size > 0;
}

}  // namespace waymark
