// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/files/map_files.hpp"

#include "unit/viewer/drawn_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sstream>

namespace waymark::viewer {
namespace {

/// Reads a P5 image back into a picture: '#' occupied, '.' free, ' ' unknown.
std::vector<std::string> picture_of(const std::string& pgm) {
  std::istringstream stream{pgm};
  std::string magic;
  int width = 0, height = 0, highest = 0;
  stream >> magic >> width >> height >> highest;
  EXPECT_EQ(magic, "P5");
  EXPECT_EQ(highest, 255);
  stream.get();
  std::vector<std::string> picture(static_cast<std::size_t>(height));
  for (std::string& line : picture) {
    for (int column = 0; column < width; ++column) {
      const int grey = stream.get();
      line += grey == 0 ? '#' : grey == 254 ? '.' : grey == 205 ? ' ' : '?';
    }
  }
  EXPECT_EQ(stream.get(), std::char_traits<char>::eof()) << "nothing follows the pixels";
  return picture;
}

TEST(Pgm, ShowsTheMapAsDrawn) {
  const std::vector<std::string> picture{
      "#####  ",
      "#...#  ",
      "#...###",
      "##....#",
  };
  EXPECT_EQ(picture_of(pgm_text(drawn_map(picture), {})), picture);
}

TEST(Pgm, EqualsAReferenceByteForByte) {
  const std::string pixels{'\0', '\xFE', '\xCD'};
  EXPECT_EQ(pgm_text(drawn_map({"#. "}), {}), "P5\n3 1\n255\n" + pixels);
}

TEST(Pgm, CellsAreClassifiedByTheThresholds) {
  GridMap map = drawn_map({"....."});
  const std::array<schar, 5> percents{64, 65, 19, 20, -1};
  for (int i = 0; i < 5; ++i)
    map.occupancy_percent(0, i) = percents[static_cast<std::size_t>(i)];
  EXPECT_EQ(picture_of(pgm_text(map, {})).front(), " #.  ");
}

TEST(Pgm, AnEmptyMapIsOneUnknownPixel) {
  EXPECT_EQ(picture_of(pgm_text({}, {})), std::vector<std::string>{" "});
}

TEST(MapYaml, HasTheFieldsOfMapServer) {
  GridMap map = drawn_map({"#"});
  map.origin_m = {-1.025, -1.125};
  EXPECT_EQ(map_yaml_text(map, {}, "map.pgm"),
            "image: map.pgm\n"
            "mode: trinary\n"
            "resolution: 0.05\n"
            "origin: [-1.025000000, -1.125000000, 0.0]\n"
            "negate: 0\n"
            "occupied_thresh: 0.65\n"
            "free_thresh: 0.196\n");
}

}  // namespace
}  // namespace waymark::viewer
