// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/http/page_server.hpp"

#include "common/errors/setup_error.hpp"
#include "viewer/http/page_html.hpp"
#include "viewer/http/page_json.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <mutex>
#include <thread>

namespace waymark::viewer {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kEventPeriod{200};
constexpr milliseconds kSlowestClient{2000};
constexpr milliseconds kKeepAlive{2000};
constexpr int kMaxStreams = 8;
constexpr std::size_t kThreads = 2 * kMaxStreams;  // streams occupy at most half of them
constexpr int kSendBufferBytes = 256 * 1024;       // per client
constexpr int kNiceness = 10;
/// About 140 kB of JSON; a longer path is sent in several events.
constexpr std::size_t kPathPointsPerEvent = 10'000;

struct Download {
  const char* name;
  const char* type;
};

constexpr std::array kDownloads{
    Download{"map.png", "image/png"},    Download{"map.pgm", "image/x-portable-graymap"},
    Download{"map.yaml", "text/plain"},  Download{"trajectory.tum", "text/plain"},
    Download{"markers.csv", "text/csv"},
};

/// Leaves out SO_REUSEPORT, which httplib sets by default: with it, two viewers could share a port.
void set_socket_options(int socket) {
  const int on = 1;
  ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  ::setsockopt(socket, SOL_SOCKET, SO_SNDBUF, &kSendBufferBytes, sizeof kSendBufferBytes);
}

/// A number in the query; nullopt when the key is absent.
/// @throws std::invalid_argument when the value is not a number.
template <class Number>
std::optional<Number> number_of(const httplib::Request& request, const char* key) {
  if (!request.has_param(key)) return std::nullopt;
  const std::string text = request.get_param_value(key);
  Number number{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc{} || end != text.data() + text.size()) throw std::invalid_argument{key};
  return number;
}

void answer(httplib::Response& response, int status, const std::string& sentence) {
  response.status = status;
  response.set_content(sentence + "\n", "text/plain");
}

/// The newest view as JSON, created once for all clients.
class NewestViewJson {
 public:
  std::shared_ptr<const std::string> of(const LiveView& view, const ViewStore& views) {
    const std::scoped_lock lock{mutex_};
    if (!text_ || number_ != view.number)
      text_ = std::make_shared<const std::string>(view_json(view, views.history()));
    number_ = view.number;
    return text_;
  }

 private:
  std::mutex mutex_{};
  std::uint64_t number_{0};
  std::shared_ptr<const std::string> text_{};
};

/// One client's stream of views.
class EventStream {
 public:
  EventStream(const ViewStore& views, NewestViewJson& newest_json, std::atomic<int>& num_streams)
      : views_{views}, newest_json_{newest_json}, num_streams_{num_streams} {}

  EventStream(const EventStream&) = delete;
  EventStream& operator=(const EventStream&) = delete;

  ~EventStream() { --num_streams_; }

  /// Waits for a new view and sends it. @return false to end the connection.
  bool send_next(httplib::DataSink& sink) {
    wait_for_period();
    const ViewPtr view = views_.wait_for_newer(number_, kKeepAlive);
    if (views_.closed()) return false;
    const auto start = steady_clock::now();
    const std::string text =
        view ? event(*view) : ":\n\n";  // a comment, to detect closed connections
    const bool sent = sink.write(text.data(), text.size());
    last_ = steady_clock::now();
    return sent && last_ - start < kSlowestClient;
  }

 private:
  /// Waits until kEventPeriod after the last event, in short sleeps so that closing the view store
  /// ends the wait.
  void wait_for_period() const {
    while (steady_clock::now() - last_ < kEventPeriod && !views_.closed())
      std::this_thread::sleep_for(milliseconds{20});
  }

  std::string event(const LiveView& view) {
    const std::size_t path_end = std::min(view.path_length, path_sent_ + kPathPointsPerEvent);
    const auto growth = views_.path(path_sent_, path_end);
    const std::string json = with_path(*newest_json_.of(view, views_), path_sent_, growth);
    path_sent_ += growth.size();
    // The view is sent again while its path is not complete.
    if (path_end == view.path_length) number_ = view.number;
    return "data: " + json + "\n\n";
  }

