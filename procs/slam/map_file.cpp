// SPDX-License-Identifier: BSD-3-Clause
#include "slam/map_file.hpp"

#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "slam/in_parts.hpp"
#include "slam/map_publisher.hpp"
#include "slam/slam_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <system_error>

namespace waymark {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
using RowMajorCalibration =
    Eigen::Matrix<double, kCalibrationSize, kCalibrationSize, Eigen::RowMajor>;

constexpr std::size_t kCellsPerMessage = 1000;  // 56 bytes each
// Counts of a cell of a loaded map: visits so that percents are whole numbers, and few enough
// counts for later observations to outweigh them.
constexpr std::uint32_t kLoadedVisits = 100;
constexpr float kLoadedVotes = 5.0F;

std::vector<map_walls_t> wall_messages(const NdtMap& walls, Timestamp time) {
  const std::vector<NdtCellSums> cells = walls.sums();
  return in_parts<map_walls_t>(std::max<std::size_t>(1, cells.size()), kCellsPerMessage, time,
                               [&](map_walls_t& message, const Part& part) {
                                 message.spacing_m = walls.spacing_m();
                                 for (const NdtCellSums& sums : part.of(cells)) {
                                   wall_cell_t& cell = message.cells.emplace_back();
                                   cell.column = sums.column;
                                   cell.row = sums.row;
                                   cell.count = sums.count;
                                   Eigen::Map<Eigen::Vector2d>{cell.sum_m} = sums.sum_m;
                                   Eigen::Map<Eigen::Vector3d>{cell.squares_m2} = sums.squares_m2;
                                 }
                                 message.num_cells =
                                     static_cast<std::int32_t>(message.cells.size());
                               });
}

calibration_t to_message(const LearntCalibration& calibration, Timestamp time) {
  calibration_t message{};
  message.utime = to_us(time);
  Eigen::Map<Calibration>{message.mean} = calibration.mean;
  Eigen::Map<RowMajorCalibration>{message.covariance} = calibration.covariance;
  return message;
}

/// All messages of a map, with this map_id; the header is the first.
std::vector<Message> messages_with_id(const MapSnapshot& map, const MapFileInfo& info,
                                      std::int64_t map_id) {
  std::vector<Message> messages(1);
  for (map_tiles_t part : MapPublisher{}.all_tiles(map.grid, map.time)) {
    part.map_id = map_id;
    messages.push_back(encode(channels::kSlamMap, part));
  }
  for (marker_map_t part : to_messages(map.landmarks, map.time)) {
    part.map_id = map_id;
    messages.push_back(encode(channels::kSlamMarkers, part));
  }
  for (const map_walls_t& part : wall_messages(map.walls, map.time))
    messages.push_back(encode(channels::kMapWalls, part));
  for (const pose_graph_t& part : to_messages(map.graph, map.time))
    messages.push_back(encode(channels::kMapGraph, part));
  messages.push_back(encode(channels::kMapCalibration, to_message(map.calibration, map.time)));
  map_header_t header{};
  header.utime = to_us(map.time);
  header.map_id = map_id;
  header.parent_map_id = map.parent_map_id;
  header.format = map_header_t::FORMAT;
  header.num_messages = static_cast<std::int32_t>(messages.size()) - 1;
  header.resolution_m = map.grid.frame.resolution_m;
  header.marker_size_m = info.marker_size_m;
  header.marker_dictionary = info.marker_dictionary;
  header.frame = info.frame;
  messages.front() = encode(channels::kMapHeader, header);
  return messages;
}

/// Id of a map: hash of its messages, whose map_id must be 0.
std::int64_t id_of(const std::vector<Message>& messages) {
  Message all;
  for (const Message& message : messages) {
    const auto hash = static_cast<std::uint64_t>(content_hash(message));
    for (int byte = 0; byte < 8; ++byte)
      all.payload.push_back(static_cast<std::uint8_t>(hash >> (8 * byte)));
  }
  const std::int64_t id = content_hash(all);
  return id == 0 ? 1 : id;  // 0 means none
}

Landmark to_landmark(const marker_landmark_t& message) {
  Landmark landmark;
  landmark.id = message.id;
  landmark.instance = message.instance;
  landmark.map_from_marker = {message.x_m, message.y_m, message.yaw_rad};
  landmark.covariance = Eigen::Map<const RowMajor3>{message.covariance};
  landmark.sightings = message.sightings;
  landmark.first_seen = timestamp_from_us(message.first_seen_utime);
  landmark.last_seen = timestamp_from_us(message.last_seen_utime);
  landmark.was_moved = message.state == marker_landmark_t::STATE_MOVED;
  return landmark;
}

/// Builds a map message by message.
class MapBuilder {
 public:
  /// @return what is wrong with the message; empty: nothing.
  std::string add(const Message& message) {
    if (message.channel == channels::kMapHeader.name) return take(message, &MapBuilder::on_header);
    if (!header_) return "does not begin with MAP_HEADER, so it is not a map file";
    ++num_messages_;
    if (message.channel == channels::kSlamMap.name) return take(message, &MapBuilder::on_tiles);
    if (message.channel == channels::kSlamMarkers.name)
      return take(message, &MapBuilder::on_markers);
    if (message.channel == channels::kMapWalls.name) return take(message, &MapBuilder::on_walls);
    if (message.channel == channels::kMapGraph.name) return take(message, &MapBuilder::on_graph);
    if (message.channel == channels::kMapCalibration.name)
      return take(message, &MapBuilder::on_calibration);
    return fmt::format("holds a message on {}, which no map has", message.channel);
  }

