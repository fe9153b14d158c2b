// SPDX-License-Identifier: BSD-3-Clause
// Estimated markers against the true ones.
#pragma once

#include "common/geometry/se2.hpp"
#include "evaluate/files/text_file.hpp"

#include <optional>
#include <vector>

namespace waymark::evaluate {

/// Centre of a marker and the direction that it faces, in the map or in the world.
struct Marker {
  int id{};
  Se2 parent_from_marker{};
  int instance{0};           ///< distinguishes markers of equal id
  bool has_moved{false};     ///< true: it was moved; estimated: it is said to have been
  bool is_tentative{false};  ///< estimated: the map does not vouch for it
};

/// A marker that is mapped further from its true place is not right: half its size.
inline constexpr double kRightMarker_m = 0.2;

struct MarkerError {
  std::size_t matched{};
  std::size_t missing{};    ///< true markers without an estimate
  std::size_t spurious{};   ///< estimates without a true marker
  std::size_t tentative{};  ///< estimates that the map does not vouch for: left out of all the rest
  double right_share{};     ///< of all, true and estimated, those matched within kRightMarker_m
  std::optional<double> mean_position_m{};
  std::optional<double> max_position_m{};
  std::optional<double> mean_yaw_deg{};
  std::optional<double> max_yaw_deg{};
  /// Of the markers that were moved or are said to be: those that are both. Absent if there are
  /// none.
  std::optional<double> moved_named_share{};
};

/// Reads `id,instance,x_m,y_m,yaw_rad`, and `state` (as in marker_landmark_t) if it is there; more
/// columns may follow.
std::vector<Marker> read_markers(const std::filesystem::path& file, Skipped& skipped);

/// The same markers where they are in the end. `file`: `t_s,id,instance,x_m,y_m,yaw_rad`, in order
/// of time.
std::vector<Marker> with_moves(std::vector<Marker> markers, const std::filesystem::path& file,
                               Skipped& skipped);

/// Pairs markers of the same id, nearest pairs first, each marker once, none further than `gate_m`
/// apart: so duplicates of an id find their own places.
MarkerError marker_error(const std::vector<Marker>& estimated, const std::vector<Marker>& in_world,
                         const Se2& world_from_map, double gate_m);

}  // namespace waymark::evaluate
