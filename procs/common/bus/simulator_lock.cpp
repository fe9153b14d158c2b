// SPDX-License-Identifier: BSD-3-Clause
#include "common/bus/simulator_lock.hpp"

#include "common/bus/datagram_receiver.hpp"
#include "common/errors/setup_error.hpp"
#include "common/messages/channels.hpp"

#include <fmt/format.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>

namespace waymark {

SimulatorLock::SimulatorLock(const std::string& lcm_url, const ChannelNames& names) {
  const auto group = multicast_group_of(lcm_url);
  if (!group) return;
  // An abstract socket: visible in this network namespace only, and leaves no file behind.
  const std::string name =
      fmt::format("waymark-sim/{}/{}", group->port, names.on_network(channels::kTick.name));
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::size_t size = std::min(name.size(), sizeof address.sun_path - 1);
  std::memcpy(address.sun_path + 1, name.data(), size);
  socket_ = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  const auto length = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + size);
  if (socket_ >= 0 && ::bind(socket_, reinterpret_cast<const sockaddr*>(&address), length) == 0) {
    return;
  }
  const int error = errno;
  if (socket_ >= 0) ::close(socket_);
  if (error != EADDRINUSE)
    throw SetupError{fmt::format("UDP port {} cannot be kept for one simulator: {}", group->port,
                                 std::strerror(error))};
  throw SetupError{fmt::format(
      "another simulator runs in lockstep on UDP port {}; wait for its end, or give --lcm-url "
      "another port, e.g. udpm://239.255.76.67:{}?ttl=0",
      group->port, group->port < 65535 ? group->port + 1 : 1024)};
}

SimulatorLock::~SimulatorLock() {
  if (socket_ >= 0) ::close(socket_);
}

}  // namespace waymark
