// SPDX-License-Identifier: BSD-3-Clause
// First inputs for the fuzz targets, from a run of launch.sh and a map.
//
// usage: fuzz_seeds RUN_DIR MAP_FILE OUT_DIR
#include "common/files/whole_file.hpp"
#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "message_types.hpp"

#include <cstdio>
#include <map>

namespace waymark::fuzz {
namespace {

namespace fs = std::filesystem;

constexpr int kOfEachChannel = 4;
constexpr std::size_t kMaxInLog_bytes = 2000;
constexpr std::size_t kMaxSeed_bytes = 20000;

void write_seed(const fs::path& folder, const std::string& name, std::string_view bytes) {
  fs::create_directories(folder);
  write_whole_file(folder / name, bytes);
}

std::string_view text_of(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

void write_message(const fs::path& out, const std::string& name, const Message& message) {
  for_each_type([&]<class Type>(std::size_t index, const Channel<Type>&) {
    if (fingerprint_of(message.payload) != Type::getHash()) return;
    std::string seed(1, static_cast<char>(index));
    seed += text_of(message.payload).substr(8);
    write_seed(out / "messages", name, seed);
  });
  using namespace std::string_literals;
  std::string datagram = "LC02\0\0\0\0"s + message.channel + '\0';
  datagram += text_of(message.payload);
  write_seed(out / "datagram", name, datagram);
}

void write_image(const fs::path& out, const Message& message) {
  const auto image = decode<image_t>(message.payload);
  if (image.message) write_seed(out / "jpeg", "image", text_of(image.message->data));
}

/// A few messages of each channel, alone and as logs.
void write_messages(const fs::path& out, const fs::path& log, const std::string& prefix) {
  std::map<std::string, int> counts;
  LogReader reader{log};
  LogWriter writer{out / "seeds.lcm"};
  while (const auto message = reader.next()) {
    const int count = counts[message->channel]++;
    if (message->channel == channels::kCamera.name && count == 0) write_image(out, *message);
    if (count >= kOfEachChannel || message->payload.size() > kMaxSeed_bytes) continue;
    write_message(out, prefix + message->channel + std::to_string(count), *message);
    if (message->payload.size() <= kMaxInLog_bytes) writer.write(*message);
  }
  writer.close();
  const std::string few = read_whole_file(out / "seeds.lcm");
  for (const char* target : {"log", "mbot"})
    write_seed(out / target, prefix + "log", few);
  fs::remove(out / "seeds.lcm");
}

void write_copy(const fs::path& file, const fs::path& folder) {
  if (fs::exists(file)) write_seed(folder, file.filename().string(), read_whole_file(file));
}

int run(const fs::path& run, const fs::path& map, const fs::path& out) {
  fs::create_directories(out);
  write_messages(out, run / "run.lcm", "run_");
  write_messages(out, map, "map_");
  write_copy(map, out / "map");
  write_copy(run / "robot.toml", out / "config");
  write_copy(run / "waymark/config.toml", out / "config");
  write_copy(run / "waymark/markers.csv", out / "survey");
  for (const auto& entry : fs::directory_iterator{WAYMARK_SOURCE_DIR "/tests/data/import"})
    write_copy(entry.path(), out / "carmen");
  return 0;
}

}  // namespace
}  // namespace waymark::fuzz

int main(int argc, char** argv) {
  if (argc == 4) return waymark::fuzz::run(argv[1], argv[2], argv[3]);
  std::fprintf(stderr, "usage: fuzz_seeds RUN_DIR MAP_FILE OUT_DIR\n");
  return 2;
}
