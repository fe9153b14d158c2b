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

  /// False for a channel that is only used where it has been given a name.
  bool uses(std::string_view channel) const { return !on_network(channel).empty(); }

  /// @param channel  one of channels.hpp, or any other, which keeps its name.
  std::string_view on_network(std::string_view channel) const;

  /// The one of `candidates`, which all have the same name on the network, that a message of that
  /// type is on; the first one when it is on none of them, to be refused there.
  static const std::string& of_type(const std::vector<std::string>& candidates,
                                    std::int64_t fingerprint);

 private:
  std::map<std::string, std::string, std::less<>> names_;  ///< ours -> the network's
};

}  // namespace waymark
