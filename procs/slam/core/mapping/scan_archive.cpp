// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/mapping/scan_archive.hpp"

#include "common/geometry/angle.hpp"

#include <cmath>

namespace waymark {
namespace {

constexpr double kPlace_m = 0.25;
constexpr double kDirection_rad = radians(45.0);

int whole(double number) {
  return static_cast<int>(std::floor(number));
}

}  // namespace

std::optional<ScanArchive::Place> ScanArchive::place_of(const Observation& observation,
                                                        const Se2& map_from_base) {
  if (observation.beams.empty() && observation.sightings.empty()) return std::nullopt;
  return Place{whole(map_from_base.x() / kPlace_m), whole(map_from_base.y() / kPlace_m),
               whole(map_from_base.theta() / kDirection_rad), observation.beams.empty() ? 0 : 1};
}

std::optional<std::size_t> ScanArchive::emptied_by(const Observation& observation,
                                                   const Se2& map_from_base) const {
  const auto place = place_of(observation, map_from_base);
  if (!place) return std::nullopt;
  const auto here = at_places_.find(*place);
  if (here == at_places_.end() || here->second.size() < kScansPerPlace) return std::nullopt;
  return here->second.front();
}

ScanArchive::Scan ScanArchive::packed(const Observation& observation) {
  Scan scan;
  scan.beams.reserve(observation.beams.size());
  for (const AnnotatedBeam& annotated : observation.beams) {
    scan.beams.push_back(
        {annotated.beam.start_in_base.cast<float>(), annotated.beam.end_in_base.cast<float>()});
  }
  scan.sightings = observation.sightings;
  return scan;
}

void ScanArchive::add(const Observation& observation, const Se2& map_from_base) {
  scans_.push_back(packed(observation));
  const auto place = place_of(observation, map_from_base);
  if (!place) return;
  std::deque<std::size_t>& here = at_places_[*place];
  here.push_back(scans_.size() - 1);
  if (here.size() <= kScansPerPlace) return;
  scans_[here.front()] = {};
  here.pop_front();
}

Observation ScanArchive::unpacked(const Scan& scan) {
  Observation observation;
  observation.beams.reserve(scan.beams.size());
  for (const PackedBeam& packed : scan.beams) {
    AnnotatedBeam annotated;
    annotated.beam.start_in_base = packed.start_in_base.cast<double>();
    annotated.beam.end_in_base = packed.end_in_base.cast<double>();
    annotated.beam.range_m = (annotated.beam.end_in_base - annotated.beam.start_in_base).norm();
    observation.beams.push_back(annotated);
  }
  observation.sightings = scan.sightings;
  return observation;
}

}  // namespace waymark
