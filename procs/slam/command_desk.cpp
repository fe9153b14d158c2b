// SPDX-License-Identifier: BSD-3-Clause
#include "slam/command_desk.hpp"

#include "slam/sigma_range.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr std::size_t kLongestName = 64;
constexpr double kMaxCoordinate_m = 1e6;
constexpr Duration kSecond{1'000'000};

reply_t reply_to(const command_t& message, Timestamp now, std::int8_t state, std::string text) {
  reply_t reply{};
  reply.utime = to_us(now);
  reply.command_id = message.command_id;
  reply.state = state;
  reply.text = std::move(text);
  return reply;
}

StartPose checked_pose(const command_t& message) {
  const auto& [x_m, y_m, yaw_rad] = message.pose;
  const auto& [sigma_m, sigma_rad] = message.sigmas;
  for (const double value : {x_m, y_m, yaw_rad, sigma_m, sigma_rad})
    if (!std::isfinite(value))
      throw Refusal{"the pose or its sigmas have a value that is not finite"};
  if (std::abs(x_m) > kMaxCoordinate_m || std::abs(y_m) > kMaxCoordinate_m)
    throw Refusal{fmt::format("the pose is more than {} m away", kMaxCoordinate_m)};
  const auto [smallest, largest] = std::minmax(sigma_m, sigma_rad);
  if (smallest < kSigmaRange.low || largest > kSigmaRange.high)
    throw Refusal{fmt::format("sigmas must be from {} to {}, not {} m and {} rad", kSigmaRange.low,
                              kSigmaRange.high, sigma_m, sigma_rad)};
  return {StartKind::kPose, x_m, y_m, yaw_rad, sigma_m, sigma_rad};
}

MapMode checked_mode(std::int8_t mode) {
  switch (mode) {
    case command_t::MODE_MAP:
      return MapMode::kMap;
    case command_t::MODE_LOCALISE:
      return MapMode::kLocalise;
    case command_t::MODE_EXTEND:
      return MapMode::kExtend;
    default:
      throw Refusal{fmt::format("mode {} is unknown: 1 map, 2 localise, 3 extend", mode)};
  }
}

}  // namespace

bool is_map_name(std::string_view name) {
  const auto is_allowed = [](char c) {
    return (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-';
  };
  return !name.empty() && name.size() <= kLongestName && std::ranges::all_of(name, is_allowed);
}

Command checked(const command_t& message) {
  Command command;
  switch (message.kind) {
    case command_t::KIND_SAVE_MAP:
      if (!is_map_name(message.name))
        throw Refusal{"a map's name is 1 to 64 letters, digits, _ and -, without folders"};
      command.kind = Command::Kind::kSaveMap;
      command.map_name = message.name;
      return command;
    case command_t::KIND_RESET:
      command.kind = Command::Kind::kReset;
      return command;
    case command_t::KIND_SET_POSE:
      command.kind = Command::Kind::kSetPose;
      command.pose = checked_pose(message);
      return command;
    case command_t::KIND_SET_MODE:
      command.kind = Command::Kind::kSetMode;
      command.mode = checked_mode(message.mode);
      return command;
    default:
      throw Refusal{fmt::format("command kind {} is unknown", message.kind)};
  }
}

std::optional<reply_t> CommandDesk::handle(const command_t& message, Timestamp now,
                                           const Act& act) {
  const auto before = std::ranges::find_if(
      answers_, [&](const reply_t& answer) { return answer.command_id == message.command_id; });
  if (before != answers_.end()) return *before;
  if (!second_begin_ || now < *second_begin_ || now - *second_begin_ >= kSecond) {
    second_begin_ = now;
    commands_ = 0;
  }
  if (++commands_ > kMaxPerSecond) return refused_as_flood(message, now);
  try {
    answers_.push_back(reply_to(message, now, reply_t::STATE_DONE, act(checked(message))));
  } catch (const Refusal& refusal) {
    answers_.push_back(reply_to(message, now, reply_t::STATE_REFUSED, refusal.what()));
  }
  if (answers_.size() > kKeptAnswers) answers_.pop_front();
  return answers_.back();
}

std::optional<reply_t> CommandDesk::refused_as_flood(const command_t& message, Timestamp now) {
  if (commands_ > kMaxPerSecond + 1) return std::nullopt;
  return reply_to(
      message, now, reply_t::STATE_REFUSED,
      fmt::format("more than {} commands in a second of the sensors' time", kMaxPerSecond));
}

}  // namespace waymark
