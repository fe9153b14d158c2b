// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/scene/scene.hpp"

#include <algorithm>

namespace waymark::viewer {

bool AnnotatedScan::has_marker() const {
  return std::any_of(marker_ids.begin(), marker_ids.end(), [](int id) { return id != kNoMarker; });
}

std::string_view name_of(LandmarkState state) {
  switch (state) {
    case LandmarkState::kConfirmed:
      return "confirmed";
    case LandmarkState::kTentative:
      return "tentative";
    case LandmarkState::kMoved:
      return "moved";
    case LandmarkState::kUnknown:
      break;
  }
  return "unknown";
}

}  // namespace waymark::viewer
