// SPDX-License-Identifier: BSD-3-Clause
// Replaces libFuzzer where there is no clang: runs the target on inputs of a corpus with a few
// random changes each, not guided by coverage. An input that ends the program, takes too long or
// allocates too much at once is kept as PREFIXcrash.
//
// usage: fuzz_TARGET -runs=N [-seed=N] [-max_len=N] [-timeout=S] [-malloc_limit_mb=N]
//                   [-artifact_prefix=PREFIX] CORPUS
//        fuzz_TARGET FILE    repeats one input
#include "common/files/whole_file.hpp"

#include <fmt/format.h>
#include <sanitizer/common_interface_defs.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <limits>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

/// A function of AddressSanitizer that no header of GCC declares.
extern "C" int __sanitizer_install_malloc_and_free_hooks(
    void (*malloc_hook)(const volatile void* memory, std::size_t bytes),
    void (*free_hook)(const volatile void* memory));

/// Makes AddressSanitizer call our handler also after abort().
extern "C" const char* __asan_default_options() {
  return "handle_abort=1";
}

namespace waymark::fuzz {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int kMaxChanges = 6;
constexpr std::size_t kLongestPiece_bytes = 64;

std::string input;
std::string artifact_prefix;
std::size_t allocation_limit_bytes = 0;

void keep_input() {
  write_whole_file(artifact_prefix + "crash", input);
}

void watch_allocation(const volatile void*, std::size_t bytes) {
  if (bytes <= allocation_limit_bytes) return;
  allocation_limit_bytes = std::numeric_limits<std::size_t>::max();  // keep_input() allocates, too
  fmt::print(stderr, "{} bytes at once\n", bytes);
  std::abort();
}

void watch_free(const volatile void*) {}

void run_target() {
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
}

class Mutator {
 public:
  Mutator(std::vector<std::string> corpus, std::size_t max_bytes, std::uint64_t seed)
      : corpus_{std::move(corpus)}, max_bytes_{max_bytes}, random_{seed} {}

  std::string next() {
    std::string bytes = any_input();
    for (std::size_t changes = 1 + below(kMaxChanges); changes > 0; --changes)
      change(bytes);
    bytes.resize(std::min(bytes.size(), max_bytes_));
    return bytes;
  }

 private:
  std::size_t below(std::size_t end) {
    return std::uniform_int_distribution<std::size_t>{0, end - 1}(random_);
  }

  const std::string& any_input() { return corpus_[below(corpus_.size())]; }

  std::string piece_of(const std::string& bytes) {
    return bytes.substr(below(bytes.size() + 1), below(kLongestPiece_bytes));
  }

  /// A number at which arithmetic overflows, as 1, 2, 4 or 8 bytes, most significant first.
  std::string limit_number() {
    constexpr std::array<std::uint64_t, 10> kLimits{
        0, 1, 0x7f, 0xff, 0x7fff, 0xffff, 0x7fffffff, 0xffffffff, 0x7fffffffffffffff, ~0ULL};
    const std::uint64_t number = kLimits[below(kLimits.size())];
    const std::size_t size = std::size_t{1} << below(4);
    std::string bytes;
    for (std::size_t i = size; i-- > 0;)
      bytes += static_cast<char>(number >> (8 * i));
    return bytes;
  }

  void change(std::string& bytes) {
    const std::size_t at = below(bytes.size() + 1);
    switch (below(6)) {
      case 0:
        if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1 << below(8)));
        break;
      case 1:
        if (at < bytes.size()) bytes[at] = static_cast<char>(below(256));
        break;
      case 2: {
        const std::string number = limit_number();
        bytes.replace(at, number.size(), number);
        break;
      }
      case 3:
        bytes.erase(at, below(kLongestPiece_bytes));
        break;
      case 4:
        bytes.insert(at, piece_of(bytes));
        break;
      default:
        bytes.insert(at, piece_of(any_input()));
    }
  }

  std::vector<std::string> corpus_;
  std::size_t max_bytes_;
  std::mt19937_64 random_;
};

std::vector<std::string> read_corpus(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator{folder})
    files.push_back(entry.path());
  std::ranges::sort(files);
  std::vector<std::string> corpus;
  for (const fs::path& file : files)
    corpus.push_back(read_whole_file(file));
  if (corpus.empty()) throw std::runtime_error{"no inputs in " + folder.string()};
  return corpus;
}

struct Options {
  std::uint64_t runs = 0;
  std::uint64_t seed = 1;
  std::size_t max_len = std::numeric_limits<std::size_t>::max();
  std::chrono::seconds timeout{2};
  std::size_t malloc_limit_mb = 1024;
  fs::path path;
};

/// Parses libFuzzer's options; those that are not supported here have no effect.
Options parse(std::span<char*> words) {
  Options options;
  for (const std::string_view word : words) {
    const std::size_t equals = word.find('=');
    const std::string_view name = word.substr(0, equals);
    const std::string value{word.substr(equals == word.npos ? word.size() : equals + 1)};
    if (name == "-runs") options.runs = std::stoull(value);
    if (name == "-seed") options.seed = std::stoull(value);
    if (name == "-max_len") options.max_len = std::stoull(value);
    if (name == "-timeout") options.timeout = std::chrono::seconds{std::stoi(value)};
    if (name == "-malloc_limit_mb") options.malloc_limit_mb = std::stoull(value);
    if (name == "-artifact_prefix") artifact_prefix = value;
    if (!word.starts_with('-')) options.path = word;
  }
  return options;
}

int run(const Options& options) {
  Mutator mutator{read_corpus(options.path), options.max_len, options.seed};
  __sanitizer_set_death_callback(keep_input);
  allocation_limit_bytes = options.malloc_limit_mb << 20;
  __sanitizer_install_malloc_and_free_hooks(watch_allocation, watch_free);
  Clock::duration longest{};
  for (std::uint64_t i = 0; i < options.runs; ++i) {
    input = mutator.next();
    const auto start = Clock::now();
    run_target();
    longest = std::max(longest, Clock::now() - start);
    if (longest <= options.timeout) continue;
    keep_input();
    fmt::print("an input took more than {} s\n", options.timeout.count());
    return 1;
  }
  fmt::print("longest input: {} ms\nstat::number_of_executed_units: {}\n",
             std::chrono::duration_cast<std::chrono::milliseconds>(longest).count(), options.runs);
  return 0;
}

}  // namespace
}  // namespace waymark::fuzz

int main(int argc, char** argv) {
  using namespace waymark::fuzz;
  try {
    const Options options = parse({argv + 1, argv + argc});
    if (fs::is_directory(options.path)) return run(options);
    input = waymark::read_whole_file(options.path);
    run_target();
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}
