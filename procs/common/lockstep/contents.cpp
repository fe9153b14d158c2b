// SPDX-License-Identifier: BSD-3-Clause
#include "common/lockstep/contents.hpp"

#include <algorithm>

namespace waymark {
namespace {

// Far above what a window of ticks holds (about 1 MB), far below what hurts.
constexpr std::size_t kMaxPoolBytes = std::size_t{32} << 20;
constexpr std::size_t kMaxPoolMessages = 20000;
constexpr std::size_t kRememberedMessages = 2000;

}  // namespace

std::vector<channel_content_t> contents_of(std::vector<Message> messages) {
  std::ranges::sort(messages, comes_before);
  std::map<std::string, channel_content_t> by_channel;
  for (const Message& message : messages) {
    channel_content_t& content = by_channel[message.channel];
    content.channel = message.channel;
    content.hashes.push_back(content_hash(message));
    content.count = static_cast<int>(content.hashes.size());
  }
  std::vector<channel_content_t> contents;
  for (auto& [channel, content] : by_channel)
    contents.push_back(std::move(content));
  return contents;
}

bool MessagePool::add(Message message) {
  const std::int64_t hash = content_hash(message);
  if (messages_.contains(hash) || recently_taken_.contains(hash)) return false;
  bytes_ += message.payload.size();
  messages_.emplace(hash, std::move(message));
  by_arrival_.push_back(hash);
  while (bytes_ > kMaxPoolBytes || messages_.size() > kMaxPoolMessages)
    forget_oldest();
  // Hashes of taken messages stay in the arrival order until they are passed over.
  while (by_arrival_.size() > 2 * kMaxPoolMessages)
    forget_oldest();
  return true;
}

Message MessagePool::take(std::int64_t hash) {
  auto node = messages_.extract(hash);
  bytes_ -= node.mapped().payload.size();
  recently_taken_.insert(hash);
  recently_taken_by_age_.push_back(hash);
  if (recently_taken_by_age_.size() > kRememberedMessages) {
    recently_taken_.erase(recently_taken_by_age_.front());
    recently_taken_by_age_.pop_front();
  }
  return std::move(node.mapped());
}

void MessagePool::forget_oldest() {
  const auto oldest = messages_.find(by_arrival_.front());
  by_arrival_.pop_front();
  if (oldest == messages_.end()) return;
  bytes_ -= oldest->second.payload.size();
  messages_.erase(oldest);
}

}  // namespace waymark
