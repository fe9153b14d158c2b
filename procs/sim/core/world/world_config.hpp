// SPDX-License-Identifier: BSD-3-Clause
// The world as a scenario describes it.
#pragma once

#include "common/config/config.hpp"
#include "sim/core/span.hpp"

#include <vector>

namespace waymark {

/// straight: one corridor with end walls. L: a second one to the left at its end. ring: four
/// corridors around a block, each to the left of the one before.
enum class Layout { kStraight, kL, kRing };

enum class Side { kLeft, kRight };

/// A hole in a corridor's wall: a recess (door frame, niche, side corridor), or, with a room width,
/// the doorway of a room behind the wall.
struct OpeningConfig {
  int corridor{0};
  Side side{Side::kLeft};
  double centre_m{10.0};
  double width_m{0.9};
  double depth_m{0.1};
  double room_width_m{0.0};

  void describe(Fields& fields);
};

/// Furniture or a person: a solid box, visible to LiDAR and camera, for a time or always.
struct BoxConfig {
  double x_m{10.0};
  double y_m{0.0};
  double yaw_deg{0.0};
  double length_m{0.5};
  double width_m{0.5};
  double height_m{1.7};
  Span present{};

  void describe(Fields& fields);
};

/// Corridors; lengths are between inner faces. Corridor 0 begins at x = 0 and runs along +x.
struct WorldConfig {
  Layout layout{Layout::kStraight};
  double length_m{50.0};
  double second_length_m{50.0};
  double width_m{2.0};
  double wall_height_m{2.4};
  double wall_thickness_m{0.1};
  std::vector<OpeningConfig> openings{};
  std::vector<BoxConfig> boxes{};

  void describe(Fields& fields);
};

enum class MarkerLayout { kOpposite, kStaggered, kNone };

/// A marker that is moved along its wall during the run.
struct MarkerMoveConfig {
  int place{0};
  Trigger when{};
  double dx_m{0.0};
  double dy_m{0.0};

  void describe(Fields& fields);
};

/// A marker in addition to the layout, on any wall.
struct MarkerAddConfig {
  int id{0};
  double x_m{0.0};
  double y_m{0.0};

  void describe(Fields& fields);
};

/// Where the markers hang; what they look like is in RobotConfig. Places are numbered by corridor,
/// station, left wall before right wall; a missing marker leaves its number and id unused.
struct MarkerLayoutConfig {
  MarkerLayout layout{MarkerLayout::kOpposite};
  double first_m{4.0};
  double spacing_m{4.0};
  double last_m{48.0};
  double centre_height_m{0.3};
  double quiet_zone_modules{2.0};  ///< with 1, OpenCV 4.6 may detect the plate, not the marker
  bool blank{false};
  int first_id{0};
  std::vector<int> ids{};
  int keep_every{1};
  std::vector<int> missing{};
  double missing_share{0.0};
  std::vector<MarkerMoveConfig> moved{};
  std::vector<MarkerAddConfig> added{};

  void describe(Fields& fields);
};

}  // namespace waymark
