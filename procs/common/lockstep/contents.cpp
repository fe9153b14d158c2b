// SPDX-License-Identifier: BSD-3-Clause
#include "common/lockstep/contents.hpp"

#include <algorithm>
#include <utility>

namespace waymark {
namespace {

// Bounds on memory; a window of ticks holds about 1 MB.
constexpr std::size_t kMaxWaitingBytes = std::size_t{32} << 20;
constexpr std::size_t kMaxWaitingMessages = 40000;
constexpr std::size_t kMaxUsedBytes = std::size_t{16} << 20;
constexpr std::size_t kMaxUsedMessages = 2000;

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
  if (messages_.contains(hash)) return false;
  waiting_.bytes += message.payload.size();
  waiting_.hashes.push_back(hash);
  messages_.emplace(hash, Entry{std::move(message)});
  while (waiting_.bytes > kMaxWaitingBytes || waiting_.hashes.size() > kMaxWaitingMessages)
    forget_oldest(waiting_);
  return true;
}

std::vector<Message> MessagePool::use(std::span<const std::int64_t> hashes) {
  std::vector<Message> messages;
  for (const std::int64_t hash : hashes) {
    Entry& entry = messages_.at(hash);
    messages.push_back(entry.message);
    if (std::exchange(entry.is_used, true)) continue;
    waiting_.bytes -= entry.message.payload.size();
    used_.bytes += entry.message.payload.size();
    used_.hashes.push_back(hash);
  }
  while (used_.bytes > kMaxUsedBytes || used_.hashes.size() > kMaxUsedMessages)
    forget_oldest(used_);
  return messages;
}

void MessagePool::forget_oldest(Queue& queue) {
  const auto oldest = messages_.find(queue.hashes.front());
  queue.hashes.pop_front();
  const bool is_of_used = &queue == &used_;
  if (oldest == messages_.end() || oldest->second.is_used != is_of_used) return;
  queue.bytes -= oldest->second.message.payload.size();
  messages_.erase(oldest);
}

}  // namespace waymark
