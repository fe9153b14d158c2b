// SPDX-License-Identifier: BSD-3-Clause
#include "faults/fault_config.hpp"

#include <algorithm>
#include <cctype>
#include <set>

namespace waymark::faults {
namespace {

constexpr Range kFactor{0.1, 10.0};

bool is_name(const std::string& text) {
  return !text.empty() && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '-';
  });
}

}  // namespace

void FaultConfig::describe(Fields& fields) {
  fields.field("wrong_id_share", wrong_id_share, kFraction,
               "share of sightings that get the id of another marker of the log");
  fields.field("ghost_share", ghost_share, kFraction,
               "share of frames that show a marker which is not there: a sighting of another frame "
               "of the log, with any id of the log");
  fields.field("flipped_share", flipped_share, kFraction,
               "share of sightings whose two solutions of the square are exchanged");
  fields.field("dropped_share", dropped_share, kFraction, "share of sightings that are missing");
  fields.field("every_id", every_id, {-1.0, 1e6}, "id of all markers; -1 = as they are");
  fields.field("renamed_ids", renamed_ids, {0.0, 1e6}, "pairs: an id, the id that it gets");
  fields.field("camera_off_s", camera_off_s, kNotNegative,
               "pairs from, to [s]: no images and no frames of markers");
  fields.field("markers_off_s", markers_off_s, kNotNegative,
               "pairs from, to [s]: frames show no marker");
  fields.field("lidar_off_s", lidar_off_s, kNotNegative, "pairs from, to [s]: no scans");
  fields.field("odometry_distance_factor", odometry_distance_factor, kFactor,
               "every step of odometry is longer by this factor");
  fields.field("odometry_turn_factor", odometry_turn_factor, kFactor,
               "every turn of odometry is larger by this factor");
  fields.field("odometry_drift_rad_per_m", odometry_drift_rad_per_m, {-1.0, 1.0},
               "turn that odometry adds per distance");
}

void FaultConfig::check(const std::string& variant, Problems& problems) const {
  const auto check_pairs = [&](const char* key, std::size_t size) {
    if (size % 2 != 0) problems.add(variant + ".faults." + key, "expected pairs of numbers");
  };
  check_pairs("renamed_ids", renamed_ids.size());
  for (const auto& [key, times_s] :
       {std::pair{"camera_off_s", &camera_off_s}, std::pair{"markers_off_s", &markers_off_s},
        std::pair{"lidar_off_s", &lidar_off_s}}) {
    check_pairs(key, times_s->size());
    for (std::size_t i = 0; i + 1 < times_s->size(); i += 2) {
      if ((*times_s)[i] >= (*times_s)[i + 1])
        problems.add(variant + ".faults." + key, "expected pairs with the earlier time first");
    }
  }
}

std::vector<std::string> FaultConfig::configured() const {
  std::vector<std::string> keys;
  const auto add = [&](const char* key, bool is_configured) {
    if (is_configured) keys.emplace_back(key);
  };
  add("wrong_id_share", wrong_id_share > 0.0);
  add("ghost_share", ghost_share > 0.0);
  add("flipped_share", flipped_share > 0.0);
  add("dropped_share", dropped_share > 0.0);
  add("every_id", every_id >= 0);
  add("renamed_ids", !renamed_ids.empty());
  add("camera_off_s", !camera_off_s.empty());
  add("markers_off_s", !markers_off_s.empty());
  add("lidar_off_s", !lidar_off_s.empty());
  add("odometry_distance_factor", odometry_distance_factor != 1.0);
  add("odometry_turn_factor", odometry_turn_factor != 1.0);
  add("odometry_drift_rad_per_m", odometry_drift_rad_per_m != 0.0);
  return keys;
}

int FaultConfig::id_of(int id) const {
  if (every_id >= 0) return every_id;
  for (std::size_t i = 0; i + 1 < renamed_ids.size(); i += 2) {
    if (renamed_ids[i] == id) return renamed_ids[i + 1];
  }
  return id;
}

void Variant::describe(Fields& fields) {
  fields.field("name", name, "of the row: letters, digits, _ -");
  fields.section("faults", faults);
  fields.section("expect", expect);
}

void VariantsFile::describe(Fields& fields) {
  fields.list("variant", variant, "one row of the table each");
}

void VariantsFile::check(Problems& problems) const {
  std::set<std::string> names;
  for (const Variant& v : variant) {
    if (!is_name(v.name))
      problems.add("variant.name", "got '" + v.name + "', expected letters, digits, _ -");
    if (!names.insert(v.name).second) problems.add("variant.name", v.name + " is there twice");
    v.faults.check(v.name, problems);
  }
}

const Variant& VariantsFile::named(const std::string& name) const {
  std::string names;
  for (const Variant& v : variant) {
    if (v.name == name) return v;
    names += " " + v.name;
  }
  throw ConfigError{{"no variant '" + name + "'; there are:" + names}};
}

}  // namespace waymark::faults
