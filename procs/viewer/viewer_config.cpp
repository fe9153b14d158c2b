// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/viewer_config.hpp"

namespace waymark {

void ViewerSection::describe(Fields& fields) {
  fields.field("title", title, "heading of map.png, in ASCII; empty = name of the output folder");
  fields.field("write_period_s", write_period_s, {0.1, 3600.0},
               "message time between writes of map, trajectory, markers, and one of the pictures");
  fields.field("max_write_share", max_write_share, {0.001, 1.0},
               "of the wall-clock time that these writes may take; what is due more often waits, "
               "the end is always written");
  fields.field("occupied_threshold", map_page.thresholds.occupied, kFraction,
               "occupancy from which on a cell is written as occupied");
  fields.field("free_threshold", map_page.thresholds.free, kFraction,
               "occupancy up to which a cell is written as free");
  fields.field("scan_size_px", scan_size_px, {200, 4000}, "side of scan.png");
  fields.field("page_width_px", map_page.page_width_px, {800, 8000}, "width of map.png");
  fields.field("page_height_px", map_page.page_height_px, {400, 8000},
               "height that map.png may take for the map");
  fields.field("max_strips", map_page.max_strips, {1, 20},
               "a long map is folded into up to this many strips");
  fields.field("max_scale_px_per_m", map_page.max_scale_px_per_m, {10.0, 2000.0},
               "map.png: no larger than this");
  fields.field("mark_spacing_px", map_page.mark_spacing_px, {20, 2000},
               "map.png: least distance along the path between ellipses and between weak axes");
  fields.field("marker_size_m", map_page.marker_size_m, {0.01, 5.0},
               "map.png: length of a marker's plate");
}

void ViewerConfig::describe(Fields& fields) {
  fields.section("viewer", viewer);
}

}  // namespace waymark
