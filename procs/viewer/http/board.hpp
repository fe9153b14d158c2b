// SPDX-License-Identifier: BSD-3-Clause
// Where the node posts what the page shows, and the server's threads read it.
#pragma once

#include "viewer/http/live_view.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace waymark::viewer {

using ViewPtr = std::shared_ptr<const LiveView>;

/// Thread-safe. The lock is held only to copy pointers and path points, never to serialise or send.
class Board {
 public:
  /// Posts a view and the points by which the path has grown.
  void post(ViewPtr view, std::span<const PathPoint> path_growth);

  /// The same, unless a reader is at the board right now: then nothing happens.
  /// @return whether it is posted.
  bool try_post(const ViewPtr& view, std::span<const PathPoint> path_growth);

  /// The newest view; nothing before the first.
  ViewPtr newest() const;

  /// The last view up to that time, or the first one. Of the past at most kMaxHistory views are
  /// kept, evenly in message time.
  ViewPtr at(Timestamp time) const;

  /// Waits for a view newer than that number. @return nothing after `timeout` and when closed.
  ViewPtr wait_for_newer(std::uint64_t number, std::chrono::milliseconds timeout) const;

  std::vector<PathPoint> path(std::size_t first, std::size_t last) const;

  struct Span {
    Timestamp first{};
    Timestamp last{};
  };

  Span history() const;

  /// Somebody has looked within the last seconds of wall-clock time, or waits to.
  bool is_watched() const;

  /// Ends all waiting.
  void close();
  bool closed() const;

  static constexpr std::size_t kMaxHistory = 600;

 private:
  static constexpr std::int64_t kNever_ms = -1'000'000'000;

  void note_reader() const;
  void store(const ViewPtr& view, std::span<const PathPoint> path_growth);

  mutable std::atomic<std::int64_t> last_read_ms_{kNever_ms};
  mutable std::mutex mutex_;
  mutable std::condition_variable changed_;
  ViewPtr newest_{};
  std::vector<ViewPtr> history_{};
  Duration history_spacing_{0};
  std::vector<PathPoint> path_{};
  bool closed_{false};
};

}  // namespace waymark::viewer
