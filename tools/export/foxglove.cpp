// SPDX-License-Identifier: BSD-3-Clause
#include "export/foxglove.hpp"

#include "common/geometry/principal_axes.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

namespace waymark::exporting {
namespace {

using Fields = std::vector<std::pair<std::string, Json>>;

Json object(const Fields& fields) {
  Json properties = Json::object();
  for (const auto& [name, schema] : fields)
    properties[name] = schema;
  return {{"type", "object"}, {"properties", properties}};
}

Json list_of(const Json& items) {
  return {{"type", "array"}, {"items", items}};
}

const Json kNumber = {{"type", "number"}};
const Json kInteger = {{"type", "integer"}};
const Json kText = {{"type", "string"}};
const Json kFlag = {{"type", "boolean"}};
const Json kBytes = {{"type", "string"}, {"contentEncoding", "base64"}};

Json time_schema() {
  return object({{"sec", kInteger}, {"nsec", kInteger}});
}

Json vector_schema() {
  return object({{"x", kNumber}, {"y", kNumber}, {"z", kNumber}});
}

Json quaternion_schema() {
  return object({{"x", kNumber}, {"y", kNumber}, {"z", kNumber}, {"w", kNumber}});
}

Json pose_schema() {
  return object({{"position", vector_schema()}, {"orientation", quaternion_schema()}});
}

Json colour_schema() {
  return object({{"r", kNumber}, {"g", kNumber}, {"b", kNumber}, {"a", kNumber}});
}

Json stamped(Fields fields) {
  fields.insert(fields.begin(), {{"timestamp", time_schema()}, {"frame_id", kText}});
  return object(fields);
}

Json grid_schema() {
  const Json field = object({{"name", kText}, {"offset", kInteger}, {"type", kInteger}});
  return stamped({{"pose", pose_schema()},
                  {"column_count", kInteger},
                  {"cell_size", object({{"x", kNumber}, {"y", kNumber}})},
                  {"row_stride", kInteger},
                  {"cell_stride", kInteger},
                  {"fields", list_of(field)},
                  {"data", kBytes}});
}

Json laser_scan_schema() {
  return stamped({{"pose", pose_schema()},
                  {"start_angle", kNumber},
                  {"end_angle", kNumber},
                  {"ranges", list_of(kNumber)},
                  {"intensities", list_of(kNumber)}});
}

Json frame_transforms_schema() {
  const Json transform = object({{"timestamp", time_schema()},
                                 {"parent_frame_id", kText},
                                 {"child_frame_id", kText},
                                 {"translation", vector_schema()},
                                 {"rotation", quaternion_schema()}});
  return object({{"transforms", list_of(transform)}});
}

Json scene_update_schema() {
  const Json cube =
      object({{"pose", pose_schema()}, {"size", vector_schema()}, {"color", colour_schema()}});
  const Json line = object({{"type", kInteger},
                            {"pose", pose_schema()},
                            {"thickness", kNumber},
                            {"scale_invariant", kFlag},
                            {"points", list_of(vector_schema())},
                            {"color", colour_schema()},
                            {"colors", list_of(colour_schema())},
                            {"indices", list_of(kInteger)}});
  const Json text = object({{"pose", pose_schema()},
                            {"billboard", kFlag},
                            {"font_size", kNumber},
                            {"scale_invariant", kFlag},
                            {"color", colour_schema()},
                            {"text", kText}});
  Fields entity{{"timestamp", time_schema()},
                {"frame_id", kText},
                {"id", kText},
                {"lifetime", time_schema()},
                {"frame_locked", kFlag},
                {"metadata", list_of(object({{"key", kText}, {"value", kText}}))},
                {"cubes", list_of(cube)},
                {"lines", list_of(line)},
                {"texts", list_of(text)}};
  for (const char* shape : {"arrows", "spheres", "cylinders", "triangles", "models"})
    entity.emplace_back(shape, list_of({{"type", "object"}}));
  const Json deletion = object({{"timestamp", time_schema()}, {"type", kInteger}, {"id", kText}});
  return object({{"deletions", list_of(deletion)}, {"entities", list_of(object(entity))}});
}

}  // namespace

std::string foxglove_schema(std::string_view type) {
  Json schema;
  if (type == "Grid") schema = grid_schema();
  if (type == "LaserScan") schema = laser_scan_schema();
  if (type == "PoseInFrame") schema = stamped({{"pose", pose_schema()}});
  if (type == "FrameTransforms") schema = frame_transforms_schema();
  if (type == "SceneUpdate") schema = scene_update_schema();
  if (type == "CompressedImage") schema = stamped({{"data", kBytes}, {"format", kText}});
  if (schema.is_null()) throw std::logic_error{"no schema foxglove." + std::string{type}};
  schema["title"] = "foxglove." + std::string{type};
  return schema.dump();
}

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = (group << 8) | (k < count ? bytes[i + k] : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += k <= count ? kDigits[(group >> (18 - 6 * k)) & 63U] : '=';
  }
  return text;
}

