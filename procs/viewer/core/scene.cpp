// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/scene.hpp"

#include <algorithm>

namespace waymark::viewer {

std::string_view to_string(Health health) {
  switch (health) {
    case Health::kInitialising:
      return "initialising";
    case Health::kTracking:
      return "tracking";
    case Health::kDegenerate:
      return "degenerate";
    case Health::kLost:
      return "lost";
    case Health::kUnknown:
      break;
  }
  return "unknown";
}

bool AnnotatedScan::has_marker() const {
  return std::any_of(marker_ids.begin(), marker_ids.end(), [](int id) { return id != kNoMarker; });
}

}  // namespace waymark::viewer
