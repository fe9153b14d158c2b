// SPDX-License-Identifier: BSD-3-Clause
// Faults to inject into the messages of a recorded log.
#pragma once

#include "common/config/config.hpp"
#include "common/expect/expect_config.hpp"

#include <string>
#include <vector>

namespace waymark::faults {

/// Shares are probabilities, drawn independently for each sighting or frame. Times count from the
/// first message; pairs of numbers are flattened into one list.
struct FaultConfig {
  double wrong_id_share{0.0};
  double ghost_share{0.0};
  double flipped_share{0.0};
  double dropped_share{0.0};
  int every_id{-1};                    ///< -1 = ids stay
  std::vector<int> renamed_ids{};      ///< pairs: id, its new id
  std::vector<double> camera_off_s{};  ///< pairs: from, to
  std::vector<double> markers_off_s{};
  std::vector<double> lidar_off_s{};
  double odometry_distance_factor{1.0};
  double odometry_turn_factor{1.0};
  double odometry_drift_rad_per_m{0.0};

  void describe(Fields& fields);
  void check(const std::string& variant, Problems& problems) const;

  /// Keys of the faults that differ from the default.
  std::vector<std::string> configured() const;

  bool changes_ids() const { return every_id >= 0 || !renamed_ids.empty(); }

  /// The marker's new id by every_id and renamed_ids.
  int id_of(int id) const;
};

/// A row of the sweep's table: faults, and what is expected with them.
struct Variant {
  std::string name{};
  FaultConfig faults{};
  ExpectConfig expect{};

  void describe(Fields& fields);
};

struct VariantsFile {
  std::vector<Variant> variant{};

  void describe(Fields& fields);
  void check(Problems& problems) const;

  /// @throws ConfigError listing all names if there is none with this name.
  const Variant& named(const std::string& name) const;
};

}  // namespace waymark::faults
