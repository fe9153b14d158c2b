// SPDX-License-Identifier: BSD-3-Clause
#include "detector/detector_config.hpp"

#include "common/markers/marker_dictionary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::HasSubstr;

std::string error_of(const std::vector<std::string>& overrides) {
  try {
    load_config<DetectorConfig>({{}, overrides});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(DetectorConfig, DefaultsAreValid) {
  EXPECT_EQ(error_of({}), "no error");
}

TEST(DetectorConfig, AnUnknownDictionaryIsNamedWithTheKnownOnes) {
  const std::string error = error_of({"robot.markers.dictionary=DICT_9X9_50"});
  EXPECT_THAT(error, HasSubstr("robot.markers.dictionary: got 'DICT_9X9_50'"));
  EXPECT_THAT(error, HasSubstr("DICT_6X6_250"));
}

TEST(DetectorConfig, AnIdOutsideTheDictionaryIsNamed) {
  EXPECT_THAT(error_of({"robot.markers.ids=[0, 249, 250]"}),
              HasSubstr("robot.markers.ids: got 250, but DICT_6X6_250 has the ids 0 to 249"));
}

TEST(DetectorConfig, ThresholdWindowsAreOrdered) {
  EXPECT_THAT(error_of({"detector.candidates.threshold_window_min_px=33"}),
              HasSubstr("threshold_window_max_px"));
}

TEST(MarkerDictionary, AprilTagsGetTheirErrorCorrection) {
  EXPECT_EQ(find_dictionary("DICT_APRILTAG_36h11")->maxCorrectionBits, 5);
  EXPECT_EQ(find_dictionary("DICT_APRILTAG_25h9")->maxCorrectionBits, 4);
  EXPECT_EQ(size_of(*find_dictionary("DICT_6X6_250")), 250);
  EXPECT_FALSE(find_dictionary("6X6_250"));
}

}  // namespace
}  // namespace waymark
