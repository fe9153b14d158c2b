// SPDX-License-Identifier: BSD-3-Clause
#include "common/lockstep/master.hpp"

#include "common/messages/codec.hpp"

#include <algorithm>

namespace waymark {

LockstepMaster::LockstepMaster(std::int64_t run_id, std::vector<std::string> participants,
                               int window_ticks)
    : run_id_{run_id}, participants_{std::move(participants)}, window_ticks_{window_ticks} {}

Message LockstepMaster::probe() const {
  return special_tick(tick_t::TICK_PROBE);
}

Message LockstepMaster::closing() const {
  return special_tick(tick_t::TICK_CLOSED);
}

std::vector<std::string> LockstepMaster::not_ready() const {
  std::vector<std::string> names;
  std::ranges::copy_if(participants_, std::back_inserter(names),
                       [this](const std::string& name) { return !ready_.contains(name); });
  return names;
}

std::vector<Message> LockstepMaster::open_tick(Timestamp end, std::vector<Message> messages,
                                               bool is_last) {
  tick_t tick{};
  tick.utime = to_us(end);
  tick.run_id = run_id_;
  tick.tick = next_tick_++;
  tick.is_last = is_last ? 1 : 0;
  tick.participants = participants_;
  tick.num_participants = static_cast<int>(participants_.size());
  tick.channels = contents_of(messages);
  tick.num_channels = static_cast<int>(tick.channels.size());
  last_end_ = end;
  open_ticks_.push_back({tick, std::move(messages), {participants_.begin(), participants_.end()}});
  std::vector<Message> to_send;
  append(open_ticks_.back(), to_send);
  if (participants_.empty()) open_ticks_.pop_back();
  return to_send;
}

bool LockstepMaster::handle(const Message& message) {
  const auto ack = decode<ack_t>(message.payload);
  if (!ack.message || ack.message->run_id != run_id_) return false;
  const std::string& who = ack.message->who;
  if (ack.message->tick == tick_t::TICK_PROBE) {
    return std::ranges::find(participants_, who) != participants_.end() &&
           ready_.insert(who).second;
  }
  const auto open = std::ranges::find_if(
      open_ticks_, [&ack](const OpenTick& o) { return o.tick.tick == ack.message->tick; });
  if (open == open_ticks_.end() || open->missing.erase(who) == 0) return false;
  state_hashes_[who] = ack.message->state_hash;
  while (!open_ticks_.empty() && open_ticks_.front().missing.empty())
    open_ticks_.pop_front();
  return true;
}

std::vector<Message> LockstepMaster::resend() const {
  std::vector<Message> messages;
  for (const OpenTick& open : open_ticks_)
    append(open, messages);
  return messages;
}

/// Appends the tick's messages, then its TICK, whose first_open_tick tells a restarted process
/// where to begin.
void LockstepMaster::append(const OpenTick& open, std::vector<Message>& messages) const {
  messages.insert(messages.end(), open.messages.begin(), open.messages.end());
  tick_t tick = open.tick;
  tick.first_open_tick = oldest_open_tick();
  messages.push_back(encode(channels::kTick, tick));
}

std::vector<std::string> LockstepMaster::silent() const {
  std::vector<std::string> names;
  if (open_ticks_.empty()) return names;
  const auto& missing = open_ticks_.front().missing;
  std::ranges::copy_if(participants_, std::back_inserter(names),
                       [&missing](const std::string& name) { return missing.contains(name); });
  return names;
}

std::int64_t LockstepMaster::oldest_open_tick() const {
  return open_ticks_.empty() ? next_tick_ : open_ticks_.front().tick.tick;
}

Message LockstepMaster::special_tick(std::int64_t tick_number) const {
  tick_t tick{};
  tick.utime = to_us(last_end_);
  tick.run_id = run_id_;
  tick.tick = tick_number;
  tick.participants = participants_;
  tick.num_participants = static_cast<int>(participants_.size());
  return encode(channels::kTick, tick);
}

}  // namespace waymark