  const ViewStore& views_;
  NewestViewJson& newest_json_;
  std::atomic<int>& num_streams_;
  std::uint64_t number_{0};
  std::size_t path_sent_{0};
  steady_clock::time_point last_{};
};

/// @throws SetupError
void bind_to(httplib::Server& server, const HttpAddress& address) {
  errno = 0;
  if (server.bind_to_port(address.host, address.port)) return;
  const std::string why = errno == 0 ? "the host is not known" : std::strerror(errno);
  throw SetupError{fmt::format(
      "--http: cannot listen on {}:{}: {}; give an address of this machine and a free port",
      address.host, address.port, why)};
}

}  // namespace

class PageServer::Implementation {
 public:
  Implementation(const HttpAddress& address, ViewStore& views, std::filesystem::path folder,
                 std::optional<PageCommands> commands)
      : address_{address},
        views_{views},
        folder_{std::move(folder)},
        commands_{std::move(commands)} {
    set_limits();
    add_routes();
    bind_to(server_, address);
    thread_ = std::thread{[this] {
      // Applies to this thread and those that it starts.
      ::setpriority(PRIO_PROCESS, static_cast<id_t>(::gettid()), kNiceness);
      server_.listen_after_bind();
      has_ended_ = true;
    }};
  }

  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  ~Implementation() {
    views_.close();
    // stop() has no effect before the thread listens.
    while (!server_.is_running() && !has_ended_)
      std::this_thread::sleep_for(milliseconds{1});
    server_.stop();
    thread_.join();
  }

 private:
  void set_limits() {
    server_.new_task_queue = [] {
      return new httplib::ThreadPool{kThreads};
    };
    server_.set_socket_options(set_socket_options);
    server_.set_read_timeout(kSlowestClient);
    server_.set_write_timeout(kSlowestClient);
    server_.set_keep_alive_timeout(2);
    server_.set_payload_max_length(1024);
    server_.set_default_headers({{"Cache-Control", "no-store"},
                                 {"X-Content-Type-Options", "nosniff"},
                                 {"Content-Security-Policy",
                                  "default-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; "
                                  "frame-ancestors 'none'"}});
    server_.set_pre_routing_handler(
        [this](const auto& request, auto& response) { return refuse(request, response); });
    server_.set_exception_handler([](const auto&, auto& response, std::exception_ptr) {
      answer(response, 400, "the query is not understood");
    });
  }

  httplib::Server::HandlerResponse refuse(const httplib::Request& request,
                                          httplib::Response& response) const {
    using Outcome = httplib::Server::HandlerResponse;
    if (request.ranges.size() > 1) {  // each may be the whole file again
      answer(response, 416, "one range at most");
      return Outcome::Handled;
    }
    const bool is_command = request.method == "POST" && request.path == "/command";
    if (is_command && !commands_) {
      answer(response, 405, "read-only: commands need a viewer with --http-token");
      return Outcome::Handled;
    }
    if (!is_command && request.method != "GET" && request.method != "HEAD") {
      answer(response, 405, "read-only: GET and HEAD");
      return Outcome::Handled;
    }
    const std::string host = request.get_header_value("Host");
    if (address_.is_loopback() && !host.empty() && !names_loopback(host)) {
      answer(response, 403, "this page is for this machine only");
      return Outcome::Handled;
    }
    return Outcome::Unhandled;
  }

