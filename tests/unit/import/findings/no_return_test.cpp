// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/no_return.hpp"

#include "common/errors/setup_error.hpp"
#include "common/messages/convert.hpp"
#include "synthetic_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace waymark {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::FloatEq;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::ThrowsMessage;

/// Scans of a hall of 60 m x 45 m from places all over it. Beams longer than `reach_m`, and one
/// beam of fifty at random, have no return: their range is `code(random)`.
template <class Code>
std::vector<LidarScan> hall(double reach_m, double sigma_m, double step_m, const Code& code,
                            unsigned seed = 1) {
  std::mt19937 random{seed};
  std::uniform_real_distribution<double> part{0.1, 0.9};
  std::normal_distribution<double> noise{0.0, 1.0};
  std::vector<LidarScan> scans;
  for (int place = 0; place < 60; ++place) {
    const double x_m = 60.0 * part(random);
    const double y_m = 45.0 * part(random);
    LidarScan scan{};
    for (int beam = 0; beam < 180; ++beam) {
      const double angle_rad = radians(beam - 89.5 + 3.7 * place);
      const double c = std::cos(angle_rad);
      const double s = std::sin(angle_rad);
      const double true_m =
          std::min((c > 0.0 ? 60.0 - x_m : -x_m) / c, (s > 0.0 ? 45.0 - y_m : -y_m) / s);
      const double range_m = step_m * std::round((true_m + sigma_m * noise(random)) / step_m);
      const bool returns = true_m < reach_m && random() % 50 != 0;
      scan.ranges_m.push_back(returns ? range_m : code(random));
      scan.angles_rad.push_back(radians(beam - 89.5));
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

double none(std::mt19937& /*random*/) {
  return std::nan("");
}

TEST(NoReturn, ACodeForNoReturnIsFoundWhateverNoiseAndResolution) {
  for (const double code_m : {8.0, 29.9, 50.0, 81.91}) {
    for (const double sigma_m : {0.0, 0.01, 0.05}) {
      for (const double step_m : {0.001, 0.01, 0.05, 0.1}) {
        const auto scans = hall(0.95 * code_m, sigma_m, step_m, [&](auto&) { return code_m; });

        const auto code = find_no_return_code(scans);

        ASSERT_TRUE(code) << code_m << " m, noise " << sigma_m << ", steps " << step_m;
        EXPECT_THAT(code->codes_m, ElementsAre(code_m)) << sigma_m << " " << step_m;
      }
    }
  }
}

TEST(NoReturn, SeveralCodesOfASickLidarAreFound) {
  const auto scans = hall(60.0, 0.01, 0.01, [](std::mt19937& random) {
    const auto kind = random() % 20;
    return kind < 2 ? 81.83 : kind < 5 ? 81.87 : 81.91;
  });

  const auto code = find_no_return_code(scans);

  ASSERT_TRUE(code);
  EXPECT_THAT(code->codes_m, ElementsAre(81.83, 81.87, 81.91));
}

TEST(NoReturn, TheFarthestWallsAreNoCode) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    for (const double sigma_m : {0.0, 0.003, 0.01, 0.05}) {
      for (const double step_m : {0.001, 0.01, 0.05, 0.1}) {
        EXPECT_FALSE(find_no_return_code(hall(100.0, sigma_m, step_m, none, seed)))
            << seed << " " << sigma_m << " " << step_m;
        EXPECT_FALSE(find_no_return_code(hall(30.0, sigma_m, step_m, none, seed)))
            << "ranges that end at 30 m without a code: " << seed << " " << sigma_m << " "
            << step_m;
      }
    }
  }
  EXPECT_FALSE(find_no_return_code({}));
}

TEST(NoReturn, ConstantRangesOfAStandingRobotAreNotTakenForNoReturn) {
  for (const double step_m : {0.001, 0.01, 0.05}) {
    const auto one = hall(100.0, 0.003, step_m, none);
    const std::vector<LidarScan> standing(200, one.front());
    EXPECT_FALSE(find_no_return_code(standing)) << step_m;
  }
}

TEST(NoReturn, TheCodeIsReplacedAndReportedAndSetsTheMaximumRange) {
  ImportedLog log = drive(to_and_fro(), CountedAs::kDriven);
  edit_ranges(log, [](float range_m, std::size_t beam) {
    return std::isinf(range_m) || beam % 15 == 0 ? 50.0F : beam == 1 ? 0.0F : range_m;
  });
  ImportReport report{"log", AddressUnit::kLine};

  mark_no_returns(log, {std::nullopt, 81.83}, report);

  EXPECT_EQ(log.robot.lidar.range_max_m, 50.0);
  const LidarScan scan = scan_of(log.scans[3]);
  EXPECT_TRUE(std::isinf(scan.ranges_m[30]));
  EXPECT_TRUE(std::isnan(scan.ranges_m[1]));
  EXPECT_LT(log.scans[3].longest_range_m, 10.0);
  EXPECT_THAT(report.notes(), ElementsAre(HasSubstr("ranges pile up at 50.00 m"),
                                          HasSubstr("ranges of 0 m (61 of")));
}

TEST(NoReturn, ALogWithoutACodeGetsTheDefaultLimitAndNoNote) {
  ImportedLog log = drive(to_and_fro(), CountedAs::kDriven);
  ImportReport report{"log", AddressUnit::kLine};

  mark_no_returns(log, {std::nullopt, 81.83}, report);

  EXPECT_EQ(log.robot.lidar.range_max_m, 81.83);
  EXPECT_THAT(report.notes(), IsEmpty());
}

TEST(NoReturn, AConfiguredLimitIsUsedWithoutASearch) {
  ImportedLog log = drive(to_and_fro(), CountedAs::kDriven);
  edit_ranges(log,
              [](float range_m, std::size_t beam) { return beam % 30 == 0 ? 8.19F : range_m; });
  ImportReport report{"log", AddressUnit::kLine};

  mark_no_returns(log, {8.19, 81.83}, report);

  EXPECT_EQ(log.robot.lidar.range_max_m, 8.19);
  EXPECT_TRUE(std::isinf(scan_of(log.scans[0]).ranges_m[30]))
      << "8.19 as a float is less than that";
  EXPECT_THAT(report.notes(), IsEmpty());
}

TEST(NoReturn, WithoutALimitTheLongestRangeIsUsed) {
  ImportedLog log = drive(to_and_fro(), CountedAs::kDriven);
  ImportReport report{"log", AddressUnit::kLine};

  mark_no_returns(log, {}, report);

  double longest_m = 0.0;
  for (const ImportedScan& scan : log.scans) {
    for (const double range_m : scan_of(scan).ranges_m)
      longest_m = std::isfinite(range_m) ? std::max(longest_m, range_m) : longest_m;
  }
  EXPECT_GT(longest_m, 3.0);
  EXPECT_EQ(log.robot.lidar.range_max_m, longest_m);
  EXPECT_THAT(report.notes(), ElementsAre(HasSubstr("written as the maximum")));
}

TEST(NoReturn, ALogOfWhichNoRangeIsLeftIsRefused) {
  ImportedLog log = drive(to_and_fro(), CountedAs::kDriven);
  edit_ranges(log, [](float range_m, std::size_t) { return 100.0F + 100.0F * range_m; });
  ImportReport report{"log", AddressUnit::kLine};

  EXPECT_THAT(
      [&] {
        mark_no_returns(log, {std::nullopt, 81.83}, report);
      },
      ThrowsMessage<SetupError>(AllOf(HasSubstr("no range is left"),
                                      HasSubstr("are 81.83 m or longer"), HasSubstr("--range-unit"),
                                      HasSubstr("--max-range-m"))));
}

TEST(NoReturn, ARotatingLidarsCodeIsZeroAndOtherScansAreUnchanged) {
  ImportedLog log = drive(to_and_fro(), CountedAs::kDriven);
  edit_ranges(log, [](float range_m, std::size_t) { return std::isinf(range_m) ? 5.0F : range_m; });
  for (ImportedScan& scan : log.scans)
    scan.message = encode(channels::kMbotLidar, to_mbot_lidar(scan_of(scan)));
  ImportedLog with_code = log;
  for (ImportedScan& scan : with_code.scans) {
    auto message = decode<lidar_t>(scan.message.payload).message.value();
    for (std::size_t beam = 0; beam < message.ranges.size(); beam += 10)
      message.ranges[beam] = 12.0F;
    scan.message = encode(channels::kMbotLidar, message);
  }
  ImportReport report{"log", AddressUnit::kByte};
  const auto before = log.scans[0].message.payload;

  mark_no_returns(log, {std::nullopt, 6.0}, report);
  mark_no_returns(with_code, {std::nullopt, 6.0}, report);

  EXPECT_EQ(log.scans[0].message.payload, before);
  EXPECT_EQ(decode<lidar_t>(with_code.scans[0].message.payload).message.value().ranges[20], 0.0F);
  EXPECT_THAT(report.notes(), ElementsAre(HasSubstr("pile up at 12.00 m")));
}

}  // namespace
}  // namespace waymark
