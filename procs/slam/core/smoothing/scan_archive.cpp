// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/smoothing/scan_archive.hpp"

namespace waymark {

void ScanArchive::add(const Observation& observation) {
  Scan scan;
  scan.beams.reserve(observation.beams.size());
  for (const AnnotatedBeam& annotated : observation.beams) {
    scan.beams.push_back(
        {annotated.beam.start_in_base.cast<float>(), annotated.beam.end_in_base.cast<float>()});
  }
  scan.sightings = observation.sightings;
  scans_.push_back(std::move(scan));
}

Observation ScanArchive::at(std::size_t index) const {
  const Scan& scan = scans_[index];
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
