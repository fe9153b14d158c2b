// SPDX-License-Identifier: BSD-3-Clause
// The headless viewer: writes everything that slam publishes into files.
#pragma once

#include "common/node/node.hpp"
#include "viewer/core/scene/change_monitor.hpp"
#include "viewer/core/scene/current_map.hpp"
#include "viewer/core/scene/scene.hpp"
#include "viewer/files/output_folder.hpp"
#include "viewer/http/live_feed.hpp"
#include "viewer/http/page_server.hpp"
#include "viewer/http/view_store.hpp"
#include "viewer/pacer.hpp"
#include "viewer/scene_updater.hpp"
#include "viewer/viewer_config.hpp"

#include <cstddef>
#include <memory>
#include <optional>
#include <string>

namespace waymark {

class ViewerNode final : public Node {
 public:
  using Config = ViewerConfig;
  static constexpr ProcessTraits kTraits{
      .name = "viewer",
      .purpose = "Writes the map, the trajectory and pictures of a run into a folder (--out DIR).",
      .joins_midway = true};

  /// @throws SetupError when there is no folder to write to.
  ViewerNode(const Config& config, Inbox& inbox, Outbox& outbox);

  /// @throws SetupError for an invalid address or token of the live page.
  static void check(const Config& config);

  /// Writes everything once more, if anything has come from slam. With a log and a live page, then
  /// waits for Ctrl-C.
  void finish() override;

  /// Shows on the live page what is silent.
  void poll(const WallClock& clock) override;

  /// True when a file could not be written, now or earlier, or a map was too large for its files.
  bool failed() const override {
    return archive_failed_ || map_was_cut_ || !folder_.failed_files().empty();
  }

 private:
  void subscribe(Inbox& inbox);
  /// Messages that go into the scene, and to the page if there is one.
  template <class Type>
  void subscribe_both(Inbox& inbox, Channel<Type> channel, Backlog backlog = Backlog::kKeepAll);
  /// Messages that only the page shows.
  void subscribe_page(Inbox& inbox);
  void start_page();
  std::optional<viewer::PageCommands> page_commands() const;
  /// Switches to that map when it is new, after a restart or a reset of slam.
  /// @return false for a late message of an earlier map.
  bool follow(std::int64_t map_id, Timestamp time);
  /// Writes the files of the scene's map to a folder of its own.
  void archive_map(std::int64_t map_id);
  void write_files();
  /// Once per write period: writes the data files and one of the pictures, in turn. All pictures at
  /// once would delay a lockstep run. Large maps take longer and are written less often (Pacer).
  void write_when_due(Timestamp time);
  /// Writes the file, or, without data, removes it: it is of an earlier run.
  template <class MakeBytes>
  void write_or_remove(const std::string& name, bool has_data, MakeBytes make_bytes);
  void write_data();
  void write_final_trajectory();
  void write_graph();
  void write_map_picture();
  void write_marker_layer();
  void write_scan_and_plain_map();

  Config config_;
  viewer::Scene scene_{};
  viewer::SceneUpdater updater_;
  viewer::ChangeMonitor change_monitor_{};
  viewer::OutputFolder folder_;
  viewer::Pacer pacer_;
  viewer::CurrentMap current_map_{};
  int num_archived_{0};
  bool archive_failed_{false};
  bool map_was_cut_{false};
  std::optional<Timestamp> last_write_time_{};
  std::size_t next_picture_{0};
  std::vector<pose_graph_t> graph_parts_{};
  viewer::ViewStore views_{};
  std::optional<viewer::LiveFeed> live_feed_{};
  std::unique_ptr<viewer::PageServer> page_server_{};
};

}  // namespace waymark
