// SPDX-License-Identifier: BSD-3-Clause
// What our channels are called on the network: section [channels] of every program.
#pragma once

#include "common/config/config.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// Nodes and logs know channels by Waymark's names; on the network each may have another one. Two
/// channels of the same type cannot share a name; of different types they can, as the fingerprint
/// of a message says which one it is on.
class ChannelNames {
 public:
  ChannelNames();

  void describe(Fields& fields);
  void check(Problems& problems) const;

  /// Whether the channel is on the network: not if it is ChannelUse::kNetworkOnceNamed and section
  /// [channels] does not name it.
  bool uses(std::string_view channel) const { return !on_network(channel).empty(); }

  /// @return the channel's name on the network, empty if it has none. Names that channels.hpp
  /// does not list, and those of channels in map files only, are returned as they are.
  std::string_view on_network(std::string_view channel) const;

  /// Whether any of our channels has that name on the network.
  bool has_on_network(std::string_view name) const;

  /// @param candidates  channels that share a name on the network.
  /// @return the one whose type has the fingerprint; the first one if none has, so that its handler
  /// rejects the message.
  static const std::string& of_type(const std::vector<std::string>& candidates,
                                    std::int64_t fingerprint);

 private:
  std::map<std::string, std::string, std::less<>> names_;  ///< Waymark's -> network's
};

}  // namespace waymark
