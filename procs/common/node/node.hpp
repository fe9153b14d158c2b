// SPDX-License-Identifier: BSD-3-Clause
// A process without its source of messages: a node takes messages in order from an Inbox and puts
// messages into an Outbox. The same node runs live in lockstep, in real time, and on a log.
#pragma once

#include "common/errors/setup_error.hpp"
#include "common/messages/codec.hpp"
#include "common/node/counters.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// Name of the counter of valid messages on a channel.
std::string received_on(std::string_view channel);

/// What to do in real time when messages come faster than they are processed.
enum class Backlog { kKeepAll, kNewestOnly };

/// Decodes messages and hands them to the node's typed handlers. Several types may share a channel
/// name; the fingerprint distinguishes them. What cannot be decoded is counted as "CHANNEL
/// rejected: reason".
class Inbox {
 public:
  struct Subscription {
    std::string channel{};
    Backlog backlog{Backlog::kKeepAll};
  };

  template <class Type>
  void on(Channel<Type> channel, std::function<void(const Type&)> handler,
          Backlog backlog = Backlog::kKeepAll) {
    add_handler(channel.name, Type::getHash(), backlog,
                [handler = std::move(handler)](const Message& message) {
                  const Decoded<Type> decoded = decode<Type>(message.payload);
                  if (decoded.message) handler(*decoded.message);
                  return decoded.reason;
                });
  }

  /// Hands every message on the channel to `handler`, undecoded (used by the recorder).
  void on_raw(std::string_view channel, std::function<void(const Message&)> handler);

  void deliver(const Message& message);
  std::vector<Subscription> subscriptions() const;

  Counters& counters() { return counters_; }

 private:
  using Handler = std::function<RejectReason(const Message&)>;

  struct ChannelHandlers {
    Backlog backlog{Backlog::kKeepAll};
    std::map<std::int64_t, Handler> by_fingerprint{};
    std::function<void(const Message&)> raw{};
  };

  void add_handler(std::string_view channel, std::int64_t fingerprint, Backlog backlog,
                   Handler handler);

  std::map<std::string, ChannelHandlers, std::less<>> channels_;
  Counters counters_;
};

/// Collects what a node publishes, for the runner to send or write.
class Outbox {
 public:
  template <class Type>
  void publish(Channel<Type> channel, const Type& message) {
    add(encode(channel, message));
  }

  std::vector<Message> take();

 private:
  void add(Message message);

  std::vector<Message> messages_;
};

/// The wall clock, and the network by it, as a node sees them in real time.
struct WallClock {
  std::chrono::steady_clock::time_point now{};
  /// Seconds since the last message on a channel; nullopt if none has come, or none is heard.
  std::function<std::optional<double>(std::string_view channel)> silence_s{};
};

/// Base of DetectorNode, SlamNode, ViewerNode, RecorderNode. A node type also has
///   using Config = ...;                               a described configuration struct
///   static constexpr ProcessTraits kTraits{...};
///   Node(const Config&, Inbox&, Outbox&);             registers its handlers; throws SetupError
/// A handler that throws ends the run: the error is logged, finish() is called, and the exit code
/// is kExitFailed.
class Node {
 public:
  virtual ~Node() = default;
  /// The input has ended: publish or write what is left.
  virtual void finish() = 0;

  /// Is called a few times a second in real time only, also while no message comes. Results must
  /// not depend on it.
  virtual void poll(const WallClock& /*clock*/) {}

  /// True when some output could not be produced, e.g. a file not written. The node logs it when it
  /// happens; the exit code at the end is kExitFailed.
  virtual bool failed() const { return false; }

  /// Channels that this process needs: each must be in at least one of the logs of a replay, and in
  /// real time one that is silent is named.
  virtual std::vector<std::string_view> needed_channels() const { return {}; }
};

struct ProcessTraits {
  std::string_view name;     ///< "slam": name in ACKs, statuses and logs
  std::string_view purpose;  ///< one sentence for --help
  bool joins_midway;         ///< can be restarted during a lockstep run
};

}  // namespace waymark
