// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/http/page_commands.hpp"

#include "common/bus/ask_slam.hpp"
#include "common/errors/setup_error.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <fstream>
#include <stdexcept>

namespace waymark::viewer {
namespace {

constexpr std::size_t kShortestToken = 16;
constexpr std::size_t kLongestToken = 200;

/// @throws std::exception unless the list is exactly kSize numbers.
template <std::size_t kSize>
void copy_numbers(const nlohmann::json& list, double (&numbers)[kSize]) {
  const auto values = list.get<std::array<double, kSize>>();
  if (list.size() != kSize) throw std::invalid_argument{"too many numbers"};
  std::copy(values.begin(), values.end(), numbers);
}

/// @throws std::exception when the JSON is no command.
command_t command_of(const nlohmann::json& json) {
  command_t command{};
  const auto kind = json.at("command").get<std::string>();
  if (kind == "save") {
    command.kind = command_t::KIND_SAVE_MAP;
    command.name = json.at("name").get<std::string>();
  } else if (kind == "reset") {
    command.kind = command_t::KIND_RESET;
  } else if (kind == "set-pose") {
    command.kind = command_t::KIND_SET_POSE;
    command.sigmas[0] = kPointedSigma_m;
    command.sigmas[1] = kPointedSigma_rad;
    copy_numbers(json.at("pose"), command.pose);
    if (json.contains("sigmas")) copy_numbers(json.at("sigmas"), command.sigmas);
  } else if (kind == "set-mode") {
    command.kind = command_t::KIND_SET_MODE;
    command.mode = command_modes().at(json.at("mode").get<std::string>());
  } else {
    throw std::invalid_argument{kind};
  }
  return command;
}

std::string first_line(const std::string& file_name) {
  std::ifstream file{file_name};
  std::string line;
  if (!std::getline(file, line))
    throw SetupError{fmt::format("--http-token: '{}' has no line that can be read", file_name)};
  return line;
}

}  // namespace

std::string parse_http_token(const std::string& text) {
  const std::string token = text.starts_with('@') ? first_line(text.substr(1)) : text;
  const bool is_printable =
      std::all_of(token.begin(), token.end(), [](char c) { return c > ' ' && c < '\x7f'; });
  if (!is_printable || token.size() < kShortestToken || token.size() > kLongestToken) {
    throw SetupError{fmt::format(
        "--http-token: expected {} to {} printable characters without spaces, got {}; make one "
        "with: openssl rand -hex 16",
        kShortestToken, kLongestToken, token.size())};
  }
  return token;
}

bool carries_token(std::string_view authorization_header, std::string_view token) {
  constexpr std::string_view kScheme = "Bearer ";
  if (!authorization_header.starts_with(kScheme)) return false;
  const std::string_view given = authorization_header.substr(kScheme.size());
  if (given.size() != token.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < token.size(); ++i)
    difference |= static_cast<unsigned char>(given[i]) ^ static_cast<unsigned char>(token[i]);
  return difference == 0;
}

command_t parse_page_command(std::string_view json) {
  try {
    return command_of(nlohmann::json::parse(json));
  } catch (const std::exception&) {
    throw std::invalid_argument{
        R"(not understood; expected e.g. {"command": "save", "name": "day1"}, {"command": "reset"}, )"
        R"({"command": "set-pose", "pose": [x_m, y_m, yaw_rad]} or )"
        R"({"command": "set-mode", "mode": "localise"})"};
  }
}

}  // namespace waymark::viewer
