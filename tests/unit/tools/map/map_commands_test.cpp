// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_commands.hpp"

#include "slam/map_file.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// A map file with two walls of a few cells, one at each of these places.
std::filesystem::path map_with(const evaluate::TemporaryFolder& folder,
                               const Eigen::Vector2d& first_m, const Eigen::Vector2d& second_m) {
  MapSnapshot map;
  map.grid.frame = GridFrame::centred_on_map_origin(0.05);
  for (const Eigen::Vector2d& place_m : {first_m, second_m})
    map.grid.occupancy.edit(map.grid.frame.cell_of(place_m)) = {1, 1};
  const auto file = folder.path() / "a.map.lcm";
  write_map_file(file, map, {"6x6_250", 0.4});
  return file;
}

template <class Error, class Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "no such error";
}

TEST(ExportMap, AMapThatFitsIsWritten) {
  const evaluate::TemporaryFolder folder;
  const auto file = map_with(folder, {0.0, 0.0}, {20.0, 10.0});
  export_map(file, folder.path() / "out");
  EXPECT_TRUE(std::filesystem::exists(folder.path() / "out" / "map.pgm"));
}

TEST(ExportMap, AMapThatIsTooLargeIsRefusedAndNotCut) {
  const evaluate::TemporaryFolder folder;
  const auto file = map_with(folder, {0.0, 0.0}, {300.0, 300.0});  // 36 million cells
  const auto out = folder.path() / "out";
  EXPECT_THAT(error_of<std::runtime_error>([&] { export_map(file, out); }),
              AllOf(HasSubstr("SLAM_MAP tiles left out"), HasSubstr("16 million cells")));
  EXPECT_FALSE(std::filesystem::exists(out / "map.pgm"));
}

TEST(TransformMap, AMapMayLieKilometresAwayButNotWherePosesAreCoarse) {
  const evaluate::TemporaryFolder folder;
  const auto file = map_with(folder, {0.0, 0.0}, {20.0, 10.0});
  const auto out = folder.path() / "b.map.lcm";
  const auto error_at = [&](double x_m, double y_m) {
    return error_of<SetupError>([&] { transform_map(file, {x_m, y_m, 0.3}, "utm", out); });
  };
  for (const double far : {16'400.0, 4.5e6, 1e300}) {
    EXPECT_THAT(error_at(0.0, far), AllOf(HasSubstr("--y-m"), HasSubstr("16384 m"))) << far;
    EXPECT_THAT(error_at(-far, 0.0), AllOf(HasSubstr("--x-m"), HasSubstr("16384 m"))) << far;
  }
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(error_at(16'000.0, -16'000.0), "no such error");
  EXPECT_NO_THROW(read_map_file(out));
}

}  // namespace
}  // namespace waymark
