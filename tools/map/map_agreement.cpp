// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_agreement.hpp"

#include "common/geometry/chi2.hpp"
#include "slam/core/grid/occupied_points.hpp"
#include "slam/core/localisation/map_fit.hpp"

#include <Eigen/LU>
#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace waymark {
namespace {

/// Sigma of a marker's place in each map that its covariance leaves out: walls that are not quite
/// straight, and frames that bend where the merge is rigid.
constexpr double kDrift_m = 0.03;
constexpr double kMaxApart_m = 0.3;  // farther apart, a rigid merge would double the walls
constexpr double kBeside_m = 0.15;   // farthest of a wall from itself in the other map: the drift
constexpr std::size_t kMinWallCells = 40;  // 2 m of walls of 0.05 m; fewer may be a person
/// Share of a map's walls in the other map's free space: furniture and doors change on a day, but
/// of a corridor that is wider by a metre, half of the walls stand in the free space.
constexpr double kMaxContradicting = MapFit::kMaxCrossing;
constexpr std::size_t kMaxNamed = 12;  // markers that fit in a sentence

/// By id, the confirmed landmark; nullptr if there is more than one.
std::map<int, const Landmark*> unique_landmarks(const MapSnapshot& map) {
  std::map<int, const Landmark*> unique;
  for (const Landmark& landmark : map.landmarks) {
    if (!landmark.is_confirmed()) continue;
    const auto [at, is_new] = unique.try_emplace(landmark.id, &landmark);
    if (!is_new) at->second = nullptr;
  }
  return unique;
}

enum class Cover { kUnknown, kFree, kWall };

/// A wall within kBeside_m counts; free is only what is free all around.
Cover cover_at(const GridMap& map, const Eigen::Vector2d& point) {
  const CellIndex centre = map.frame.cell_of(point);
  const int reach = static_cast<int>(kBeside_m / map.frame.resolution_m);
  bool is_free = true;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      const OccupancyCell& cell = map.occupancy[CellIndex{centre.x + x, centre.y + y}];
      if (cell.occupancy() > kWallOccupancy) return Cover::kWall;
      is_free = is_free && cell.is_mapped() && cell.occupancy() < kFreeOccupancy;
    }
  }
  return is_free ? Cover::kFree : Cover::kUnknown;
}

}  // namespace

double SharedMarker::apart_m(const Se2& a_from_b) const {
  return (a_from_b * in_b - in_a).norm();
}

bool SharedMarker::agrees(const Se2& a_from_b) const {
  const Eigen::Matrix2d rotation = a_from_b.rotation();
  const Eigen::Matrix2d covariance = covariance_a + rotation * covariance_b * rotation.transpose() +
                                     2.0 * kDrift_m * kDrift_m * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d off = a_from_b * in_b - in_a;
  return off.norm() < kMaxApart_m && off.dot(covariance.inverse() * off) < kChi2Gate2;
}

std::vector<SharedMarker> shared_markers(const MapSnapshot& a, const MapSnapshot& b) {
  const auto unique_in_a = unique_landmarks(a);
  const auto unique_in_b = unique_landmarks(b);
  std::vector<SharedMarker> shared;
  for (const Landmark& landmark : a.landmarks) {
    const auto in_a = unique_in_a.find(landmark.id);
    const auto in_b = unique_in_b.find(landmark.id);
    if (in_a == unique_in_a.end() || in_a->second != &landmark) continue;
    if (in_b == unique_in_b.end() || in_b->second == nullptr) continue;
    shared.push_back({landmark.id, landmark.map_from_marker.translation(),
                      in_b->second->map_from_marker.translation(),
                      landmark.covariance.topLeftCorner<2, 2>(),
                      in_b->second->covariance.topLeftCorner<2, 2>()});
  }
  return shared;
}

double WallAgreement::contradicting_share() const {
  if (agreeing + contradicting < kMinWallCells) return 0.0;
  return static_cast<double>(contradicting) / static_cast<double>(agreeing + contradicting);
}

WallAgreement walls_in(const GridMap& a, const GridMap& b, const Se2& a_from_b) {
  WallAgreement agreement;
  for (const Eigen::Vector2d& wall : occupied_points(b)) {
    const Cover cover = cover_at(a, a_from_b * wall);
    if (cover == Cover::kWall) ++agreement.agreeing;
    if (cover == Cover::kFree) ++agreement.contradicting;
  }
  return agreement;
}

MapAgreement agreement_of(const MapSnapshot& a, const MapSnapshot& b, const Se2& a_from_b) {
  MapAgreement agreement;
  agreement.a_from_b = a_from_b;
  for (const SharedMarker& marker : shared_markers(a, b)) {
    ++agreement.shared;
    if (!marker.agrees(a_from_b)) agreement.disagreeing.push_back(marker);
  }
  // A narrow corridor in a wide one contradicts only in one direction: outside, nothing is known.
  agreement.contradicting_walls =
      std::max(walls_in(a.grid, b.grid, a_from_b).contradicting_share(),
               walls_in(b.grid, a.grid, a_from_b.inverse()).contradicting_share());
  return agreement;
}

std::string MapAgreement::markers_text() const {
  std::string text =
      fmt::format("{} of {} shared marker{} agree", agreeing(), shared, shared == 1 ? "" : "s");
  for (std::size_t i = 0; i < std::min(kMaxNamed, disagreeing.size()); ++i)
    text += fmt::format("{} {} ({:.2f} m apart)", i == 0 ? "; not" : ",", disagreeing[i].id,
                        disagreeing[i].apart_m(a_from_b));
  if (disagreeing.size() > kMaxNamed)
    text += fmt::format(" and {} more", disagreeing.size() - kMaxNamed);
  return text;
}

std::string MapAgreement::objection() const {
  if (shared > 0 && 2 * agreeing() <= shared) return "only " + markers_text();
  if (contradicting_walls > kMaxContradicting) {
    return fmt::format("{:.0f} % of the walls of one map stand in the free space of the other ({})",
                       100.0 * contradicting_walls, markers_text());
  }
  return {};
}

}  // namespace waymark
