// SPDX-License-Identifier: BSD-3-Clause
// First inputs for the fuzz targets, from a run of launch.sh and a map.
//
// usage: fuzz_seeds RUN_DIR MAP_FILE OUT_DIR
#include "common/files/whole_file.hpp"
#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "message_types.hpp"

#include <fmt/format.h>

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

/// Writes a few messages of each channel, alone and as logs.
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

/// Writes a program's index as in command_line.cpp, then its words.
void write_command_line(const fs::path& out, int program, const std::vector<std::string>& words) {
  std::string seed(1, static_cast<char>(program));
  for (const std::string& word : words)
    seed += word + '\0';
  write_seed(out / "command_line", std::to_string(program) + words.front(), seed);
}

void write_command_lines(const fs::path& out) {
  write_command_line(out, 0, {"--config", "a.toml", "--set", "run.seed=7", "--seed", "-3"});
  write_command_line(out, 0, {"--dump-robot-config", "--set=robot.lidar.rate_hz=5.0", "--check"});
  write_command_line(out, 1, {"--lcm-url", "udpm://239.255.76.67:7667?ttl=0", "--real-time"});
  write_command_line(out, 1, {"--log", "a.lcm", "--out-log", "b.lcm", "--report", "c.json"});
  write_command_line(out, 2, {"--load-map", "a.map.lcm", "--mode", "localise", "--start", "pose"});
  write_command_line(out, 2, {"--set", "slam.estimator=gmapping", "--save-map", "a.map.lcm"});
  write_command_line(out, 2, {"--print-config", "slam.seed", "--log=a.lcm", "--skip-s", "1e3"});
  write_command_line(out, 3, {"--http", "[::1]:8080", "--http-token", "0123456789abcdef"});
  write_command_line(out, 3, {"--set", "viewer.title=\"a\"", "--set", "channels.LIDAR=SCAN"});
  write_command_line(out, 4, {"--set", "recorder.exclude=[\"CAMERA\"]", "--large-messages"});
  write_command_line(out, 5, {"--lcm-url", "udpm://", "save", "day1"});
  write_command_line(out, 5, {"set-pose", "1", "-2.5", "1e-3", "--sigma-m", "0.1"});
  write_command_line(out, 5, {"set-mode", "localise", "--help"});
}

/// Writes requests to the live page: whole, and their parts with a first byte as in page_text.cpp.
void write_requests(const fs::path& out) {
  for (const std::string path :
       {"/", "/events", "/view?time_s=1", "/tiles?since=1", "/camera.jpg", "/command", "/map.png"})
    write_seed(out / "request", "get_" + fs::path{path}.filename().string(),
               "GET " + path + " HTTP/1.1\r\nHost: localhost:8080\r\n\r\n");
  write_seed(out / "request", "head",
             "HEAD / HTTP/1.1\r\nRange: bytes=0-9,20-\r\nAccept-Encoding: gzip\r\n\r\n");
  const std::string post = "POST /command HTTP/1.1\r\nAuthorization: Bearer 0123456789abcdef\r\n";
  for (const std::string json :
       {R"({"command": "save", "name": "day1"})", R"({"command": "reset"})",
        R"({"command": "set-pose", "pose": [1.5, -2, 0.5], "sigmas": [0.1, 0.2]})",
        R"({"command": "set-mode", "mode": "localise"})"}) {
    const std::string name = std::to_string(json.size());
    write_seed(out / "page_text", name, '\2' + json);
    write_seed(out / "request", name,
               fmt::format("{}Content-Length: {}\r\n\r\n{}", post, json.size(), json));
    write_seed(out / "request", "chunked" + name,
               fmt::format("{}Transfer-Encoding: chunked\r\n\r\n{:x}\r\n{}\r\n0\r\n\r\n", post,
                           json.size(), json));
  }
  for (const std::string host : {"localhost:80", "127.0.0.1", "[::1]:80", "127.0.0.1.example.org"})
    write_seed(out / "page_text", "host" + host, '\0' + host);
  write_seed(out / "page_text", "token", "\1Bearer 0123456789abcdef");
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
  write_command_lines(out);
  write_requests(out);
  return 0;
}

}  // namespace
}  // namespace waymark::fuzz

int main(int argc, char** argv) {
  if (argc == 4) return waymark::fuzz::run(argv[1], argv[2], argv[3]);
  std::fprintf(stderr, "usage: fuzz_seeds RUN_DIR MAP_FILE OUT_DIR\n");
  return 2;
}
