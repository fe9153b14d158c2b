// SPDX-License-Identifier: BSD-3-Clause
// Input: all bytes that a browser sends over one connection to the server of the live page. The
// server must answer with a status that is no server error, or close the connection, and must send
// no command without the token. (cpp-httplib itself is compiled without instrumentation.)
#include "common/messages/codec.hpp"
#include "support/loopback.hpp"
#include "viewer/http/page_server.hpp"

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <cctype>
#include <charconv>
#include <csignal>
#include <cstdlib>

namespace waymark::fuzz {
namespace {

constexpr std::string_view kToken = "0123456789abcdef";
constexpr int kPatience_ms = 50;
constexpr std::array kStatuses{200, 206, 400, 401, 403, 404, 405, 413, 414, 415, 416, 503};

/// The page of a run with a map of one tile and a camera image.
class Page {
 public:
  Page() {
    std::signal(SIGPIPE, SIG_IGN);
    viewer::LiveMap map{.version = 1};
    map.tiles.push_back(std::make_shared<viewer::LiveTile>(
        viewer::LiveTile{.version = 1, .occupancy_percent = std::vector<std::int8_t>(64)}));
    viewer::LiveView view;
    view.number = 1;
    view.map = std::make_shared<viewer::LiveMap>(map);
    view.camera = std::make_shared<viewer::CameraFrame>();
    views_.post(std::make_shared<viewer::LiveView>(view), {});
  }

  /// The beginning of the answer; empty when the request is incomplete.
  std::string answer_to(std::span<const std::uint8_t> request) const {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    const sockaddr_in address = test::loopback(port_);
    if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
      std::abort();
    std::string bytes{request.begin(), request.end()};
    bytes += "\r\n\r\n";
    ::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL);
    pollfd waiting{.fd = socket, .events = POLLIN, .revents = 0};
    const bool is_answered = ::poll(&waiting, 1, kPatience_ms) == 1;
    ::shutdown(socket, SHUT_WR);  // the server answers nothing after this
    std::string answer;
    char buffer[4096];
    for (ssize_t size = 1; size > 0;) {
      size = ::recv(socket, buffer, sizeof buffer, 0);
      answer.append(buffer, static_cast<std::size_t>(std::max<ssize_t>(size, 0)));
      if (is_answered && answer.find("text/event-stream") != std::string::npos) break;  // endless
    }
    ::close(socket);
    return answer;
  }

  /// Number of commands since the last call.
  int num_commands() { return num_commands_.exchange(0); }

 private:
  std::optional<reply_t> answer(const command_t& command) {
    encode(channels::kSlamCommand, command);
    ++num_commands_;
    return reply_t{.utime = 0, .command_id = 0, .state = reply_t::STATE_DONE, .text = "done"};
  }

  std::atomic<int> num_commands_{0};
  viewer::ViewStore views_{};
  const int port_ = test::free_port();
  viewer::PageServer server_{
      {.host = "127.0.0.1", .port = port_},
      views_,
      "/proc/self/none",
      viewer::PageCommands{std::string{kToken}, [this](const command_t& command) {
                             return answer(command);
                           }}};
};

/// Decodes "%41" to "A", as the server does in headers.
std::string decoded(std::span<const std::uint8_t> bytes) {
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    int byte = bytes[i];
    if (byte == '%' && i + 2 < bytes.size() && std::isxdigit(bytes[i + 1]) != 0 &&
        std::isxdigit(bytes[i + 2]) != 0) {
      const auto* digits = reinterpret_cast<const char*>(&bytes[i + 1]);
      std::from_chars(digits, digits + 2, byte, 16);
      i += 2;
    }
    text += static_cast<char>(byte);
  }
  return text;
}

void check_status(std::string_view answer) {
  int status = 0;
  if (!answer.starts_with("HTTP/1.1 ") || answer.size() < 12) std::abort();
  std::from_chars(answer.data() + 9, answer.data() + 12, status);
  if (status != 100 && std::ranges::find(kStatuses, status) == kStatuses.end()) std::abort();
}

}  // namespace
}  // namespace waymark::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace waymark::fuzz;
  static Page page;
  const std::span bytes{data, size};
  const std::string answer = page.answer_to(bytes);
  if (!answer.empty()) check_status(answer);
  if (page.num_commands() > 0 && decoded(bytes).find(kToken) == std::string::npos) std::abort();
  return 0;
}
