// SPDX-License-Identifier: BSD-3-Clause
// A process's side of the lockstep: collects a tick's messages, has them processed in order,
// acknowledges.
#pragma once

#include "common/lockstep/contents.hpp"
#include "common/node/node.hpp"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace waymark {

/// Pure: messages in, messages to publish out; no network, no clock.
///
/// A tick is processed when all messages on the wanted channels have come that its TICK names, and
/// those that the ACKs of the participants before this one in TICK's list name. Ticks are processed
/// in order. A re-sent tick is answered from a cache, so that the simulator repairs every loss by
/// re-sending.
class LockstepParticipant {
 public:
  /// Processes the messages of one tick, in order, and returns what it publishes for it.
  using Process = std::function<std::vector<Message>(const std::vector<Message>&, bool is_last)>;

  /// @param counters  counts rejected and repeated messages and those of other runs; must outlive
  ///                  this object.
  LockstepParticipant(std::string name, std::vector<std::string> wanted_channels, bool joins_midway,
                      Process process, Counters& counters);

  /// Handles a message of the network. @return what to publish now.
  /// @throws std::runtime_error when the run has begun and this process cannot join it, or begins
  ///                            again while this process is in the middle of it.
  std::vector<Message> handle(Message message);

  bool has_seen_tick() const { return run_id_.has_value(); }

  /// Ticks or acknowledgements of another run have come; they are ignored.
  bool has_heard_another_run() const { return has_heard_another_run_; }

  /// True when the last tick has been acknowledged; the simulator may re-send it until closed().
  bool finished() const { return finished_; }

  /// True when the simulator has received every last acknowledgement, or has stopped before.
  bool closed() const { return closed_; }

 private:
  struct OpenTick {
    std::optional<tick_t> tick{};
    std::map<std::string, ack_t> acks{};
  };

  std::vector<Message> handle_tick(const tick_t& tick);
  void handle_ack(const ack_t& ack);
  bool has_begun() const;
  std::vector<Message> answer_again(const tick_t& tick);
  bool is_of_this_run(std::int64_t run_id);
  void start_at(const tick_t& tick);
  std::vector<Message> advance();
  /// Hashes of the wanted messages of the tick, with repetitions; nullopt while an acknowledgement
  /// of an earlier participant is missing.
  std::optional<std::vector<std::int64_t>> needed_messages(const OpenTick& open) const;
  std::vector<Message> answer(const tick_t& tick, std::vector<Message> published);
  Message acknowledgement(const tick_t& tick, const std::vector<Message>& published) const;

  std::string name_;
  std::vector<std::string> wanted_channels_;
  bool joins_midway_;
  Process process_;
  Counters& counters_;

  std::optional<std::int64_t> run_id_;
  std::optional<std::int64_t> next_tick_;
  bool finished_{false};
  bool closed_{false};
  bool has_heard_another_run_{false};
  MessagePool pool_;
  std::map<std::int64_t, OpenTick> open_ticks_;
  std::map<std::int64_t, std::vector<Message>> answers_;  ///< to the newest ticks, for re-sending
  std::int64_t state_hash_{0};
};

}  // namespace waymark
