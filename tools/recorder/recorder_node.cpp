// SPDX-License-Identifier: BSD-3-Clause
#include "recorder/recorder_node.hpp"

#include "common/logging/logging.hpp"
#include "common/messages/channels.hpp"
#include "common/runtime/reorder_buffer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace waymark {
namespace {

constexpr std::array kDataChannels{
    channels::kCamera.name,       channels::kLidar.name,          channels::kOdometry.name,
    channels::kDriveCommand.name, channels::kTruePose.name,       channels::kMarkers.name,
    channels::kSlamPose.name,     channels::kSlamEstimate.name,   channels::kSlamMap.name,
    channels::kSlamGrid.name,     channels::kSlamMarkers.name,    channels::kSlamParticles.name,
    channels::kSlamScan.name,     channels::kSlamTrajectory.name, channels::kSlamCorrection.name,
    channels::kSlamChanges.name,  channels::kSlamCommand.name,    channels::kSlamReply.name,
    channels::kSlamFindings.name, channels::kMapGraph.name};

constexpr std::chrono::seconds kBetweenLines{10};
constexpr std::size_t kMaxHeldBack = 100;

/// @throws SetupError if the log, or its partial file of a recording that crashed or runs, exists.
void protect_recordings(const std::filesystem::path& log) {
  if (std::filesystem::is_regular_file(log)) {
    throw SetupError{log.string() +
                     ": is there already; a recording replaces none: give another name"};
  }
  const std::filesystem::path part = part_path_of(log);
  if (std::filesystem::exists(part)) {
    throw SetupError{
        part.string() +
        ": is what a recording left that was cut short or still goes on; it can be read "
        "like any log: give it another name, or this recording"};
  }
}

}  // namespace

void RecorderSection::describe(Fields& fields) {
  fields.field("exclude", exclude, "channels not to record, e.g. [\"CAMERA\"] for small logs");
}

void RecorderConfig::check(Problems& problems) const {
  for (const std::string& channel : recorder.exclude) {
    if (std::ranges::find(kDataChannels, channel) == kDataChannels.end()) {
      problems.add("recorder.exclude", "got " + channel + ", which is no data channel");
    }
  }
}

RecorderNode::RecorderNode(const RecorderConfig& config, Inbox& inbox, Outbox&)
    : counters_{inbox.counters()} {
  if (config.out_log.empty())
    throw SetupError{"--out-log FILE is missing: where shall the log go?"};
  protect_recordings(config.out_log);
  try {
    writer_.emplace(config.out_log);
  } catch (const std::exception& error) {
    throw SetupError{error.what()};
  }
  for (const std::string_view channel : kDataChannels) {
    if (std::ranges::find(config.recorder.exclude, channel) != config.recorder.exclude.end())
      continue;
    inbox.on_raw(channel, [this](const Message& message) { record(message); });
  }
}

void RecorderNode::record(const Message& message) {
  if (failed_) return;
  if (!has_stamped_ && is_unstamped(message) && held_back_.size() < kMaxHeldBack) {
    held_back_.push_back(message);
    return;
  }
  write_held_back(message.time);
  write(message);
}

/// A command that came before the sensors has no stamp; at time 0, it would begin the log, decades
/// before everything else.
void RecorderNode::write_held_back(Timestamp time) {
  has_stamped_ = true;
  for (Message& message : std::exchange(held_back_, {})) {
    message.time = time;
    write(message);
  }
}

void RecorderNode::write(const Message& message) {
  if (failed_) return;
  try {
    writer_->write(message);
    counters_.add(message.channel + " recorded");
    ++recent_[message.channel];
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void RecorderNode::poll(const WallClock& clock) {
  if (!last_line_) last_line_ = clock.now;
  if (clock.now - *last_line_ < kBetweenLines) return;
  last_line_ = clock.now;
  if (recent_.empty()) return;
  std::string text;
  for (auto& [channel, count] : recent_)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", channel, std::exchange(count, 0));
  logging::info("recorded in {} s: {}", kBetweenLines.count(), text);
}

void RecorderNode::finish() {
  write_held_back({});
  if (failed_) return;
  try {
    writer_->close();
  } catch (const std::exception& error) {
    fail(error.what());
  }
}

void RecorderNode::fail(const std::string& what) {
  failed_ = true;
  logging::error("{}; the log ends here, the run goes on", what);
}

}  // namespace waymark
