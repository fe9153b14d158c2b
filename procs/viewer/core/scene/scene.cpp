// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/scene/scene.hpp"

#include <algorithm>

namespace waymark::viewer {

bool AnnotatedScan::has_marker() const {
  return std::any_of(marker_ids.begin(), marker_ids.end(), [](int id) { return id != kNoMarker; });
}

}  // namespace waymark::viewer
