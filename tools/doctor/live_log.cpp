// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/live_log.hpp"

#include "common/bus/bus.hpp"
#include "common/errors/setup_error.hpp"
#include "common/log/log_file.hpp"
#include "common/messages/channels.hpp"
#include "common/runtime/signals.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <system_error>
#include <vector>

namespace waymark {
namespace {

constexpr std::chrono::milliseconds kPoll{100};

std::filesystem::path new_folder() {
  std::string name = (std::filesystem::temp_directory_path() / "waymark-doctor-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) {
    throw SetupError{fmt::format("no folder can be made in {}: set TMPDIR to where there is room",
                                 std::filesystem::temp_directory_path().string())};
  }
  return name;
}

std::vector<std::string> channels_of(const InputChannels& wanted) {
  const auto or_ours = [](const std::string& name, std::string_view ours) {
    return name.empty() ? std::string{ours} : name;
  };
  std::vector<std::string> names{std::string{channels::kCamera.name},
                                 std::string{channels::kMarkers.name},
                                 or_ours(wanted.lidar, channels::kLidar.name)};
  if (wanted.encoders.empty()) {
    names.push_back(or_ours(wanted.odometry, channels::kOdometry.name));
  } else {
    names.push_back(wanted.encoders);
  }
  return names;
}

}  // namespace

LiveLog::LiveLog(const std::string& lcm_url, const InputChannels& wanted,
                 std::chrono::seconds duration, const ShowProgress& progress) {
  const std::vector<std::string> names = channels_of(wanted);
  std::vector<Inbox::Subscription> subscriptions;
  for (const std::string& name : names)
    subscriptions.push_back({name});
  const std::string url = lcm_url_or_default(lcm_url);
  Bus bus{url, subscriptions};
  folder_ = new_folder();
  LogWriter writer{file()};
  std::int64_t num_messages = 0;
  const auto start = std::chrono::steady_clock::now();
  for (;;) {
    const auto elapsed = std::chrono::steady_clock::now() - start;
    if (elapsed >= duration || stop_signal() != 0) break;
    if (progress) {
      progress(std::chrono::duration<double>(elapsed) / std::chrono::duration<double>(duration));
    }
    const auto message = bus.receive(kPoll);
    if (!message) continue;
    writer.write(*message);
    ++num_messages;
  }
  writer.close();
  bus.collect_counts(counters_);
  if (num_messages > 0) return;
  std::filesystem::remove_all(folder_);
  throw SetupError{
      fmt::format("nothing came on {} within {} s on {}: do the drivers run, and on "
                  "this network (--lcm-url)?",
                  fmt::join(names, ", "), duration.count(), url)};
}

LiveLog::~LiveLog() {
  std::error_code ignored;
  std::filesystem::remove_all(folder_, ignored);
}

}  // namespace waymark
