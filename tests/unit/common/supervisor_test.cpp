// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/supervisor.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <cstddef>
#include <cstdlib>

namespace waymark {
namespace {

/// The datagram that arrives on a socket of that name, which $NOTIFY_SOCKET is set to.
std::string heard_on(const std::string& name, std::string_view state) {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  name.copy(address.sun_path, name.size());
  if (name[0] == '@') address.sun_path[0] = '\0';
  const int listener = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
  EXPECT_EQ(bind(listener, reinterpret_cast<const sockaddr*>(&address), size), 0);
  setenv("NOTIFY_SOCKET", name.c_str(), 1);
  notify_supervisor(state);
  unsetenv("NOTIFY_SOCKET");
  std::string text(100, '\0');
  const auto got = recv(listener, text.data(), text.size(), 0);
  close(listener);
  text.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
  return text;
}

TEST(Supervisor, IsNotifiedOnItsSocket) {
  const std::string name = "/tmp/waymark-notify-" + std::to_string(getpid());
  EXPECT_EQ(heard_on(name, kReady), "READY=1");
  unlink(name.c_str());
  EXPECT_EQ(heard_on("@waymark-notify-" + std::to_string(getpid()), kAlive), "WATCHDOG=1");
}

TEST(Supervisor, AMissingSupervisorIsIgnored) {
  unsetenv("NOTIFY_SOCKET");
  notify_supervisor(kReady);
  for (const std::string& name :
       {std::string{}, std::string{"/"}, std::string{"/tmp/no/socket"}, std::string(200, 'x')}) {
    setenv("NOTIFY_SOCKET", name.c_str(), 1);
    notify_supervisor(kReady);
  }
  unsetenv("NOTIFY_SOCKET");
}

}  // namespace
}  // namespace waymark