  /// @return what is wrong with the whole; empty: nothing.
  std::string finish() {
    if (!header_) return "holds no MAP_HEADER, so it is not a map file";
    if (num_messages_ != header_->num_messages) {
      return fmt::format("is cut off: {} of {} messages are there", num_messages_,
                         header_->num_messages);
    }
    if (id_of(hashed_) != header_->map_id)
      return "is damaged: its content does not match its map_id";
    const auto num_poses = file_.map.graph.poses.size();
    for (const GraphEdge& edge : file_.map.graph.edges)
      if (edge.from >= num_poses || edge.to >= num_poses) return "has edges without vertices";
    return {};
  }

  MapFile& file() { return file_; }

 private:
  template <class Type>
  std::string take(const Message& message, std::string (MapBuilder::*handler)(Type)) {
    const Decoded<Type> decoded = decode<Type>(message.payload);
    if (!decoded.message)
      return fmt::format("has a {} that is {}", message.channel, to_string(decoded.reason));
    Type plain = *decoded.message;
    if constexpr (requires { plain.map_id; }) plain.map_id = 0;
    hashed_.push_back(encode(Channel<Type>{message.channel}, plain));
    return (this->*handler)(*decoded.message);
  }

  std::string on_header(map_header_t header) {
    if (header_) return "has two headers";
    if (header.format != map_header_t::FORMAT) {
      return fmt::format("has format {}; this program reads {}", header.format,
                         map_header_t::FORMAT);
    }
    header_ = header;
    file_.map.map_id = header.map_id;
    file_.map.parent_map_id = header.parent_map_id;
    file_.map.time = timestamp_from_us(header.utime);
    file_.map.grid.frame = GridFrame::centred_on_map_origin(header.resolution_m);
    file_.info = {header.marker_dictionary, header.marker_size_m, header.frame};
    return {};
  }

  std::string on_tiles(map_tiles_t tiles) {
    const GridMap& grid = file_.map.grid;
    if (tiles.tile_size_cells != kTileSize || tiles.resolution_m != grid.frame.resolution_m ||
        tiles.origin_x_m != grid.frame.origin_m.x() ||
        tiles.origin_y_m != grid.frame.origin_m.y()) {
      return "has tiles of another grid than its header says";
    }
    try {
      for (const map_tile_t& tile : tiles.tiles)
        draw(tile);
    } catch (const std::length_error& error) {
      return fmt::format("cannot be one: {}", error.what());
    }
    return {};
  }

  /// @throws std::length_error where the tile is too far from the others.
  void draw(const map_tile_t& tile) {
    GridMap& grid = file_.map.grid;
    for (std::size_t offset = 0; offset < kTileCells; ++offset) {
      const CellIndex cell = cell_at({tile.tile_x, tile.tile_y}, offset);
      const int percent = tile.occupancy[offset];
      if (percent >= 0)
        grid.occupancy.edit(cell) = {static_cast<std::uint32_t>(std::min(percent, 100)),
                                     kLoadedVisits};
      if (tile.marker_ids[offset] != kNoMarker)
        grid.markers.edit(cell).vote(tile.marker_ids[offset], kLoadedVotes);
    }
  }

