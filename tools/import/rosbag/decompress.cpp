// SPDX-License-Identifier: BSD-3-Clause
#include "import/rosbag/decompress.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <array>
#include <memory>

namespace waymark {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::array<std::uint8_t, 4> kZstdMagic{0x28, 0xB5, 0x2F, 0xFD};

bool unpack_bz2(ByteView packed, Bytes& out) {
  Bytes copy{packed.begin(), packed.end()};  // bzlib's input is not const
  auto size = static_cast<unsigned>(out.size());
  const int result = BZ2_bzBuffToBuffDecompress(reinterpret_cast<char*>(out.data()), &size,
                                                reinterpret_cast<char*>(copy.data()),
                                                static_cast<unsigned>(copy.size()), 0, 0);
  return result == BZ_OK && size == out.size();
}

bool unpack_lz4(ByteView packed, Bytes& out) {
  LZ4F_dctx* raw = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&raw, LZ4F_VERSION)) != 0) return false;
  const std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context{
      raw, &LZ4F_freeDecompressionContext};
  std::size_t read = 0;
  std::size_t written = 0;
  while (read < packed.size()) {
    std::size_t output = out.size() - written;
    std::size_t input = packed.size() - read;
    const std::size_t hint =
        LZ4F_decompress(raw, out.data() + written, &output, packed.data() + read, &input, nullptr);
    if (LZ4F_isError(hint) != 0) return false;
    read += input;
    written += output;
    if (hint == 0 || (input == 0 && output == 0)) break;
  }
  return written == out.size();
}

bool unpack_zstd(ByteView packed, Bytes& out) {
  const std::size_t size = ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size());
  return ZSTD_isError(size) == 0U && size == out.size();
}

}  // namespace

bool is_known_compression(std::string_view method) {
  return method == "bz2" || method == "lz4" || method == "zstd";
}

std::optional<Bytes> decompress(std::string_view method, ByteView packed, std::uint64_t size) {
  if (size > kMaxUnpackedBytes || packed.size() > kMaxUnpackedBytes) return std::nullopt;
  Bytes out(static_cast<std::size_t>(size));
  const bool done = (method == "bz2" && unpack_bz2(packed, out)) ||
                    (method == "lz4" && unpack_lz4(packed, out)) ||
                    (method == "zstd" && unpack_zstd(packed, out));
  return done ? std::optional{std::move(out)} : std::nullopt;
}

bool is_zstd_frame(ByteView bytes) {
  return bytes.size() >= kZstdMagic.size() && std::ranges::equal(bytes.first(4), kZstdMagic);
}

std::optional<Bytes> decompress_zstd_frame(ByteView packed) {
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR) return std::nullopt;
  return decompress("zstd", packed, size);
}

}  // namespace waymark
