// SPDX-License-Identifier: BSD-3-Clause
// Whose messages a channel carries: two publishers on it are told apart, not mixed.
#pragma once

#include "common/bus/datagram_receiver.hpp"

#include <chrono>
#include <deque>
#include <map>
#include <string>
#include <string_view>

namespace waymark {

/// A sensor has one driver, and a robot one stack: a channel belongs to the sender that was heard
/// first on it, as long as anything is heard of that sender; others are refused. Of two senders
/// that meet on several channels one has all of these, so that two drives are not mixed: the one
/// that owned the channel on which they met first. Who is right cannot be known from here; that
/// there are two can.
class ChannelOwners {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Our processes send a status every second, drivers much more.
  static constexpr std::chrono::milliseconds kSilence{2000};

  enum class Verdict {
    kAccepted,
    kSucceeds,  ///< accepted, in the place of another owner than before
    kRefused
  };

  /// Anything that a sender sends shows that it is there.
  void hear(const Sender& sender, Time now);

  Verdict check(std::string_view channel, const Sender& sender, Time now);

  /// Needs a channel that was checked.
  const Sender& owner_of(std::string_view channel) const;

 private:
  struct Owner {
    Sender sender{};
    Time heard{};
  };

  struct Precedence {
    Sender senior{};
    Sender junior{};
  };

  bool is_heard(const Sender& sender, Time now) const;
  bool precedes(const Sender& sender, const Sender& owner) const;
  void put_behind(const Sender& junior, const Sender& senior);

  // More than anybody runs at once; whatever is sent, no more is kept.
  static constexpr std::size_t kMaxPrecedences = 64;

  std::map<std::string, Owner, std::less<>> owners_{};  ///< by channel
  std::deque<Precedence> precedences_{};                ///< oldest first
};

}  // namespace waymark
