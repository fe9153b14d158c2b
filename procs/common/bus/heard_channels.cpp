// SPDX-License-Identifier: BSD-3-Clause
#include "common/bus/heard_channels.hpp"

#include <algorithm>
#include <cctype>

namespace waymark {

void note_heard(HeardChannels& heard, std::string_view name, HeardChannel::Time now) {
  constexpr std::size_t kMaxNames = 200;  // several times as many as a robot has
  auto found = heard.find(name);
  if (found == heard.end()) {
    const bool is_printable =
        std::ranges::all_of(name, [](unsigned char c) { return std::isgraph(c) != 0; });
    if (!is_printable || heard.size() >= kMaxNames) return;
    found = heard.emplace(name, HeardChannel{.first = now}).first;
  }
  found->second.last = now;
  ++found->second.count;
}

}  // namespace waymark
