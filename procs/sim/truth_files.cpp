// SPDX-License-Identifier: BSD-3-Clause
#include "sim/truth_files.hpp"

#include "common/node/node.hpp"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace waymark {
namespace {

std::string marker_row(const MarkerPlate& marker) {
  return fmt::format("{},{},{:.6f},{:.6f},{:.9f}", marker.id, marker.instance, marker.centre_m.x(),
                     marker.centre_m.y(), marker.yaw_rad);
}

}  // namespace

std::string truth_markers_csv(const World& world) {
  std::string text = "id,instance,x_m,y_m,yaw_rad\n";
  for (const MarkerPlate& marker : world.markers)
    text += marker_row(marker) + '\n';
  return text;
}

std::string truth_marker_moves_csv(const std::vector<MovedMarker>& moves) {
  std::string text = "t_s,id,instance,x_m,y_m,yaw_rad\n";
  for (const MovedMarker& moved : moves) {
    text += fmt::format("{:.6f},{}\n", to_seconds(moved.time), marker_row(moved.marker));
  }
  return text;
}

TruthTrajectory::TruthTrajectory(const std::filesystem::path& path)
    : path_{path}, unfinished_path_{path.string() + ".unfinished"}, stream_{unfinished_path_} {
  if (!stream_)
    throw SetupError{path.string() + ": cannot be written; does the folder exist, is it writable?"};
}

void TruthTrajectory::add(const TruePose& pose) {
  const double half_yaw_rad = 0.5 * pose.world_from_base.theta();
  stream_ << fmt::format("{:.6f} {:.6f} {:.6f} 0 0 0 {:.9f} {:.9f}\n", to_seconds(pose.time),
                         pose.world_from_base.x(), pose.world_from_base.y(), std::sin(half_yaw_rad),
                         std::cos(half_yaw_rad));
}

void TruthTrajectory::finish() {
  stream_.close();
  std::error_code error;
  if (stream_) std::filesystem::rename(unfinished_path_, path_, error);
  if (!stream_ || error)
    throw std::runtime_error{path_.string() + ": cannot be written (disk full?)"};
}

}  // namespace waymark