  void add_routes() {
    server_.Get("/", [](const auto&, auto& response) {
      response.set_content(kPageHtml.data(), kPageHtml.size(), "text/html; charset=utf-8");
    });
    server_.Get("/events", [this](const auto&, auto& response) { serve_events(response); });
    server_.Get("/view", [this](const auto& request, auto& response) {
      if (const ViewPtr view = view_for(request, response))
        response.set_content(view_json(*view, views_.history()), "application/json");
    });
    server_.Get("/tiles", [this](const auto& request, auto& response) {
      const auto since = number_of<std::uint32_t>(request, "since").value_or(0);
      if (const ViewPtr view = view_for(request, response))
        response.set_content(tile_bytes(*view->map, since), "application/octet-stream");
    });
    server_.Get("/camera.jpg", [this](const auto& request, auto& response) {
      const ViewPtr view = view_for(request, response);
      if (view && view->camera) {
        response.set_content(view->camera->jpeg, "image/jpeg");
      } else if (view) {
        answer(response, 404, "no camera image so far");
      }
    });
    server_.Get("/command", [this](const auto&, auto& response) {
      if (!commands_) return answer(response, 404, "no --http-token: nothing can be commanded");
      response.set_content("POST, with the token\n", "text/plain");
    });
    server_.Post("/command",
                 [this](const auto& request, auto& response) { serve_command(request, response); });
    for (const Download& download : kDownloads)
      server_.Get(fmt::format("/{}", download.name), [this, download](const auto&, auto& response) {
        serve_file(download, response);
      });
  }

  /// The newest view, or that at `time_s`. Before the first view: null, and the answer is 404.
  ViewPtr view_for(const httplib::Request& request, httplib::Response& response) const {
    const auto time_s = number_of<double>(request, "time_s");
    constexpr double kLatest_s = 1e12;  // beyond all message times, within int64 microseconds
    if (time_s && !(std::abs(*time_s) < kLatest_s)) throw std::invalid_argument{"time_s"};
    // A microsecond more, so that rounding of time_s does not select the view before.
    const ViewPtr view =
        time_s ? views_.at(Timestamp{duration_from_seconds(*time_s + 1e-6)}) : views_.newest();
    if (!view) answer(response, 404, "nothing has come so far");
    return view;
  }

  void serve_events(httplib::Response& response) {
    if (++num_streams_ > kMaxStreams) {
      --num_streams_;
      answer(response, 503, fmt::format("{} pages are open already; close one", kMaxStreams));
      return;
    }
    const auto stream = std::make_shared<EventStream>(views_, newest_json_, num_streams_);
    response.set_chunked_content_provider(
        "text/event-stream",
        [stream](std::size_t, httplib::DataSink& sink) { return stream->send_next(sink); });
  }

  void serve_command(const httplib::Request& request, httplib::Response& response) {
    if (!carries_token(request.get_header_value("Authorization"), commands_->token))
      return answer(response, 401, "not the token of --http-token");
    const std::unique_lock lock{command_mutex_, std::try_to_lock};
    if (!lock) return answer(response, 429, "another command is on its way");
    try {
      const auto reply = commands_->ask(parse_page_command(request.body));
      if (!reply) return answer(response, 504, "slam has not answered within 2 s");
      const bool is_done = reply->state == reply_t::STATE_DONE;
      answer(response, is_done ? 200 : 409, reply->text);
    } catch (const std::invalid_argument& error) {
      answer(response, 400, error.what());
    } catch (const std::exception& error) {
      answer(response, 504, error.what());
    }
  }

  void serve_file(const Download& download, httplib::Response& response) const {
    std::ifstream file{folder_ / download.name, std::ios::binary};
    if (!file) return answer(response, 404, "not written so far");
    response.set_content(std::string{std::istreambuf_iterator<char>{file}, {}}, download.type);
    response.set_header("Content-Disposition",
                        fmt::format("attachment; filename=\"{}\"", download.name));
  }

  HttpAddress address_;
  ViewStore& views_;
  std::filesystem::path folder_;
  std::optional<PageCommands> commands_;
  std::mutex command_mutex_{};
  NewestViewJson newest_json_{};
  std::atomic<int> num_streams_{0};
  std::atomic<bool> has_ended_{false};
  httplib::Server server_;
  std::thread thread_;
};

void check_http_address(const HttpAddress& address) {
  httplib::Server server;
  bind_to(server, address);
}

PageServer::PageServer(const HttpAddress& address, ViewStore& views, std::filesystem::path folder,
                       std::optional<PageCommands> commands)
    : implementation_{std::make_unique<Implementation>(address, views, std::move(folder),
                                                       std::move(commands))} {}

PageServer::~PageServer() = default;

}  // namespace waymark::viewer
