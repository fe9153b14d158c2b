// SPDX-License-Identifier: BSD-3-Clause
// Commands from outside: what they may ask for, and what is answered.
#pragma once

#include "common/messages/channels.hpp"
#include "common/time/time.hpp"
#include "slam/core/graph/map_snapshot.hpp"

#include <deque>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace waymark {

/// A command whose values are possible.
struct Command {
  enum class Kind { kSaveMap, kReset, kSetPose, kSetMode };

  Kind kind{Kind::kSaveMap};
  std::string map_name{};
  StartPose pose{};
  MapMode mode{MapMode::kMap};
};

/// Why a command is not carried out, in one sentence.
class Refusal : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// @throws Refusal
Command checked(const command_t& message);

/// [A-Za-z0-9_-]{1,64}: no path, and no name that a shell or a file system takes for something
/// else.
bool is_map_name(std::string_view name);

/// Each command acts once: one that comes again gets the same answer again. More than some in a
/// second of message time are refused, the first of them with an answer, so that a flood neither
/// holds up the scans nor fills the network.
class CommandDesk {
 public:
  static constexpr int kMostPerSecond = 5;

  /// Carries a command out. @return what was done; throws Refusal.
  using Act = std::function<std::string(const Command&)>;

  /// @param now  newest observation.
  /// @return the answer; nothing: the command was dropped.
  std::optional<reply_t> take(const command_t& message, Timestamp now, const Act& act);

 private:
  static constexpr std::size_t kKeptAnswers = 32;  ///< answers

  std::optional<reply_t> refused_as_flood(const command_t& message, Timestamp now);

  std::deque<reply_t> answers_{};
  std::optional<Timestamp> second_begin_{};
  int taken_{0};  ///< since then
};

}  // namespace waymark
