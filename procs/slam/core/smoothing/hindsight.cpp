// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/smoothing/hindsight.hpp"

#include <map>
#include <optional>

namespace waymark {
namespace {

std::map<MarkerName, Se2> places_of(const std::vector<Landmark>& markers) {
  std::map<MarkerName, Se2> places;
  for (const Landmark& marker : markers)
    places.emplace(name_of(marker), marker.map_from_marker);
  return places;
}

std::optional<Se2> place_of(const MarkerName& name, const std::map<MarkerName, Se2>& places) {
  const auto place = places.find(name);
  if (place == places.end()) return std::nullopt;
  return place->second;
}

}  // namespace

void Hindsight::add_update(const PoseByStatics& by, const Statics& then) {
  const std::map<MarkerName, Se2> places = places_of(then.markers);
  Update update{scans_.size(), then.errors, {}, by.gain.cast<float>()};
  for (std::size_t i = 0; i < by.markers.size(); ++i) {
    // The filter as a whole may not know a marker that one particle knows.
    const auto place = place_of(by.markers[i], places);
    update.markers.push_back({by.markers[i], place.value_or(Se2{})});
    if (!place)
      update.gain.middleCols<3>(kStaticErrors + 3 * static_cast<Eigen::Index>(i)).setZero();
  }
  updates_.push_back(std::move(update));
}

void Hindsight::add_scan(Timestamp time, const Se2& map_from_base) {
  scans_.push_back({time, map_from_base});
}

std::vector<Eigen::Vector3d> Hindsight::corrections(const Statics& now,
                                                    double same_marker_within_m) const {
  const std::map<MarkerName, Se2> places = places_of(now.markers);
  std::vector<Eigen::Vector3d> corrections;
  corrections.reserve(updates_.size());
  for (const Update& update : updates_) {
    Eigen::VectorXd learnt = Eigen::VectorXd::Zero(update.gain.cols());
    learnt.head<kStaticErrors>() = now.errors - update.errors;
    for (std::size_t i = 0; i < update.markers.size(); ++i) {
      const auto place = place_of(update.markers[i].name, places);
      if (!place) continue;
      const Eigen::Vector3d moved = deviation(update.markers[i].map_from_marker, *place);
      if (moved.head<2>().norm() > same_marker_within_m) continue;
      learnt.segment<3>(kStaticErrors + 3 * static_cast<Eigen::Index>(i)) = moved;
    }
    corrections.push_back(update.gain.cast<double>() * learnt);
  }
  return corrections;
}

std::vector<TimedPose> Hindsight::way(const Statics& now, double same_marker_within_m) const {
  const std::vector<Eigen::Vector3d> corrections = this->corrections(now, same_marker_within_m);
  std::vector<TimedPose> way = scans_;
  for (std::size_t i = 0; i < updates_.size(); ++i) {
    const bool is_last = i + 1 == updates_.size();
    const std::size_t first = updates_[i].scan;
    const std::size_t end = is_last ? way.size() : updates_[i + 1].scan;
    const Eigen::Vector3d growth =
        is_last ? Eigen::Vector3d::Zero() : Eigen::Vector3d{corrections[i + 1] - corrections[i]};
    const double whole_s = is_last ? 1.0 : to_seconds(scans_[end].time - scans_[first].time);
    for (std::size_t scan = first; scan < end; ++scan) {
      const double share = to_seconds(way[scan].time - way[first].time) / whole_s;
      way[scan].map_from_base = deviated(way[scan].map_from_base, corrections[i] + share * growth);
    }
  }
  return way;
}

std::vector<Se2> Hindsight::way_of_updates(const Statics& now, double same_marker_within_m) const {
  const std::vector<TimedPose> way = this->way(now, same_marker_within_m);
  std::vector<Se2> of_updates;
  of_updates.reserve(updates_.size());
  for (const Update& update : updates_)
    of_updates.push_back(way[update.scan].map_from_base);
  return of_updates;
}

}  // namespace waymark
