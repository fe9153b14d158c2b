// SPDX-License-Identifier: BSD-3-Clause
// The web server over the loopback network, with well-behaved clients and others.
#include "viewer/http/page_server.hpp"

#include "common/errors/setup_error.hpp"
#include "support/loopback.hpp"
#include "viewer/http/page_html.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <httplib.h>
#include <sys/socket.h>
#include <unistd.h>

#include <fstream>
#include <random>

namespace waymark::viewer {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class PageServerTest : public ::testing::Test {
 protected:
  PageServerTest() { post(1); }

  void post(std::uint64_t number) {
    LiveView view;
    view.number = number;
    view.title = std::string(kTitleBytes, 't');
    views_.post(std::make_shared<LiveView>(view), {});
  }

  int status_of(const std::string& path) {
    const auto result = client_.Get(path);
    return result ? result->status : 0;
  }

  /// A raw connection, for bytes that no client library would send.
  int connect() const {
    const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
    const sockaddr_in address = test::loopback(port_);
    const timeval patience{.tv_sec = 10, .tv_usec = 0};
    ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    EXPECT_EQ(::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
    return socket;
  }

  /// The beginning of the answer; empty when the server only closes the connection.
  std::string answer_to(const std::string& request) const {
    const int socket = connect();
    ::send(socket, request.data(), request.size(), MSG_NOSIGNAL);
    char buffer[4096];
    const ssize_t n = ::recv(socket, buffer, sizeof buffer, 0);
    ::close(socket);
    return {buffer, static_cast<std::size_t>(std::max<ssize_t>(0, n))};
  }

  static constexpr std::size_t kTitleBytes = 100'000;  // so that few views fill a socket's buffers
  const int port_ = test::free_port();
  ViewStore views_{};
  PageServer server_{{.host = "127.0.0.1", .port = port_}, views_, ::testing::TempDir()};
  httplib::Client client_{"127.0.0.1", port_};
};

TEST_F(PageServerTest, ThePageIsOneFileThatLoadsNothingFromElsewhere) {
  const auto result = client_.Get("/");
  ASSERT_TRUE(result);
  EXPECT_EQ(result->status, 200);
  EXPECT_EQ(result->body, kPageHtml);
  EXPECT_LT(result->body.size(), 150'000U);
  EXPECT_THAT(result->body, Not(HasSubstr("http://")));
  EXPECT_THAT(result->body, Not(HasSubstr("https://")));
}

TEST_F(PageServerTest, SendsAViewAsAnEvent) {
  std::string received;
  client_.Get("/events", [&](const char* data, std::size_t size) {
    received.append(data, size);
    return received.find("\n\n") == std::string::npos;
  });
  EXPECT_THAT(received, StartsWith("data: {"));
}

// 10 km of path, which a client on a slow network could not receive in one event.
TEST_F(PageServerTest, ALongPathComesInSeveralEvents) {
  LiveView view;
  view.number = 2;
  view.path_length = 25'000;
  views_.post(std::make_shared<LiveView>(view), std::vector<PathPoint>(view.path_length));
  std::string received;
  client_.Get("/events", [&](const char* data, std::size_t size) {
    received.append(data, size);
    const bool has_last = received.find("\"first\":20000,") != std::string::npos;
    const bool is_quiet = received.ends_with("\n:\n\n");
    return !is_quiet && (!has_last || !received.ends_with("\n\n"));
  });
  EXPECT_THAT(received, HasSubstr("\"path\":{\"first\":0,"));
  EXPECT_THAT(received, HasSubstr("\"path\":{\"first\":10000,"));
  EXPECT_LT(received.find("\n\n"), 150'000U) << "size of the first event";
}

TEST_F(PageServerTest, SeveralRangesAreRefused) {
  httplib::Client client{"127.0.0.1", port_};
  EXPECT_EQ(client.Get("/", {{"Range", "bytes=0-9"}})->status, 206);
  EXPECT_EQ(client.Get("/", {{"Range", "bytes=0-,0-,0-"}})->status, 416);
}

TEST_F(PageServerTest, UnknownPathsGive404AndInvalidParameters400) {
  EXPECT_EQ(status_of("/view"), 200);
  EXPECT_EQ(status_of("/view?time_s=12.5"), 200);
  EXPECT_EQ(status_of("/tiles?since=0"), 200);
  EXPECT_EQ(status_of("/nothing"), 404);
  EXPECT_EQ(status_of("/camera.jpg"), 404);
  EXPECT_EQ(status_of("/../../etc/passwd"), 404);
  EXPECT_EQ(status_of("/view?time_s=now"), 400);
  EXPECT_EQ(status_of("/view?time_s=nan"), 400);
  EXPECT_EQ(status_of("/view?time_s=1e300"), 400);
  EXPECT_EQ(status_of("/tiles?since=-1"), 400);
}

TEST_F(PageServerTest, RefusesWritesAndForeignHostHeaders) {
  EXPECT_EQ(client_.Post("/", "x", "text/plain")->status, 405);
  EXPECT_EQ(client_.Delete("/map.png")->status, 405);
  EXPECT_EQ(client_.Get("/", {{"Host", "robot.example"}})->status, 403);
}

/// A page with commands, which this process answers in place of slam.
class PageCommandsTest : public PageServerTest {
 protected:
  static constexpr auto kToken = "0123456789abcdef";

  httplib::Result post_command(const std::string& body, const std::string& token = kToken) {
    return commander_.Post("/command", {{"Authorization", "Bearer " + token}}, body,
                           "application/json");
  }

  const int command_port_ = test::free_port();
  std::vector<command_t> asked_{};
  std::optional<reply_t> reply_{
      reply_t{.utime = 0, .command_id = 0, .state = reply_t::STATE_DONE, .text = "saved"}};
  PageServer commanded_{{.host = "127.0.0.1", .port = command_port_},
                        views_,
                        ::testing::TempDir(),
                        PageCommands{.token = kToken, .ask = [this](const command_t& command) {
                                       asked_.push_back(command);
                                       return reply_;
                                     }}};
  httplib::Client commander_{"127.0.0.1", command_port_};
};

TEST_F(PageCommandsTest, CommandsAreForwardedToSlamAndItsReplyReturned) {
  const auto saved = post_command(R"({"command": "save", "name": "day1"})");
  ASSERT_TRUE(saved);
  EXPECT_EQ(saved->status, 200);
  EXPECT_EQ(saved->body, "saved\n");
  post_command(R"({"command": "set-pose", "pose": [1.5, -2, 0.5]})");
  post_command(R"({"command": "set-mode", "mode": "localise"})");
  post_command(R"({"command": "reset"})");
  ASSERT_EQ(asked_.size(), 4U);
  EXPECT_EQ(asked_[0].kind, command_t::KIND_SAVE_MAP);
  EXPECT_EQ(asked_[0].name, "day1");
  EXPECT_EQ(asked_[1].kind, command_t::KIND_SET_POSE);
  EXPECT_THAT(asked_[1].pose, ::testing::ElementsAre(1.5, -2.0, 0.5));
  EXPECT_THAT(asked_[1].sigmas, ::testing::ElementsAre(0.1, 0.1));
  EXPECT_EQ(asked_[2].mode, command_t::MODE_LOCALISE);
  EXPECT_EQ(asked_[3].kind, command_t::KIND_RESET);
}

TEST_F(PageCommandsTest, RefusalsAndTimeoutsAreReported) {
  reply_->state = reply_t::STATE_REFUSED;
  reply_->text = "commands are off";
  const auto refused = post_command(R"({"command": "reset"})");
  EXPECT_EQ(refused->status, 409);
  EXPECT_EQ(refused->body, "commands are off\n");
  reply_.reset();
  EXPECT_EQ(post_command(R"({"command": "reset"})")->status, 504);
}

TEST_F(PageCommandsTest, WithoutTheTokenNoCommandIsSent) {
  const std::string reset = R"({"command": "reset"})";
  EXPECT_EQ(post_command(reset, "0123456789abcdeX")->status, 401);
  EXPECT_EQ(post_command(reset, "")->status, 401);
  EXPECT_EQ(commander_.Post("/command", reset, "application/json")->status, 401);
  EXPECT_EQ(client_.Post("/command", reset, "application/json")->status, 405);
  EXPECT_EQ(client_.Get("/command")->status, 404);
  EXPECT_EQ(commander_.Get("/command")->status, 200);
  EXPECT_THAT(asked_, ::testing::IsEmpty());
}

TEST_F(PageCommandsTest, MalformedCommandsAreRefused) {
  for (const std::string body : {"", "{", "[]", R"({"command": "fly"})", R"({"command": "save"})",
                                 R"({"command": "set-pose", "pose": [1, 2]})",
                                 R"({"command": "set-pose", "pose": [1e999, 2, 3]})",
                                 R"({"command": "set-pose", "pose": [1, 2, "north"]})",
                                 R"({"command": "set-pose", "pose": [1, 2, 3, 4]})",
                                 R"({"command": "set-mode", "mode": "fly"})", R"({"command": 7})"})
    EXPECT_EQ(post_command(body)->status, 400) << body;
  EXPECT_EQ(post_command(std::string(5000, ' '))->status, 413);
  EXPECT_THAT(asked_, ::testing::IsEmpty());
}

TEST(HttpToken, IsLongEnoughAndMayStandInAFile) {
  const std::string file = ::testing::TempDir() + "http_token";
  std::ofstream{file} << "from-a-file-0123456789\nanother line\n";
  EXPECT_EQ(parse_http_token("@" + file), "from-a-file-0123456789");
  EXPECT_EQ(parse_http_token("0123456789abcdef"), "0123456789abcdef");
  EXPECT_THROW(parse_http_token("0123456789abcde"), SetupError);
  EXPECT_THROW(parse_http_token("0123456789 abcdef"), SetupError);
  EXPECT_THROW(parse_http_token(std::string(201, 'a')), SetupError);
  EXPECT_THROW(parse_http_token("@/no/such/file"), SetupError);
}

TEST_F(PageServerTest, ATakenPortIsASetupError) {
  ViewStore views;
  EXPECT_THROW((PageServer{{.host = "127.0.0.1", .port = port_}, views, "."}), SetupError);
}

TEST_F(PageServerTest, GarbageCausesNoServerErrorAndServingContinues) {
  std::mt19937 random{5};
  const std::string good =
      "GET /view?time_s=1 HTTP/1.1\r\nHost: localhost\r\nConnection: close\r\n\r\n";
  ASSERT_THAT(answer_to(good), StartsWith("HTTP/1.1 200 "));
  std::vector<std::string> requests{
      "\r\n\r\n",
      "GET\r\n\r\n",
      "GET / HTTP/9.9\r\n\r\n",
      "BREW / HTTP/1.1\r\n\r\n",
      "GET /" + std::string(20'000, 'a') + " HTTP/1.1\r\n\r\n",
      "GET / HTTP/1.1\r\nRange: bytes=" + std::string(8000, '0') + "\r\n\r\n",
      "POST / HTTP/1.1\r\nContent-Length: 99999999999999999999\r\n\r\n",
      "POST / HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nFFFFFFFFFFFFFFFF\r\n"};
  for (int i = 0; i < 200; ++i) {
    std::string& request = requests.emplace_back(good);
    for (int flips = 0; flips < 4; ++flips)
      request[random() % (good.size() - 4)] = static_cast<char>(random());
  }
  for (const std::string& request : requests) {
    const std::string answer = answer_to(request);
    // Closing the connection without an answer is allowed; and some changes do no harm.
    const bool is_fine =
        answer.empty() || answer.starts_with("HTTP/1.1 4") || answer.starts_with("HTTP/1.1 2");
    EXPECT_TRUE(is_fine) << request.substr(0, 200) << " -> " << answer.substr(0, 200);
  }
  EXPECT_EQ(status_of("/view"), 200);
}

TEST_F(PageServerTest, AClientThatNeverReadsIsDisconnectedWithoutBlockingOthers) {
  const int deaf = connect();
  const std::string request = "GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n";
  ::send(deaf, request.data(), request.size(), MSG_NOSIGNAL);
  // Until the server has closed the connection, which a client sees only when it sends.
  bool is_cut = false;
  std::uint64_t number = 1;
  for (int i = 0; i < 600 && !is_cut; ++i) {
    post(++number);
    std::this_thread::sleep_for(std::chrono::milliseconds{100});
    EXPECT_EQ(status_of("/view"), 200);
    is_cut = i > 20 && ::send(deaf, "\r\n", 2, MSG_NOSIGNAL) < 0;
  }
  EXPECT_TRUE(is_cut);
  ::close(deaf);
}

}  // namespace
}  // namespace waymark::viewer
