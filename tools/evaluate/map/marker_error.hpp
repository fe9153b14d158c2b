// SPDX-License-Identifier: BSD-3-Clause
// Estimated markers against the true ones.
#pragma once

#include "common/geometry/se2.hpp"
#include "evaluate/files/text_file.hpp"

#include <optional>
#include <vector>

namespace waymark::evaluate {

/// A marker, true (world frame) or estimated (map frame); its heading is the direction that it
/// faces.
struct Marker {
  int id{};
  Se2 parent_from_marker{};
  int instance{0};           ///< distinguishes markers of equal id
  bool has_moved{false};     ///< a true marker was moved; an estimated one has the state "moved"
  bool is_tentative{false};  ///< estimated marker with state "tentative"
};

/// Largest error of a marker that counts as right: half of its size.
inline constexpr double kRightMarker_m = 0.2;

struct MarkerError {
  std::size_t matched{};
  std::size_t missing{};    ///< true markers without an estimate
  std::size_t spurious{};   ///< estimates without a true marker
  std::size_t tentative{};  ///< tentative estimates, which are excluded from all other members
  double right_share{};     ///< pairs within kRightMarker_m / (matched + missing + spurious)
  std::optional<double> mean_position_m{};
  std::optional<double> max_position_m{};
  std::optional<double> mean_yaw_deg{};
  std::optional<double> max_yaw_deg{};
  /// Markers that were moved and are reported as moved / markers that were moved or are reported as
  /// moved; nullopt if there are none.
  std::optional<double> moved_named_share{};
};

/// Reads `id,instance,x_m,y_m,yaw_rad`, and `state` (as in marker_landmark_t) if it is there; more
/// columns may follow.
std::vector<Marker> read_markers(const std::filesystem::path& file, SkippedLines& skipped);

/// The markers at their final places.
/// @param file  `t_s,id,instance,x_m,y_m,yaw_rad`, in order of time.
std::vector<Marker> with_moves(std::vector<Marker> markers, const std::filesystem::path& file,
                               SkippedLines& skipped);

/// Pairs estimated and true markers of the same id greedily, nearest pairs first, none further than
/// `gate_m` apart; each marker is used once.
MarkerError marker_error(const std::vector<Marker>& estimated, const std::vector<Marker>& in_world,
                         const Se2& world_from_map, double gate_m);

}  // namespace waymark::evaluate
