// SPDX-License-Identifier: BSD-3-Clause
#include "common/bus/datagram_receiver.hpp"

#include "common/errors/setup_error.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <system_error>
#include <utility>

namespace waymark {
namespace {

constexpr std::string_view kScheme = "udpm://";
constexpr MulticastGroup kDefaultGroup{0xefff4c43, 7667};  // 239.255.76.67
constexpr std::size_t kHeader_bytes = 8;                   // magic, sequence number
constexpr std::array<std::uint8_t, 4> kMagic{'L', 'C', '0', '2'};
constexpr std::array<std::uint8_t, 4> kFragmentMagic{'L', 'C', '0', '3'};
constexpr std::size_t kMaxChannelLength = 63;  // LCM_MAX_CHANNEL_NAME_LENGTH
constexpr std::size_t kMaxDatagram_bytes = 65536;
// Covers the time in which the receiver thread is not scheduled; the kernel grants less where
// net.core.rmem_max is smaller.
constexpr int kReceiveBuffer_bytes = 2 << 20;

void require(int result, const char* what) {
  if (result != 0) throw std::system_error{errno, std::generic_category(), what};
}

template <class Option>
void set(int socket, int level, int name, const Option& option, const char* what) {
  require(setsockopt(socket, level, name, &option, sizeof(option)), what);
}

std::uint32_t overflowed(int socket) {
  std::array<std::uint32_t, SK_MEMINFO_VARS> figures{};
  socklen_t size = sizeof(figures);
  if (getsockopt(socket, SOL_SOCKET, SO_MEMINFO, figures.data(), &size) != 0) return 0;
  return figures[SK_MEMINFO_DROPS];
}

}  // namespace

std::string to_string(const Sender& sender) {
  return fmt::format("{}.{}.{}.{}:{}", sender.address >> 24U, (sender.address >> 16U) & 0xffU,
                     (sender.address >> 8U) & 0xffU, sender.address & 0xffU, sender.port);
}

std::optional<MulticastGroup> multicast_group_of(const std::string& lcm_url) {
  if (!lcm_url.starts_with(kScheme)) return std::nullopt;
  const std::string network = lcm_url.substr(kScheme.size(), lcm_url.find('?') - kScheme.size());
  MulticastGroup group = kDefaultGroup;
  const std::size_t colon = network.find(':');
  const std::string address = network.substr(0, colon);
  in_addr parsed{};
  bool is_group = address.empty();
  if (!is_group && inet_pton(AF_INET, address.c_str(), &parsed) == 1) {
    group.address = ntohl(parsed.s_addr);
    is_group = IN_MULTICAST(group.address);
  }
  if (colon != std::string::npos) {
    const char* end = network.data() + network.size();
    const auto [last, error] = std::from_chars(network.data() + colon + 1, end, group.port);
    is_group = is_group && error == std::errc{} && last == end && group.port != 0;
  }
  if (!is_group) {
    throw SetupError{fmt::format(
        "the LCM network {} is none: expected udpm://ADDRESS:PORT with a multicast address "
        "(224.0.0.0 to 239.255.255.255) and a port from 1 to 65535",
        lcm_url)};
  }
  return group;
}

std::optional<WholeMessage> whole_message_in(std::span<const std::uint8_t> datagram) {
  if (datagram.size() < kHeader_bytes || !std::ranges::equal(datagram.first(4), kMagic))
    return std::nullopt;
  const auto body = datagram.subspan(kHeader_bytes);
  const auto zero = std::ranges::find(body, std::uint8_t{0});
  const auto length = static_cast<std::size_t>(zero - body.begin());
  if (zero == body.end() || length == 0 || length > kMaxChannelLength) return std::nullopt;
  return WholeMessage{{reinterpret_cast<const char*>(body.data()), length},
                      body.subspan(length + 1)};
}

bool is_fragment(std::span<const std::uint8_t> datagram) {
  return datagram.size() >= kHeader_bytes && std::ranges::equal(datagram.first(4), kFragmentMagic);
}

DatagramReceiver::DatagramReceiver(const MulticastGroup& group)
    : socket_{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)}, bytes_(kMaxDatagram_bytes) {
  if (socket_ < 0) throw std::system_error{errno, std::generic_category(), "socket"};
  try {
    join(group);
  } catch (...) {
    close(socket_);
    throw;
  }
}

/// Binds to the group's address, so that datagrams to other groups on the same port are not
/// received.
void DatagramReceiver::join(const MulticastGroup& group) const {
  set(socket_, SOL_SOCKET, SO_REUSEADDR, 1, "SO_REUSEADDR");
  set(socket_, SOL_SOCKET, SO_RCVBUF, kReceiveBuffer_bytes, "SO_RCVBUF");
  const timeval wait{0, std::chrono::microseconds{kWait}.count()};
  set(socket_, SOL_SOCKET, SO_RCVTIMEO, wait, "SO_RCVTIMEO");
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(group.port);
  address.sin_addr.s_addr = htonl(group.address);
  require(bind(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), "bind");
  ip_mreq membership{};
  membership.imr_multiaddr.s_addr = htonl(group.address);
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  set(socket_, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership, "IP_ADD_MEMBERSHIP");
}

DatagramReceiver::~DatagramReceiver() {
  close(socket_);
}

std::optional<DatagramReceiver::Received> DatagramReceiver::receive() {
  sockaddr_in from{};
  socklen_t size = sizeof(from);
  const auto got =
      recvfrom(socket_, bytes_.data(), bytes_.size(), 0, reinterpret_cast<sockaddr*>(&from), &size);
  if (got < 0) return std::nullopt;
  const std::span datagram = std::span{bytes_}.first(static_cast<std::size_t>(got));
  const auto message = whole_message_in(datagram);
  if (!message) {
    ++(is_fragment(datagram) ? fragments_ : malformed_);
    return std::nullopt;
  }
  return Received{{ntohl(from.sin_addr.s_addr), ntohs(from.sin_port)}, *message};
}

std::int64_t DatagramReceiver::take_malformed() {
  return std::exchange(malformed_, 0);
}

std::int64_t DatagramReceiver::take_fragments() {
  return std::exchange(fragments_, 0);
}

std::int64_t DatagramReceiver::take_overflowed() {
  const std::uint32_t now = overflowed(socket_);
  return static_cast<std::uint32_t>(now - std::exchange(overflowed_before_, now));
}

}  // namespace waymark
