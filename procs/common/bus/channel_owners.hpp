// SPDX-License-Identifier: BSD-3-Clause
// Accepts one publisher per channel.
#pragma once

#include "common/bus/datagram_receiver.hpp"

#include <chrono>
#include <deque>
#include <map>
#include <string>
#include <string_view>

namespace waymark {

/// A channel belongs to the first sender on it while that sender is active on any channel; other
/// senders are refused. Where two senders publish on the same channels, the one that owned the
/// first contested channel gets all of them, so that data of two robots are never mixed. Nothing
/// here shows which of the two is the right one.
class ChannelOwners {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Time without a message after which a sender is inactive. Our processes send a status every
  /// second, drivers more often.
  static constexpr std::chrono::milliseconds kSilence{2000};

  enum class Verdict {
    kAccepted,
    kNewOwner,  ///< accepted; the channel belonged to another sender before
    kRefused
  };

  /// To be called for every message, also on channels for which check() is not called.
  void note_activity(const Sender& sender, Time now);

  Verdict check(std::string_view channel, const Sender& sender, Time now);

  /// @param channel  one for which check() has been called.
  const Sender& owner_of(std::string_view channel) const;

 private:
  struct Owner {
    Sender sender{};
    Time last_active{};
  };

  struct Precedence {
    Sender senior{};
    Sender junior{};
  };

  bool is_active(const Sender& sender, Time now) const;
  bool precedes(const Sender& sender, const Sender& owner) const;
  void put_behind(const Sender& junior, const Sender& senior);

  // More pairs of rival senders than ever run at once; bounds the memory that forged senders take.
  static constexpr std::size_t kMaxPrecedences = 64;

  std::map<std::string, Owner, std::less<>> owners_{};  ///< by channel
  std::deque<Precedence> precedences_{};                ///< oldest first
};

}  // namespace waymark
