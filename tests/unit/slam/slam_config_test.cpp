// SPDX-License-Identifier: BSD-3-Clause
// What of slam's configuration is refused, and why.
#include "slam/slam_config.hpp"

#include "common/config/config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace waymark {
namespace {

using ::testing::HasSubstr;

std::string why_refused(const std::string& setting) {
  try {
    load_config<SlamConfig>({{}, {setting}});
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "no error";
}

TEST(SlamConfig, AnUnknownDictionaryIsReportedWithTheKnownOnes) {
  EXPECT_THAT(why_refused("robot.markers.dictionary=DICT_9X9_50"),
              HasSubstr("got 'DICT_9X9_50', expected one of DICT_4X4"));
}

TEST(SlamConfig, AnIdOutsideTheDictionaryIsReported) {
  EXPECT_THAT(why_refused("robot.markers.ids=[0, 249, 250]"),
              HasSubstr("robot.markers.ids: got 250, but DICT_6X6_250"));
}

}  // namespace
}  // namespace waymark