  std::string on_markers(marker_map_t markers) {
    for (const marker_landmark_t& landmark : markers.landmarks)
      file_.map.landmarks.push_back(to_landmark(landmark));
    return {};
  }

  std::string on_walls(map_walls_t walls) {
    if (walls.part == 0) file_.map.walls = NdtMap{walls.spacing_m};
    for (const wall_cell_t& cell : walls.cells) {
      file_.map.walls.add({cell.column, cell.row, cell.count,
                           Eigen::Map<const Eigen::Vector2d>{cell.sum_m},
                           Eigen::Map<const Eigen::Vector3d>{cell.squares_m2}});
    }
    return {};
  }

  std::string on_graph(pose_graph_t graph) {
    for (const auto& vertex : graph.vertices)
      file_.map.graph.poses.emplace_back(vertex[0], vertex[1], vertex[2]);
    for (const graph_edge_t& message : graph.edges) {
      GraphEdge edge;
      edge.from = static_cast<std::size_t>(message.from_vertex);
      edge.to = static_cast<std::size_t>(message.to_vertex);
      edge.from_from_to = {message.pose[0], message.pose[1], message.pose[2]};
      const auto& upper = message.information;
      edge.information << upper[0], upper[1], upper[2], upper[1], upper[3], upper[4], upper[2],
          upper[4], upper[5];
      file_.map.graph.edges.push_back(edge);
    }
    return {};
  }

  std::string on_calibration(calibration_t calibration) {
    file_.map.calibration.mean = Eigen::Map<const Calibration>{calibration.mean};
    file_.map.calibration.covariance =
        Eigen::Map<const RowMajorCalibration>{calibration.covariance};
    return {};
  }

  std::optional<map_header_t> header_{};
  int num_messages_{0};  ///< after the header
  std::vector<Message> hashed_{};
  MapFile file_{};
};

}  // namespace

std::vector<Message> to_map_messages(const MapSnapshot& map, const MapFileInfo& info) {
  return messages_with_id(map, info, id_of(messages_with_id(map, info, 0)));
}

MapFile map_of(const std::vector<Message>& messages) {
  MapBuilder builder;
  for (const Message& message : messages)
    if (const std::string problem = builder.add(message); !problem.empty())
      throw std::logic_error{"a map of messages " + problem};
  return std::move(builder.file());
}

std::int64_t write_map_file(const std::filesystem::path& file, const MapSnapshot& map,
                            const MapFileInfo& info) {
  const std::int64_t map_id = id_of(messages_with_id(map, info, 0));
  try {
    LogWriter writer{file};
    for (const Message& message : messages_with_id(map, info, map_id))
      writer.write(message);
    writer.close_on_disk();
  } catch (const std::exception&) {
    std::error_code ignored;
    std::filesystem::remove(part_path_of(file), ignored);
    throw;
  }
  return map_id;
}

std::filesystem::path move_aside(const std::filesystem::path& file) {
  std::filesystem::path free;
  int number = 0;
  do {
    free = fmt::format("{}.{}", file.string(), ++number);
  } while (std::filesystem::exists(free));
  std::filesystem::rename(file, free);
  return free;
}

bool is_map_file(const std::filesystem::path& file) {
  const auto first = LogReader{file}.next();
  return first && first->channel == channels::kMapHeader.name;
}

MapFile read_map_file(const std::filesystem::path& file) {
  const auto fail = [&](const std::string& what) {
    throw SetupError{fmt::format("map '{}' {}", file.string(), what)};
  };
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    fail(error == std::errc::permission_denied ? "cannot be read: no permission"
                                               : "is not there, or is a folder");
  }
  LogReader reader{file};
  MapBuilder builder;
  while (const auto message = reader.next()) {
    const std::string problem = builder.add(*message);
    if (!problem.empty()) fail(problem);
  }
  if (reader.skipped_bytes() > 0) {
    fail(fmt::format("is damaged at byte {}: take a copy that is whole, or map again",
                     reader.first_skipped_offset()));
  }
  const std::string problem = builder.finish();
  if (!problem.empty()) fail(problem);
  return std::move(builder.file());
}

}  // namespace waymark
