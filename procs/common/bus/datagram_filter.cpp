// SPDX-License-Identifier: BSD-3-Clause
#include "common/bus/datagram_filter.hpp"

#include "common/messages/message.hpp"

#include <arpa/inet.h>
#include <linux/filter.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <charconv>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <system_error>

namespace waymark {
namespace {

constexpr std::uint32_t kUdpHeader_bytes = 8;        // the filter sees it before LCM's bytes
constexpr std::uint32_t kLcmHeader_bytes = 8;        // magic, sequence number
constexpr std::uint32_t kMaxChannel_bytes = 64;      // LCM_MAX_CHANNEL_NAME_LENGTH with its zero
constexpr std::uint32_t kMinChannel_bytes = 2;       // one letter and its zero
constexpr std::uint32_t kWholeMessage = 0x4c433032;  // "LC02"; a fragment begins with "LC03"
constexpr std::uint32_t kDrop = 0;
constexpr std::uint32_t kPass = 0xffffffff;

constexpr std::uint32_t kMinDatagram_bytes =
    kUdpHeader_bytes + kLcmHeader_bytes + kMinChannel_bytes;
constexpr std::uint32_t kMaxDatagram_bytes = kUdpHeader_bytes + kLcmHeader_bytes +
                                             kMaxChannel_bytes +
                                             static_cast<std::uint32_t>(kMaxPayloadBytes);

/// Of udpm://ADDRESS:PORT?...
std::optional<std::uint16_t> udp_port(const std::string& url) {
  constexpr std::string_view kScheme = "udpm://";
  if (!url.starts_with(kScheme)) return std::nullopt;
  const std::size_t colon = url.find(':', kScheme.size());
  if (colon == std::string::npos) return std::nullopt;
  std::uint16_t port{0};
  const auto [end, error] = std::from_chars(url.data() + colon + 1, url.data() + url.size(), port);
  if (error != std::errc{}) return std::nullopt;
  return port;
}

bool is_udp_socket_on(int file, std::uint16_t port) {
  int type{0};
  socklen_t type_size = sizeof(type);
  if (getsockopt(file, SOL_SOCKET, SO_TYPE, &type, &type_size) != 0 || type != SOCK_DGRAM)
    return false;
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  if (getsockname(file, reinterpret_cast<sockaddr*>(&address), &size) != 0) return false;
  if (address.ss_family != AF_INET) return false;
  return ntohs(reinterpret_cast<const sockaddr_in&>(address).sin_port) == port;
}

void attach(int file) {
  std::array<sock_filter, 7> program{{
      BPF_STMT(BPF_LD | BPF_W | BPF_LEN, 0),
      BPF_JUMP(BPF_JMP | BPF_JGE | BPF_K, kMinDatagram_bytes, 0, 4),
      BPF_JUMP(BPF_JMP | BPF_JGT | BPF_K, kMaxDatagram_bytes, 3, 0),
      BPF_STMT(BPF_LD | BPF_W | BPF_ABS, kUdpHeader_bytes),
      BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, kWholeMessage, 0, 1),
      BPF_STMT(BPF_RET | BPF_K, kPass),
      BPF_STMT(BPF_RET | BPF_K, kDrop),
  }};
  const sock_fprog filter{static_cast<unsigned short>(program.size()), program.data()};
  if (setsockopt(file, SOL_SOCKET, SO_ATTACH_FILTER, &filter, sizeof(filter)) != 0)
    throw std::system_error{errno, std::generic_category(), "SO_ATTACH_FILTER"};
}

/// By the kernel, since the socket was made; wraps.
std::uint32_t dropped_by(int file) {
  std::array<std::uint32_t, SK_MEMINFO_VARS> figures{};
  socklen_t size = sizeof(figures);
  if (getsockopt(file, SOL_SOCKET, SO_MEMINFO, figures.data(), &size) != 0) return 0;
  return figures[SK_MEMINFO_DROPS];
}

}  // namespace

DatagramFilter::DatagramFilter(const std::string& lcm_url) {
  const auto port = udp_port(lcm_url);
  if (!port) return;
  for (const auto& entry : std::filesystem::directory_iterator{"/proc/self/fd"}) {
    const int file = std::atoi(entry.path().filename().c_str());
    if (!is_udp_socket_on(file, *port)) continue;
    attach(file);
    sockets_.push_back({file, dropped_by(file)});
  }
}

std::int64_t DatagramFilter::take_dropped() {
  std::int64_t total{0};
  for (Socket& socket : sockets_) {
    const std::uint32_t now = dropped_by(socket.file);
    total += static_cast<std::uint32_t>(now - socket.dropped);
    socket.dropped = now;
  }
  return total;
}

}  // namespace waymark