Json time_json(Timestamp time) {
  const std::int64_t us = to_us(time);
  return {{"sec", us / 1'000'000}, {"nsec", us % 1'000'000 * 1000}};
}

Json vector_json(double x, double y, double z) {
  return {{"x", x}, {"y", y}, {"z", z}};
}

Json rotation_json(double yaw_rad) {
  return {{"x", 0.0}, {"y", 0.0}, {"z", std::sin(yaw_rad / 2)}, {"w", std::cos(yaw_rad / 2)}};
}

Json pose_json(const Se2& pose, double z_m) {
  return {{"position", vector_json(pose.x(), pose.y(), z_m)},
          {"orientation", rotation_json(pose.theta())}};
}

Json transform_json(Timestamp time, std::string_view parent, std::string_view child,
                    const Se2& parent_from_child) {
  return {{"timestamp", time_json(time)},
          {"parent_frame_id", parent},
          {"child_frame_id", child},
          {"translation", vector_json(parent_from_child.x(), parent_from_child.y(), 0.0)},
          {"rotation", rotation_json(parent_from_child.theta())}};
}

Json colour_json(const Colour& colour) {
  return {{"r", colour.r}, {"g", colour.g}, {"b", colour.b}, {"a", colour.a}};
}

Json entity_json(Timestamp time, const std::string& id) {
  Json entity = {{"timestamp", time_json(time)},
                 {"frame_id", "map"},
                 {"id", id},
                 {"lifetime", {{"sec", 0}, {"nsec", 0}}},  // until it is replaced
                 {"frame_locked", true}};
  for (const char* list : {"metadata", "arrows", "cubes", "spheres", "cylinders", "lines",
                           "triangles", "texts", "models"})
    entity[list] = Json::array();
  return entity;
}

Json ellipse_json(const Eigen::Vector2d& centre_m, const Eigen::Matrix2d& covariance,
                  const Colour& colour) {
  constexpr int kCorners = 36;
  constexpr double kSigmas = 2.0;
  constexpr int kLineLoop = 1;
  const PrincipalAxes axes = principal_axes(covariance);
  const Eigen::Vector2d radii_m = kSigmas * axes.values.cwiseMax(0.0).cwiseSqrt();
  Json points = Json::array();
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kCorners;
    const Eigen::Vector2d on_axes{radii_m.x() * std::cos(angle), radii_m.y() * std::sin(angle)};
    const Eigen::Vector2d at = centre_m + axes.directions * on_axes;
    points.push_back(vector_json(at.x(), at.y(), 0.0));
  }
  return {{"type", kLineLoop},       {"pose", pose_json(Se2{})}, {"thickness", 2.0},
          {"scale_invariant", true}, {"points", points},         {"color", colour_json(colour)},
          {"colors", Json::array()}, {"indices", Json::array()}};
}

}  // namespace waymark::exporting
