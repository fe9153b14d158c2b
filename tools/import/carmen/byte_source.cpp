// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/byte_source.hpp"

#include "common/errors/setup_error.hpp"

#include <bzlib.h>
#include <fmt/format.h>
#include <zlib.h>

#include <array>
#include <cstdio>
#include <string_view>

namespace waymark {
namespace {

constexpr std::string_view kBzip2Magic = "BZh";

/// Archive formats that are recognised but not read.
struct Archive {
  std::string_view magic;
  std::string_view kind;
  std::string_view unpack;  ///< program that unpacks it
};

constexpr std::array<Archive, 5> kArchives{{{"PK\x03\x04", "a zip archive", "unzip"},
                                            {"\xFD"
                                             "7zXZ",
                                             "compressed by xz", "unxz"},
                                            {"7z\xBC\xAF", "a 7z archive", "7z x"},
                                            {"\x28\xB5\x2F\xFD", "compressed by zstd", "unzstd"},
                                            {"Rar!", "a rar archive", "unrar x"}}};
constexpr std::size_t kLongestMagic = 5;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

using File = std::unique_ptr<std::FILE, CloseFile>;

/// zlib also reads files that are not compressed.
class GzipSource final : public ByteSource {
 public:
  explicit GzipSource(const std::filesystem::path& path) : file_{gzopen(path.c_str(), "rb")} {
    if (!file_) throw SetupError{path.string() + ": cannot be read"};
  }

  std::size_t read(std::span<char> buffer) override {
    const int size = gzread(file_.get(), buffer.data(), static_cast<unsigned>(buffer.size()));
    return static_cast<std::size_t>(std::max(size, 0));
  }

  std::string fault() const override {
    int code = Z_OK;
    const char* text = gzerror(file_.get(), &code);
    return code == Z_OK || code == Z_STREAM_END ? std::string{} : std::string{text};
  }

 private:
  struct Close {
    void operator()(gzFile_s* file) const { gzclose(file); }
  };

  std::unique_ptr<gzFile_s, Close> file_;
};

/// One or several concatenated streams, as parallel compressors write them.
class Bzip2Source final : public ByteSource {
 public:
  explicit Bzip2Source(File file) : file_{std::move(file)} { open({}); }

  std::size_t read(std::span<char> buffer) override {
    while (stream_) {
      int code = BZ_OK;
      const int size =
          BZ2_bzRead(&code, stream_.get(), buffer.data(), static_cast<int>(buffer.size()));
      if (code == BZ_STREAM_END) {
        next_stream();
      } else if (code != BZ_OK) {
        fault_ = code == BZ_UNEXPECTED_EOF ? "unexpected end of file" : "damaged bzip2 data";
        stream_.reset();
        return 0;
      }
      if (size > 0) return static_cast<std::size_t>(size);
    }
    return 0;
  }

  std::string fault() const override { return fault_; }

 private:
  void open(std::string unused) {
    int code = BZ_OK;
    stream_.reset(
        BZ2_bzReadOpen(&code, file_.get(), 0, 0, unused.data(), static_cast<int>(unused.size())));
    if (code != BZ_OK) stream_.reset();
  }

  /// Bytes after a stream's end belong to the next one.
  void next_stream() {
    int code = BZ_OK;
    void* bytes = nullptr;
    int size = 0;
    BZ2_bzReadGetUnused(&code, stream_.get(), &bytes, &size);
    std::string unused{static_cast<const char*>(bytes), static_cast<std::size_t>(size)};
    stream_.reset();
    const int next = unused.empty() ? std::fgetc(file_.get()) : 0;
    if (next == EOF) return;
    if (unused.empty()) unused.push_back(static_cast<char>(next));
    open(std::move(unused));
  }

  struct Close {
    void operator()(void* stream) const {
      int code = BZ_OK;
      BZ2_bzReadClose(&code, stream);
    }
  };

  File file_;
  std::unique_ptr<void, Close> stream_;
  std::string fault_{};
};

}  // namespace

std::unique_ptr<ByteSource> open_bytes(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) throw SetupError{path.string() + ": there is no such file"};
  if (std::filesystem::is_directory(status))
    throw SetupError{path.string() + ": is a folder; name the log in it"};
  if (!std::filesystem::is_regular_file(status))
    throw SetupError{path.string() +
                     ": is no regular file; write a pipe's content to a file first"};
  if (std::filesystem::file_size(path, error) == 0) throw SetupError{path.string() + ": is empty"};
  File file{std::fopen(path.c_str(), "rb")};
  if (!file) throw SetupError{path.string() + ": cannot be read"};
  std::array<char, kLongestMagic> bytes{};
  const std::size_t size = std::fread(bytes.data(), 1, bytes.size(), file.get());
  const std::string_view start{bytes.data(), size};
  for (const Archive& archive : kArchives) {
    if (start.starts_with(archive.magic)) {
      throw SetupError{fmt::format("{}: is {}; unpack it first ({} {})", path.string(),
                                   archive.kind, archive.unpack, path.filename().string())};
    }
  }
  if (!start.starts_with(kBzip2Magic)) return std::make_unique<GzipSource>(path);
  std::rewind(file.get());
  return std::make_unique<Bzip2Source>(std::move(file));
}

}  // namespace waymark
