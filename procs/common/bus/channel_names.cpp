// SPDX-License-Identifier: BSD-3-Clause
#include "common/bus/channel_names.hpp"

#include "common/messages/channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace waymark {
namespace {

struct TypedChannel {
  std::string_view channel;
  std::string_view type;
  std::int64_t fingerprint;
  ChannelUse use;
};

/// Every channel that may be on a network.
const std::vector<TypedChannel>& typed_channels() {
  static const std::vector<TypedChannel> all =
      channels::visit_all([]<class... Types>(const Channel<Types>&... channels) {
        std::vector<TypedChannel> typed{
            {channels.name, Types::getTypeName(), Types::getHash(), channels.use}...};
        std::erase_if(typed, [](const auto& one) { return one.use == ChannelUse::kMapFiles; });
        return typed;
      });
  return all;
}

std::string key_of(std::string_view channel) {
  std::string key{channel};
  std::ranges::transform(key, key.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return key;
}

/// Names that liblcm accepts, without the characters of its subscription patterns.
bool is_name(std::string_view text) {
  constexpr std::size_t kLongest = 63;  // LCM_MAX_CHANNEL_NAME_LENGTH
  return !text.empty() && text.size() <= kLongest && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-' || c == '/';
  });
}

}  // namespace

ChannelNames::ChannelNames() {
  for (const TypedChannel& typed : typed_channels())
    names_.emplace(typed.channel, typed.use == ChannelUse::kNetwork ? typed.channel : "");
}

void ChannelNames::describe(Fields& fields) {
  std::string_view last;
  for (const TypedChannel& typed : typed_channels()) {
    if (typed.channel == last) continue;  // LIDAR has two types
    last = typed.channel;
    fields.field(
        key_of(typed.channel), names_.find(typed.channel)->second,
        fmt::format(
            "name on the network of {} ({}){}", typed.channel, typed.type,
            typed.use == ChannelUse::kNetwork ? "" : "; \"\" = it is neither sent nor heard"));
  }
}

void ChannelNames::check(Problems& problems) const {
  const auto& all = typed_channels();
  for (auto at = all.begin(); at != all.end(); ++at) {
    const std::string_view name = on_network(at->channel);
    const std::string key = "channels." + key_of(at->channel);
    if (name.empty() && at->use == ChannelUse::kNetworkOnceNamed) continue;
    if (!is_name(name)) {
      problems.add(key, fmt::format("got \"{}\", expected a name of 1 to 63 letters, digits, "
                                    "'_', '-' or '/'",
                                    name));
      continue;
    }
    const auto other = std::find_if(all.begin(), at, [&](const TypedChannel& earlier) {
      return earlier.fingerprint == at->fingerprint && on_network(earlier.channel) == name;
    });
    if (other == at) continue;
    // Report the channel that was renamed, not the one that has its default name.
    const bool is_usual = name == at->channel;
    const std::string_view said_of = is_usual ? other->channel : at->channel;
    const std::string_view sharing = is_usual ? at->channel : other->channel;
    problems.add("channels." + key_of(said_of),
                 fmt::format("got \"{}\", which is the name of channels.{}, too; both are of type "
                             "{}, so that nobody could tell them apart",
                             name, key_of(sharing), at->type));
  }
}

std::string_view ChannelNames::on_network(std::string_view channel) const {
  const auto found = names_.find(channel);
  return found == names_.end() ? channel : std::string_view{found->second};
}

bool ChannelNames::has_on_network(std::string_view name) const {
  return std::ranges::any_of(names_, [&](const auto& entry) { return entry.second == name; });
}

const std::string& ChannelNames::of_type(const std::vector<std::string>& candidates,
                                         std::int64_t fingerprint) {
  const auto found = std::ranges::find_if(candidates, [&](const std::string& channel) {
    return std::ranges::any_of(typed_channels(), [&](const TypedChannel& typed) {
      return typed.channel == channel && typed.fingerprint == fingerprint;
    });
  });
  return found == candidates.end() ? candidates.front() : *found;
}

}  // namespace waymark
