// SPDX-License-Identifier: BSD-3-Clause
#include "detector/detector_config.hpp"

#include "common/markers/marker_dictionary.hpp"

namespace waymark {

void DetectorSection::describe(Fields& fields) {
  fields.field("debug_dir", debug_dir, "folder for annotated pictures; \"\" = none");
  fields.field("debug_every", debug_every, {1, 1000000}, "one picture in so many frames");
  MarkerDetectorConfig::describe(fields);
}

void DetectorConfig::describe(Fields& fields) {
  fields.section("robot", robot);
  fields.section("detector", detector);
}

void DetectorConfig::check(Problems& problems) const {
  robot.check(problems);
  check_dictionary(robot.markers, problems);
  const CandidateConfig& candidates = detector.candidates;
  if (candidates.threshold_window_min_px > candidates.threshold_window_max_px) {
    problems.add("detector.candidates.threshold_window_min_px",
                 "must not be above threshold_window_max_px");
  }
}

}  // namespace waymark
