// SPDX-License-Identifier: BSD-3-Clause
// Views -> JSON and tiles for the page.
#pragma once

#include "viewer/http/view_store.hpp"

#include <span>
#include <string>

namespace waymark::viewer {

/// One JSON object, without the path and the map's cells. Numbers that are not finite become null.
std::string view_json(const LiveView& view, const ViewStore::Span& history);

/// Adds the path's new points to a view's JSON.
/// @param first  number of points that the client already has.
std::string with_path(std::string view_json, std::size_t first,
                      std::span<const PathPoint> path_growth);

/// Tiles newer than a version, little-endian: u32 generation, version, side [cells], number of
/// tiles; f64 origin x, y, resolution [m]; for each tile i32 x, y and its cells (one byte each:
/// occupancy [%], 255 = unknown).
std::string tile_bytes(const LiveMap& map, std::uint32_t since_version);

}  // namespace waymark::viewer
