// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/http/view_store.hpp"

#include "common/time/clock_step_detector.hpp"

#include <algorithm>

namespace waymark::viewer {
namespace {

constexpr Duration kFirstSpacing = std::chrono::milliseconds{200};
/// Longer than the interval between a client's requests for views.
constexpr std::int64_t kWatched_ms = 5000;

std::int64_t wall_clock_ms() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(now).count();
}

}  // namespace

void ViewStore::post(ViewPtr view, std::span<const PathPoint> path_growth) {
  {
    const std::scoped_lock lock{mutex_};
    store(view, path_growth);
  }
  changed_.notify_all();
}

bool ViewStore::try_post(const ViewPtr& view, std::span<const PathPoint> path_growth) {
  {
    const std::unique_lock lock{mutex_, std::try_to_lock};
    if (!lock) return false;
    store(view, path_growth);
  }
  changed_.notify_all();
  return true;
}

void ViewStore::store(const ViewPtr& view, std::span<const PathPoint> path_growth) {
  newest_ = view;
  path_.insert(path_.end(), path_growth.begin(), path_growth.end());
  // When message time jumps back, the history begins again.
  if (!history_.empty() && view->time < history_.back()->time) history_.clear();
  // A view before the first stamped message would stretch the history back to time 0.
  const bool is_first_stamp = !history_.empty() && history_.back()->time == Timestamp{} &&
                              view->time > Timestamp{} + ClockStepDetector::kLongestPause;
  if (is_first_stamp) history_.clear();
  if (history_.empty()) history_spacing_ = kFirstSpacing;
  if (!history_.empty() && view->time - history_.back()->time < history_spacing_) return;
  history_.push_back(view);
  if (history_.size() <= kMaxHistory) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < history_.size(); i += 2)
    history_[kept++] = history_[i];
  history_.resize(kept);
  history_spacing_ = (history_.back()->time - history_.front()->time) / static_cast<int>(kept - 1);
}

void ViewStore::note_reader() const {
  last_read_ms_ = wall_clock_ms();
}

bool ViewStore::is_watched() const {
  return wall_clock_ms() - last_read_ms_ < kWatched_ms;
}

ViewPtr ViewStore::newest() const {
  note_reader();
  const std::scoped_lock lock{mutex_};
  return newest_;
}

ViewPtr ViewStore::at(Timestamp time) const {
  note_reader();
  const std::scoped_lock lock{mutex_};
  if (!newest_ || newest_->time <= time) return newest_;
  const auto after = std::ranges::upper_bound(history_, time, {}, &LiveView::time);
  if (after != history_.begin()) return *std::prev(after);
  return history_.empty() ? newest_ : history_.front();
}

ViewPtr ViewStore::wait_for_newer(std::uint64_t number, std::chrono::milliseconds timeout) const {
  note_reader();
  std::unique_lock lock{mutex_};
  const auto is_newer = [&] {
    return newest_ && newest_->number > number;
  };
  changed_.wait_for(lock, timeout, [&] { return closed_ || is_newer(); });
  return !closed_ && is_newer() ? newest_ : nullptr;
}

std::vector<PathPoint> ViewStore::path(std::size_t first, std::size_t last) const {
  const std::scoped_lock lock{mutex_};
  last = std::min(last, path_.size());
  first = std::min(first, last);
  return {path_.begin() + static_cast<std::ptrdiff_t>(first),
          path_.begin() + static_cast<std::ptrdiff_t>(last)};
}

ViewStore::Span ViewStore::history() const {
  const std::scoped_lock lock{mutex_};
  if (!newest_) return {};
  return {history_.empty() ? newest_->time : history_.front()->time, newest_->time};
}

void ViewStore::close() {
  {
    const std::scoped_lock lock{mutex_};
    closed_ = true;
  }
  changed_.notify_all();
}

bool ViewStore::closed() const {
  const std::scoped_lock lock{mutex_};
  return closed_;
}

}  // namespace waymark::viewer
