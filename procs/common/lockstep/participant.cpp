// SPDX-License-Identifier: BSD-3-Clause
#include "common/lockstep/participant.hpp"

#include <algorithm>
#include <stdexcept>

namespace waymark {
namespace {

// Wider than any window of ticks in flight: ticks beyond it are invalid.
constexpr std::int64_t kHorizon_ticks = 2 * kMaxWindowTicks;

}  // namespace

LockstepParticipant::LockstepParticipant(std::string name, std::vector<std::string> wanted_channels,
                                         bool joins_midway, Process process, Counters& counters)
    : name_{std::move(name)},
      wanted_channels_{std::move(wanted_channels)},
      joins_midway_{joins_midway},
      process_{std::move(process)},
      counters_{counters} {}

std::vector<Message> LockstepParticipant::handle(Message message) {
  if (message.channel == channels::kTick.name) {
    const auto tick = decode<tick_t>(message.payload);
    if (tick.message) return handle_tick(*tick.message);
    counters_.add("TICK rejected: " + std::string{to_string(tick.reason)}, CountKind::kRejection);
    return {};
  }
  if (message.channel == channels::kAck.name) {
    const auto ack = decode<ack_t>(message.payload);
    if (!ack.message) {
      counters_.add("ACK rejected: " + std::string{to_string(ack.reason)}, CountKind::kRejection);
      return {};
    }
    handle_ack(*ack.message);
  } else if (std::ranges::find(wanted_channels_, message.channel) != wanted_channels_.end()) {
    const std::string channel = message.channel;
    if (!pool_.add(std::move(message))) counters_.add(channel + " duplicates");
  }
  return advance();
}

std::vector<Message> LockstepParticipant::handle_tick(const tick_t& tick) {
  const bool is_probe = tick.tick == tick_t::TICK_PROBE;
  if (tick.tick == tick_t::TICK_CLOSED) {
    if (run_id_ && is_of_this_run(tick.run_id)) closed_ = true;
    return {};
  }
  if (!run_id_ || (is_probe && !has_begun())) run_id_ = tick.run_id;
  if (!is_of_this_run(tick.run_id)) return {};
  if (is_probe) {
    if (!next_tick_) next_tick_ = 0;
    return {acknowledgement(tick, {})};
  }
  if (!next_tick_) start_at(tick);
  if (tick.tick < *next_tick_) return answer_again(tick);
  if (tick.tick > *next_tick_ + kHorizon_ticks) {
    counters_.add("TICK rejected: out of order", CountKind::kRejection);
    return {};
  }
  open_ticks_[tick.tick].tick = tick;
  return advance();
}

/// A simulator re-sends only ticks whose answers are still kept here. An older tick 0 comes from
/// another simulator that has started the same run again.
std::vector<Message> LockstepParticipant::answer_again(const tick_t& tick) {
  counters_.add("TICK duplicates");
  const auto cached = answers_.find(tick.tick);
  if (cached != answers_.end()) return cached->second;
  if (tick.tick == 0 && !finished_) {
    throw std::runtime_error{"the run has begun again, but " + name_ + " has done " +
                             std::to_string(*next_tick_) +
                             " ticks of it already: start it again, too"};
  }
  return {};
}

/// A process that has not begun may take part in any run.
bool LockstepParticipant::has_begun() const {
  return next_tick_.value_or(0) > 0 || !open_ticks_.empty();
}

void LockstepParticipant::handle_ack(const ack_t& ack) {
  if (!run_id_ || !is_of_this_run(ack.run_id) || ack.tick < 0) return;
  const std::int64_t next = next_tick_.value_or(0);
  if (ack.tick < next || ack.tick > next + kHorizon_ticks) return;
  open_ticks_[ack.tick].acks.insert_or_assign(ack.who, ack);
}

bool LockstepParticipant::is_of_this_run(std::int64_t run_id) {
  if (run_id == run_id_) return true;
  has_heard_another_run_ = true;
  counters_.add("TICK or ACK of another run");
  return false;
}

void LockstepParticipant::start_at(const tick_t& tick) {
  if (tick.first_open_tick > 0 && !joins_midway_) {
    throw std::runtime_error{name_ + " cannot join a run at tick " +
                             std::to_string(tick.first_open_tick) +
                             ": what it had learned is lost; start the run again"};
  }
  next_tick_ = tick.first_open_tick;
  std::erase_if(open_ticks_, [this](const auto& open) { return open.first < *next_tick_; });
}

std::vector<Message> LockstepParticipant::advance() {
  std::vector<Message> to_publish;
  while (next_tick_ && !finished_) {
    const auto open = open_ticks_.find(*next_tick_);
    if (open == open_ticks_.end() || !open->second.tick) break;
    const auto needed = needed_messages(open->second);
    if (!needed || !std::ranges::all_of(*needed, [this](auto hash) { return pool_.has(hash); })) {
      break;
    }
    std::vector<Message> messages = pool_.use(*needed);
    std::ranges::sort(messages, comes_before);
    const tick_t tick = *open->second.tick;
    open_ticks_.erase(open);
    ++*next_tick_;
    finished_ = tick.is_last != 0;
    std::ranges::move(answer(tick, process_(messages, finished_)), std::back_inserter(to_publish));
  }
  return to_publish;
}

std::optional<std::vector<std::int64_t>> LockstepParticipant::needed_messages(
    const OpenTick& open) const {
  std::vector<std::int64_t> hashes;
  const auto add_wanted = [&](const std::vector<channel_content_t>& contents) {
    for (const channel_content_t& content : contents) {
      if (std::ranges::find(wanted_channels_, content.channel) == wanted_channels_.end()) continue;
      hashes.insert(hashes.end(), content.hashes.begin(), content.hashes.end());
    }
  };
  add_wanted(open.tick->channels);
  for (const std::string& earlier : open.tick->participants) {
    if (earlier == name_) break;
    const auto ack = open.acks.find(earlier);
    if (ack == open.acks.end()) return std::nullopt;
    add_wanted(ack->second.channels);
  }
  return hashes;
}

/// The published messages with the acknowledgement behind them, also kept for re-sent ticks.
std::vector<Message> LockstepParticipant::answer(const tick_t& tick,
                                                 std::vector<Message> published) {
  for (const Message& message : published) {
    state_hash_ = content_hash({message.channel, {}, message.payload}) ^
                  static_cast<std::int64_t>(static_cast<std::uint64_t>(state_hash_) * 31);
  }
  published.push_back(acknowledgement(tick, published));
  answers_[tick.tick] = published;
  if (std::ssize(answers_) > kMaxWindowTicks) answers_.erase(answers_.begin());
  return published;
}

Message LockstepParticipant::acknowledgement(const tick_t& tick,
                                             const std::vector<Message>& published) const {
  ack_t ack{};
  ack.utime = tick.utime;
  ack.run_id = tick.run_id;
  ack.tick = tick.tick;
  ack.who = name_;
  ack.state_hash = state_hash_;
  ack.channels = contents_of(published);
  ack.num_channels = static_cast<int>(ack.channels.size());
  return encode(channels::kAck, ack);
}

}  // namespace waymark
