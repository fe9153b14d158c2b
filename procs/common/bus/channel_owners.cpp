// SPDX-License-Identifier: BSD-3-Clause
#include "common/bus/channel_owners.hpp"

#include <algorithm>

namespace waymark {

void ChannelOwners::note_activity(const Sender& sender, Time now) {
  for (auto& [channel, owner] : owners_)
    if (owner.sender == sender) owner.last_active = now;
}

ChannelOwners::Verdict ChannelOwners::check(std::string_view channel, const Sender& sender,
                                            Time now) {
  const auto [found, is_first] = owners_.try_emplace(std::string{channel}, Owner{sender, now});
  Owner& owner = found->second;
  if (owner.sender == sender) {
    owner.last_active = now;
    return Verdict::kAccepted;
  }
  if (is_active(owner.sender, now) && !precedes(sender, owner.sender)) {
    put_behind(sender, owner.sender);
    return Verdict::kRefused;
  }
  owner = {sender, now};
  return Verdict::kNewOwner;
}

const Sender& ChannelOwners::owner_of(std::string_view channel) const {
  return owners_.find(channel)->second.sender;
}

bool ChannelOwners::is_active(const Sender& sender, Time now) const {
  return std::ranges::any_of(owners_, [&](const auto& owned) {
    return owned.second.sender == sender && now - owned.second.last_active <= kSilence;
  });
}

bool ChannelOwners::precedes(const Sender& sender, const Sender& owner) const {
  return std::ranges::any_of(precedences_, [&](const Precedence& precedence) {
    return precedence.senior == sender && precedence.junior == owner;
  });
}

void ChannelOwners::put_behind(const Sender& junior, const Sender& senior) {
  if (precedes(senior, junior)) return;
  precedences_.push_back({senior, junior});
  if (precedences_.size() > kMaxPrecedences) precedences_.pop_front();
}

}  // namespace waymark
