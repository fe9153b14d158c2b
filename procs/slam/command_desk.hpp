// SPDX-License-Identifier: BSD-3-Clause
// Commands received from other programs: checks, and replies.
#pragma once

#include "common/messages/channels.hpp"
#include "common/time/time.hpp"
#include "slam/core/estimators/map_use.hpp"

#include <deque>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace waymark {

/// A command with valid values.
struct Command {
  enum class Kind { kSaveMap, kReset, kSetPose, kSetMode };

  Kind kind{Kind::kSaveMap};
  std::string map_name{};
  StartPose pose{};
  MapMode mode{MapMode::kMap};
};

/// Reason, in one sentence, why a command is not carried out.
class Refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Converts a message and checks its values.
/// @throws Refusal
Command checked(const command_t& message);

/// [A-Za-z0-9_-]{1,64}: not a path, and without characters that are special to shells or file
/// systems.
bool is_map_name(std::string_view name);

/// Each command acts once: a repeated one gets the same answer again. Beyond kMaxPerSecond of
/// message time, commands are refused, only the first of them with an answer, so that a flood
/// neither delays the scans nor fills the network.
class CommandDesk {
 public:
  static constexpr int kMaxPerSecond = 5;

  /// Carries a command out. @return what was done; throws Refusal.
  using Act = std::function<std::string(const Command&)>;

  /// @param now  time of the newest observation.
  /// @return the answer; none: the command was dropped.
  std::optional<reply_t> handle(const command_t& message, Timestamp now, const Act& act);

 private:
  static constexpr std::size_t kKeptAnswers = 32;

  std::optional<reply_t> refused_as_flood(const command_t& message, Timestamp now);

  std::deque<reply_t> answers_{};
  std::optional<Timestamp> second_begin_{};
  int commands_{0};  ///< received since second_begin_
};

}  // namespace waymark
