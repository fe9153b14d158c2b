// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/points.hpp"

#include <algorithm>

namespace waymark {

Points points_of(const Observation& observation) {
  Points points;
  points.reserve(observation.beams.size());
  for (const AnnotatedBeam& annotated : observation.beams)
    points.push_back(annotated.beam.end_in_base);
  return points;
}

Points thinned(const Points& points, std::size_t most) {
  const std::size_t step = std::max<std::size_t>(1, (points.size() + most - 1) / most);
  Points kept;
  for (std::size_t i = 0; i < points.size(); i += step)
    kept.push_back(points[i]);
  return kept;
}

}  // namespace waymark
