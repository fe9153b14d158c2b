// SPDX-License-Identifier: BSD-3-Clause
// Imitates an MBot's web app without any code of ours: with its channel names and message types,
// over liblcm. Reads pose, map and status of a live run, and resets it. Exit code 0: all messages
// were as an MBot sends them.
//
// usage: mbot_client LCM_URL
#include <lcm/lcm-cpp.hpp>
#include <mbot_lcm_msgs/mbot_slam_reset_t.hpp>
#include <mbot_lcm_msgs/occupancy_grid_t.hpp>
#include <mbot_lcm_msgs/pose2D_t.hpp>
#include <mbot_lcm_msgs/slam_status_t.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace {

using namespace mbot_lcm_msgs;
using std::chrono::seconds;
using std::chrono::steady_clock;

constexpr int kLocalisationOnly = 2;
constexpr int kFullSlam = 3;
constexpr std::size_t kDatagramBytes = 65499;  // largest message that liblcm sends in one piece

class Client {
 public:
  explicit Client(const std::string& url) : lcm_{url} {
    listen("SLAM_POSE", &Client::on_pose);
    listen("SLAM_MAP", &Client::on_map);
    listen("SLAM_STATUS", &Client::on_status);
  }

  /// Receives messages until `condition` holds; false when it does not hold in time, or a message
  /// was not as an MBot sends it.
  bool wait_until(const std::function<bool()>& condition, seconds timeout) {
    const auto end = steady_clock::now() + timeout;
    while (!condition() && strange_.empty()) {
      if (steady_clock::now() > end) return false;
      lcm_.handleTimeout(50);
    }
    return strange_.empty();
  }

  void reset(int mode) {
    mbot_slam_reset_t message{};
    message.slam_mode = mode;
    message.slam_map_location = "current.map";
    lcm_.publish("MBOT_SYSTEM_RESET", &message);
  }

  std::vector<pose2D_t> poses{};
  std::optional<occupancy_grid_t> map{};
  std::optional<slam_status_t> status{};

  const std::string& strange() const { return strange_; }

 private:
  using Handler = void (Client::*)(const lcm::ReceiveBuffer*, const std::string&);

  void listen(const char* channel, Handler handler) {
    lcm_.subscribe(channel, handler, this)->setQueueCapacity(1000);
  }

  template <class Type>
  std::optional<Type> decoded(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    Type message{};
    const int size = static_cast<int>(buffer->data_size);
    if (buffer->data_size <= kDatagramBytes && message.decode(buffer->data, 0, size) == size)
      return message;
    strange_ = channel + ": a message of another type, or too large";
    return std::nullopt;
  }

  void on_pose(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    if (const auto pose = decoded<pose2D_t>(buffer, channel)) poses.push_back(*pose);
  }

  void on_map(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    if (auto grid = decoded<occupancy_grid_t>(buffer, channel)) map = std::move(grid);
  }

  void on_status(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
    if (auto heard = decoded<slam_status_t>(buffer, channel)) status = std::move(heard);
  }

  lcm::LCM lcm_;
  std::string strange_{};
};

bool has_walls(const Client& client) {
  return client.map &&
         std::ranges::count_if(client.map->cells, [](int odds) { return odds > 0; }) > 20;
}

bool expect(bool holds, const Client& client, const char* what) {
  const float last_x = client.poses.empty() ? -1.0F : client.poses.back().x;
  std::printf("%s: %s (%zu poses, the last one at x = %.2f m) %s\n", holds ? "ok" : "FAILED", what,
              client.poses.size(), static_cast<double>(last_x), client.strange().c_str());
  return holds;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  Client client{argv[1]};
  const auto poses_after = [&client](std::size_t count) {
    return client.poses.size() > count;
  };

  const bool is_read = client.wait_until(
      [&] {
        return !client.poses.empty() && client.poses.back().x > 1.0F && has_walls(client) &&
               client.status;
      },
      seconds{120});
  if (!expect(is_read, client, "pose, map and status are read")) return 1;
  if (!expect(client.status->slam_mode == kFullSlam, client, "the mode is full SLAM")) return 1;

  std::size_t heard = client.poses.size();
  client.reset(kLocalisationOnly);
  const bool goes_on = client.wait_until([&] { return poses_after(heard + 5); }, seconds{20}) &&
                       client.poses.back().x > 1.0F;
  if (!expect(goes_on, client, "a reset into another mode is refused")) return 1;

  heard = client.poses.size();
  client.reset(kFullSlam);
  const bool is_reset = client.wait_until(
      [&] { return poses_after(heard) && std::abs(client.poses.back().x) < 0.5F; }, seconds{20});
  if (!expect(is_reset, client, "a reset begins anew at the origin")) return 1;
  client.map.reset();
  return expect(client.wait_until([&] { return has_walls(client); }, seconds{20}), client,
                "a new map is drawn")
             ? 0
             : 1;
}
