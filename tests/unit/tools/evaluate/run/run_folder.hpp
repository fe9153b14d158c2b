// SPDX-License-Identifier: BSD-3-Clause
// Files of a run with a known truth and estimators with known errors.
#pragma once

#include "evaluate/commands.hpp"
#include "evaluate/run/report.hpp"
#include "support/drawn_map.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>

namespace waymark::evaluate {

inline const Output kQuietly{false, false};

inline constexpr int kPoses = 81;

/// A drive of 8 m in 16 s, with steps longer by `factor`.
/// @param poses  number of poses to write, from number `first` on.
inline std::string tum(double x0_m, double factor, int poses = kPoses, int first = 0) {
  std::string text;
  for (int i = first; i < first + poses; ++i)
    text += fmt::format("{:.6f} {:.6f} 0 0 0 0 0 1\n", 0.2 * i, x0_m + factor * 0.1 * i);
  return text;
}

inline std::string pgm(const corridor::MapImage& map) {
  std::string text = fmt::format("P5\n{} {}\n255\n", map.width_px, map.height_px);
  for (int y = map.height_px - 1; y >= 0; --y) {
    for (int x = 0; x < map.width_px; ++x)
      text += map.at(x, y) == corridor::Cell::kFree       ? '\xfe'
              : map.at(x, y) == corridor::Cell::kOccupied ? '\0'
                                                          : '\xcd';
  }
  return text;
}

inline void add_estimator(const TemporaryFolder& run, const std::string& name, double length_px,
                          double factor) {
  run.file(name + "/trajectory.tum", tum(0.0, factor));
  run.file(name + "/map.pgm",
           pgm(corridor::draw({230, 61, length_px}, corridor::straight_shape(7, 30, 0))));
  run.file(name + "/map.yaml",
           "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
           "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
}

inline void add_truth(const TemporaryFolder& run) {
  run.file("scenario.toml", "[world]\nlength_m = 10\n");
  run.file("truth.tum", tum(1.0, 1.0));
  run.file("truth_markers.csv", "id,instance,x_m,y_m,yaw_rad\n0,0,4,1,-1.5708\n1,0,8,1,-1.5708\n");
}

inline Json json_in(const std::filesystem::path& file) {
  return Json::parse(read_text(file));
}

inline constexpr const char* kUnitCovariance = "1,0,0,1,0,1";

/// covariance.csv with the same covariance for the first poses of tum().
/// @param covariance  cxx,cxy,cxt,cyy,cyt,ctt
inline std::string covariance_csv(int poses, std::string_view covariance) {
  std::string text = "t,cxx,cxy,cxt,cyy,cyt,ctt,health\n";
  for (int i = 0; i < poses; ++i)
    text += fmt::format("{:.6f},{},2\n", 0.2 * i, covariance);
  return text;
}

}  // namespace waymark::evaluate
