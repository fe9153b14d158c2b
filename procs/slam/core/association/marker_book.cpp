// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/association/marker_book.hpp"

#include "common/geometry/chi2.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark {
namespace {

constexpr int kMinNewSightings = 3;  // at its new place, to retire the old landmark
constexpr double kSamePlace = 0.25;  // of a marker's side length: boards carry adjacent markers
constexpr double kSameFacing_rad = radians(45.0);  // a wall has two sides

/// Converts the Jacobians from steps in the poses' own frames to differences in the map's axes, as
/// in Graph::covariance().
LinearFactor in_map_axes(LinearFactor linear, const State& state) {
  for (LinearFactor::Block& block : linear.blocks)
    if (block.variable.kind != VariableKind::kCalibration)
      block.jacobian *= block_rotation(state.pose(block.variable).rotation().transpose());
  return linear;
}

}  // namespace

MarkerInnovation compare(const Graph& graph, std::size_t keyframe, std::size_t landmark,
                         const MarkerMeasurement& measurement) {
  MarkerFactor factor;
  factor.keyframe = keyframe;
  factor.landmark = landmark;
  factor.measurement = measurement;
  const LinearFactor linear = in_map_axes(
      factor.linearise(graph.state(), std::numeric_limits<double>::infinity()), graph.state());
  MarkerInnovation innovation;
  innovation.landmark = landmark;
  innovation.residual = -linear.residual;
  innovation.covariance = measurement.covariance;
  for (const LinearFactor::Block& row : linear.blocks) {
    if (!graph.is_active(row.variable)) {
      innovation.covariance +=
          row.jacobian * graph.landmark_covariance(landmark) * row.jacobian.transpose();
      continue;
    }
    for (const LinearFactor::Block& column : linear.blocks) {
      if (graph.is_active(column.variable)) {
        innovation.covariance += row.jacobian * graph.covariance(row.variable, column.variable) *
                                 column.jacobian.transpose();
      }
    }
  }
  innovation.chi2 = chi2(innovation.residual, innovation.covariance);
  return innovation;
}

Se2 map_from_measured(const State& state, std::size_t keyframe,
                      const MarkerMeasurement& measurement) {
  const Eigen::Vector3d off = measurement.jacobian_calibration() * camera_part(state.calibration);
  const Se2& seen = measurement.base_from_marker;
  return state.keyframes[keyframe] *
         Se2{seen.x() - off.x(), seen.y() - off.y(), seen.theta() - off.z()};
}

void MarkerBook::add(int id, Timestamp time) {
  Landmark fresh;
  fresh.id = id;
  for (const Landmark& known : entries_)
    if (known.id == id) fresh.instance = std::max(fresh.instance, known.instance + 1);
  fresh.sightings = 1;
  fresh.first_seen = time;
  fresh.last_seen = time;
  entries_.push_back(fresh);
  is_retired_.push_back(false);
  was_sighted_.push_back(true);
  moved_from_.emplace_back();
}

/// Resets the times, which cannot be compared with this run's, and the missed detections.
void MarkerBook::add_known(const Landmark& landmark) {
  entries_.push_back(landmark);
  ++num_known_;
  entries_.back().first_seen = {};
  entries_.back().last_seen = {};
  entries_.back().misses = 0;
  is_retired_.push_back(false);
  was_sighted_.push_back(false);
  moved_from_.emplace_back();
}

void MarkerBook::note_sighting(std::size_t landmark, Timestamp time) {
  ++entries_[landmark].sightings;
  was_sighted_[landmark] = true;
  entries_[landmark].misses = 0;
  entries_[landmark].last_seen = time;
}

void MarkerBook::set_clock(Duration later) {
  for (Landmark& entry : entries_)
    for (Timestamp* time : {&entry.first_seen, &entry.last_seen})
      if (*time != Timestamp{}) *time += later;
}

std::vector<std::size_t> MarkerBook::missed(const State& state, const Se2& map_from_base,
                                            const std::function<bool(const Se2&)>& is_in_view,
                                            Timestamp since) const {
  const Se2 base_from_map = map_from_base.inverse();
  std::vector<std::size_t> missed;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (!is_retired_[i] && entries_[i].last_seen < since &&
        is_in_view(base_from_map * state.landmarks[i])) {
      missed.push_back(i);
    }
  }
  return missed;
}

void MarkerBook::note_misses(const std::vector<std::size_t>& landmarks) {
  for (const std::size_t i : landmarks) {
    ++entries_[i].misses;
    if (!entries_[i].is_missed()) continue;
    for (std::size_t k = 0; k < entries_.size(); ++k) {
      Landmark& other = entries_[k];
      if (k == i || is_retired_[k] || other.id != entries_[i].id ||
          other.first_seen <= entries_[i].last_seen || other.sightings < kMinNewSightings) {
        continue;
      }
      other.instance = entries_[i].instance;
      other.was_moved = entries_[i].is_confirmed();
      is_retired_[i] = true;
      moved_from_[k] = i;
      break;
    }
  }
}

MarkerBook::KnownMarkers MarkerBook::known_markers() const {
  KnownMarkers markers;
  for (std::size_t i = 0; i < num_known_; ++i) {
    if (is_retired_[i])
      ++markers.moved;
    else if (was_sighted_[i])
      ++markers.in_place;
  }
  return markers;
}

bool MarkerBook::knows(int id) const {
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (!is_retired_[i] && entries_[i].id == id) return true;
  return false;
}

bool MarkerBook::has_one_near(const State& state, const Eigen::Vector2d& place, double near_m,
                              int id) const {
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (!is_retired_[i] && (id == kNoMarker || entries_[i].id == id) &&
        (state.landmarks[i].translation() - place).norm() < near_m) {
      return true;
    }
  }
  return false;
}

std::optional<MarkerInnovation> MarkerBook::nearest(const Graph& graph, std::size_t keyframe,
                                                    const MarkerMeasurement& measurement) const {
  std::optional<MarkerInnovation> nearest;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].id != measurement.id || is_retired_[i]) continue;
    const MarkerInnovation innovation = compare(graph, keyframe, i, measurement);
    if (!nearest || innovation.chi2 < nearest->chi2) nearest = innovation;
  }
  return nearest;
}

std::optional<std::size_t> MarkerBook::unique(int id) const {
  std::optional<std::size_t> only;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (entries_[i].id != id || is_retired_[i]) continue;
    if (only || !entries_[i].is_confirmed()) return std::nullopt;
    only = i;
  }
  return only;
}

bool MarkerBook::is_misread(const State& state, std::size_t keyframe,
                            const MarkerMeasurement& measurement) const {
  const Se2 there = map_from_measured(state, keyframe, measurement);
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Eigen::Vector3d away = pose_difference(there, state.landmarks[i]);
    if (!is_retired_[i] && entries_[i].id != measurement.id && entries_[i].is_confirmed() &&
        !entries_[i].is_missed() && away.head<2>().norm() < kSamePlace * measurement.size_m &&
        std::abs(away.z()) < kSameFacing_rad) {
      return true;
    }
  }
  return false;
}

}  // namespace waymark
