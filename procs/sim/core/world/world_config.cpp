// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/world/world_config.hpp"

namespace waymark {

void OpeningConfig::describe(Fields& fields) {
  fields.field("corridor", corridor, {0, 3}, "0 = the first; L has two, ring has four");
  fields.choice("side", side, {{"left", Side::kLeft}, {"right", Side::kRight}},
                "as seen along the corridor");
  fields.field("centre_m", centre_m, kNotNegative, "along the corridor");
  fields.field("width_m", width_m, {0.05, 100.0}, "of the hole in the wall");
  fields.field("depth_m", depth_m, {0.01, 100.0}, "of the recess, or of the room behind the wall");
  fields.field("room_width_m", room_width_m, {0.0, 100.0},
               "of the room behind the hole; 0 = no room, only a recess as wide as the hole");
}

void BoxConfig::describe(Fields& fields) {
  fields.field("x_m", x_m, kAnyNumber, "centre, world frame");
  fields.field("y_m", y_m, kAnyNumber, "centre, world frame");
  fields.field("yaw_deg", yaw_deg, {-360.0, 360.0}, "direction of its length");
  fields.field("length_m", length_m, {0.01, 100.0}, "of the box");
  fields.field("width_m", width_m, {0.01, 100.0}, "of the box");
  fields.field("height_m", height_m, {0.01, 20.0}, "it stands on the floor");
  present.describe(fields);
}

void WorldConfig::describe(Fields& fields) {
  fields.choice("layout", layout,
                {{"straight", Layout::kStraight}, {"L", Layout::kL}, {"ring", Layout::kRing}},
                "one corridor, two, or four around a block; every corner is a left turn");
  fields.field("length_m", length_m, {0.1, 1000.0}, "corridor length between the end walls");
  fields.field("second_length_m", second_length_m, {0.1, 1000.0},
               "of the corridors along y (L, ring)");
  fields.field("width_m", width_m, {0.1, 100.0}, "corridor width between the side walls");
  fields.field("wall_height_m", wall_height_m, {0.3, 20.0}, "height of walls and ceiling");
  fields.field("wall_thickness_m", wall_thickness_m, {0.01, 10.0}, "thickness of every wall");
  fields.list("openings", openings, "recesses and doorways in the side walls");
  fields.list("boxes", boxes, "furniture and people");
}

void MarkerMoveConfig::describe(Fields& fields) {
  fields.field("place", place, {0, 100000}, "number of the marker's place");
  when.describe(fields);
  fields.field("dx_m", dx_m, kAnyNumber, "by how much, world frame; it must stay on its wall");
  fields.field("dy_m", dy_m, kAnyNumber, "by how much, world frame");
}

void MarkerAddConfig::describe(Fields& fields) {
  fields.field("id", id, {0, 100000}, "of the marker");
  fields.field("x_m", x_m, kAnyNumber, "its centre, world frame; it hangs on the nearest wall");
  fields.field("y_m", y_m, kAnyNumber, "its centre, world frame");
}

void MarkerLayoutConfig::describe(Fields& fields) {
  fields.choice("layout", layout,
                {{"opposite", MarkerLayout::kOpposite},
                 {"staggered", MarkerLayout::kStaggered},
                 {"none", MarkerLayout::kNone}},
                "pairs facing each other, or the right wall's shifted by half the spacing");
  fields.field("first_m", first_m, kNotNegative, "first station of every corridor");
  fields.field("spacing_m", spacing_m, {0.1, 1000.0}, "from station to station");
  fields.field("last_m", last_m, kNotNegative, "no marker beyond this, in every corridor");
  fields.field("centre_height_m", centre_height_m, kPositive, "centre of the black square");
  fields.field("quiet_zone_modules", quiet_zone_modules, {0.0, 10.0},
               "white border around the black square, in marker modules");
  fields.field("blank", blank, "plain white plates: the same world without information");
  fields.field("first_id", first_id, {0, 100000}, "id of the first marker, the next have the next");
  fields.field("ids", ids, {0, 100000},
               "id of every place by corridor, station, left wall before right wall; one id = the "
               "same for all; [] = from first_id on");
  fields.field(
      "keep_every", keep_every, {1, 1000},
      "every so many-th marker of a wall hangs, on the right wall in the gaps of the left");
  fields.field("missing", missing, {0, 100000}, "numbers of places whose marker is gone");
  fields.field("missing_share", missing_share, kFraction, "so many are gone, drawn from the seed");
  fields.list("moved", moved, "markers that are hung elsewhere during the run");
  fields.list("added", added, "markers beside those of the layout, on any wall");
}

}  // namespace waymark
