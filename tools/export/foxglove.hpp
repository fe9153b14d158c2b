// SPDX-License-Identifier: BSD-3-Clause
// Foxglove's message schemas (https://docs.foxglove.dev/docs/visualization/message-schemas), as
// JSON.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/time/time.hpp"

#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace waymark::exporting {

using Json = nlohmann::json;

/// JSON schema of one of Foxglove's types: "Grid", "LaserScan", "PoseInFrame", "FrameTransforms",
/// "SceneUpdate", "CompressedImage".
/// @throws std::logic_error for any other.
std::string foxglove_schema(std::string_view type);

std::string base64(std::span<const std::uint8_t> bytes);

Json time_json(Timestamp time);
Json vector_json(double x, double y, double z);
/// A planar pose as a 3D one at height `z_m`.
Json pose_json(const Se2& pose, double z_m = 0.0);
Json transform_json(Timestamp time, std::string_view parent, std::string_view child,
                    const Se2& parent_from_child);

struct Colour {
  double r{0.0}, g{0.0}, b{0.0}, a{1.0};
};

Json colour_json(const Colour& colour);

/// A scene entity without shapes, frame "map"; an entity with the same id replaces it.
Json entity_json(Timestamp time, const std::string& id);

/// A closed line around the 2-sigma ellipse of a position.
Json ellipse_json(const Eigen::Vector2d& centre_m, const Eigen::Matrix2d& covariance,
                  const Colour& colour);

}  // namespace waymark::exporting
