// SPDX-License-Identifier: BSD-3-Clause
// The simulator's side of the lockstep: sends ticks, with a small window of them in flight, and
// waits until every participant has acknowledged each.
#pragma once

#include "common/lockstep/contents.hpp"

#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace waymark {

/// Pure: messages in, messages to publish out; the caller owns network and clock.
class LockstepMaster {
 public:
  LockstepMaster(std::int64_t run_id, std::vector<std::string> participants, int window_ticks);

  /// A TICK that asks the participants to report, to be repeated until all_ready().
  Message probe() const;

  bool all_ready() const { return ready_.size() == participants_.size(); }

  std::vector<std::string> not_ready() const;

  /// True when another tick may be opened.
  bool has_room() const { return std::ssize(open_ticks_) < window_ticks_; }

  bool all_acknowledged() const { return open_ticks_.empty(); }

  /// Opens a tick. @return its messages, followed by the TICK.
  std::vector<Message> open_tick(Timestamp end, std::vector<Message> messages, bool is_last);
  /// @return true when the message is an acknowledgement that was still missing.
  bool handle(const Message& message);
  /// Messages and TICKs of all open ticks, to be sent again.
  std::vector<Message> resend() const;
  /// Participants that have not acknowledged the oldest open tick, in their order. Each waits for
  /// those before it: the first one is the cause, the others may only be waiting for it.
  std::vector<std::string> silent() const;
  std::int64_t oldest_open_tick() const;
  /// The TICK that ends the run: after the last acknowledgement, or where the simulator stops.
  Message closing() const;

  /// Hash of all messages that each participant has published.
  const std::map<std::string, std::int64_t>& state_hashes() const { return state_hashes_; }

 private:
  struct OpenTick {
    tick_t tick{};
    std::vector<Message> messages{};
    std::set<std::string> missing{};  ///< participants that have not acknowledged it
  };

  Message special_tick(std::int64_t tick) const;
  void append(const OpenTick& open, std::vector<Message>& messages) const;

  std::int64_t run_id_;
  std::vector<std::string> participants_;
  int window_ticks_;
  std::int64_t next_tick_{0};
  Timestamp last_end_{};
  std::set<std::string> ready_;
  std::deque<OpenTick> open_ticks_;
  std::map<std::string, std::int64_t> state_hashes_;
};

}  // namespace waymark
