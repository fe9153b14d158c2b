// SPDX-License-Identifier: BSD-3-Clause
// The simulator as a process: simulates tick by tick and publishes the measurements.
#pragma once

#include "common/runtime/run_simulator.hpp"
#include "sim/core/simulation.hpp"
#include "sim/sim_config.hpp"
#include "sim/truth_files.hpp"

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// Publishes CAMERA, LIDAR, ODOMETRY and TRUE_POSE; with route.source = command it follows
/// DRIVE_COMMAND. With an output folder it writes scenario.toml, robot.toml, truth_markers.csv,
/// truth.tum, and truth_marker_moves.csv when the scenario moves markers.
class SimNode final : public TickSource {
 public:
  using Config = SimConfig;
  static constexpr ProcessTraits kTraits{
      "sim", "Simulates a TurtleBot3 Waffle Pi in a corridor: wheels, LiDAR, camera.", false};

  static constexpr std::array<std::string_view, 5> kFiles{
      "scenario.toml", "robot.toml", "truth_markers.csv", "truth_marker_moves.csv", "truth.tum"};

  /// @throws SetupError when the output folder or the renderer cannot be used.
  SimNode(const Config& config, Inbox& inbox);

  std::vector<std::string> participants() const override { return config_.run.participants; }

  int window_ticks() const override { return config_.run.window_ticks; }

  std::int64_t run_id() const override;

  /// @throws SetupError when the output folder's files cannot be written.
  void begin() override;

  bool finished() const override { return simulation_->finished(); }

  std::vector<Message> advance(Timestamp& tick_end) override;

  double progress_fraction() const override { return simulation_->progress_fraction(); }

  std::string progress_text() const override;
  void finish() override;

 private:
  void write_start_files();
  void write_moves(const std::vector<MovedMarker>& moved);
  void handle(const twist2D_t& command);

  Config config_;
  Inbox& inbox_;
  std::optional<Simulation> simulation_;
  std::optional<TruthTrajectory> truth_;
  std::vector<MovedMarker> moved_markers_;
};

}  // namespace waymark
