// SPDX-License-Identifier: BSD-3-Clause
#include "common/node/node.hpp"

#include <utility>

namespace waymark {

std::string received_on(std::string_view channel) {
  return std::string{channel} + " received";
}

void Inbox::on_raw(std::string_view channel, std::function<void(const Message&)> handler) {
  channels_[std::string{channel}].raw = std::move(handler);
}

void Inbox::add_handler(std::string_view channel, std::int64_t fingerprint, Backlog backlog,
                        Handler handler) {
  ChannelHandlers& handlers = channels_[std::string{channel}];
  handlers.backlog = backlog;
  handlers.by_fingerprint[fingerprint] = std::move(handler);
}

void Inbox::deliver(const Message& message) {
  const auto found = channels_.find(message.channel);
  if (found == channels_.end()) return;
  if (found->second.raw) found->second.raw(message);
  if (found->second.by_fingerprint.empty()) return;
  const auto handler = found->second.by_fingerprint.find(fingerprint_of(message.payload));
  const RejectReason reason = handler == found->second.by_fingerprint.end()
                                  ? RejectReason::kWrongType
                                  : handler->second(message);
  if (reason == RejectReason::kNone) {
    counters_.add(received_on(message.channel));
  } else {
    counters_.add(message.channel + " rejected: " + std::string{to_string(reason)},
                  CountKind::kRejection);
  }
}

std::vector<Inbox::Subscription> Inbox::subscriptions() const {
  std::vector<Subscription> subscriptions;
  for (const auto& [channel, handlers] : channels_) {
    subscriptions.push_back({channel, handlers.backlog});
  }
  return subscriptions;
}

std::vector<Message> Outbox::take() {
  return std::exchange(messages_, {});
}

void Outbox::add(Message message) {
  messages_.push_back(std::move(message));
}

}  // namespace waymark
