// SPDX-License-Identifier: BSD-3-Clause
#include "support/lcm_network.hpp"

#include <arpa/inet.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/file.h>
#include <sys/socket.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

namespace waymark::testing_support {
namespace {

constexpr const char* kGroup = "239.255.76.67";
constexpr int kFirstPort = 17700;
constexpr int kLastPort = 17999;

void append(std::vector<std::uint8_t>& bytes, std::uint64_t value, int num_bytes) {
  for (int i = num_bytes - 1; i >= 0; --i)
    bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

}  // namespace

PrivateNetwork::PrivateNetwork() : socket_file_{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)} {
  const auto folder = std::filesystem::temp_directory_path() / "waymark-test-ports";
  std::filesystem::create_directories(folder);
  for (int port = kFirstPort; port <= kLastPort; ++port) {
    const int file =
        open((folder / std::to_string(port)).c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666);
    if (file >= 0 && flock(file, LOCK_EX | LOCK_NB) == 0) {
      lock_file_ = file;
      port_ = port;
      return;
    }
    if (file >= 0) close(file);
  }
  throw std::runtime_error{"no free test port in " + folder.string()};
}

PrivateNetwork::~PrivateNetwork() {
  close(lock_file_);
}

std::string PrivateNetwork::url() const {
  return fmt::format("udpm://{}:{}?ttl=0", kGroup, port_);
}

void PrivateNetwork::send_datagram(const std::vector<std::uint8_t>& bytes) const {
  const unsigned char ttl = 0;
  setsockopt(socket_file_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof(ttl));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port_));
  inet_aton(kGroup, &address.sin_addr);
  sendto(socket_file_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&address),
         sizeof(address));
}

std::vector<std::uint8_t> lcm_datagram(const std::string& channel,
                                       const std::vector<std::uint8_t>& payload) {
  std::vector<std::uint8_t> bytes;
  append(bytes, 0x4c433032U, 4);  // "LC02"
  append(bytes, 1, 4);
  bytes.insert(bytes.end(), channel.begin(), channel.end());
  bytes.push_back(0);
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return bytes;
}

std::vector<std::uint8_t> lcm_fragment(std::uint32_t message_bytes, std::uint32_t offset,
                                       std::uint16_t fragment, std::uint16_t num_fragments,
                                       const std::vector<std::uint8_t>& body) {
  std::vector<std::uint8_t> bytes;
  append(bytes, 0x4c433033U, 4);  // "LC03"
  append(bytes, 1, 4);
  append(bytes, message_bytes, 4);
  append(bytes, offset, 4);
  append(bytes, fragment, 2);
  append(bytes, num_fragments, 2);
  bytes.insert(bytes.end(), body.begin(), body.end());
  return bytes;
}

}  // namespace waymark::testing_support
