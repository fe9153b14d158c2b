// SPDX-License-Identifier: BSD-3-Clause
// Passes views from the node, which posts them, to the threads of the web server, which read them.
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
class ViewStore {
 public:
  /// Stores a view and appends the path's new points.
  void post(ViewPtr view, std::span<const PathPoint> path_growth);

  /// Like post(), but does nothing when a reader holds the lock.
  /// @return true when the view was posted.
  bool try_post(const ViewPtr& view, std::span<const PathPoint> path_growth);

  /// The newest view; null before the first.
  ViewPtr newest() const;

  /// The last kept view up to `time`; the earliest kept one if all are later; null before the first
  /// post. At most kMaxHistory views are kept, about evenly spaced in message time.
  ViewPtr at(Timestamp time) const;

  /// Waits for a view with a higher number. @return null after `timeout` and when closed.
  ViewPtr wait_for_newer(std::uint64_t number, std::chrono::milliseconds timeout) const;

  /// Points [first, last) of the path.
  std::vector<PathPoint> path(std::size_t first, std::size_t last) const;

  struct Span {
    Timestamp first{};
    Timestamp last{};
  };

  Span history() const;

  /// True when a client has read a view within the last five seconds of wall-clock time.
  bool is_watched() const;

  /// Makes all waiting threads return.
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
