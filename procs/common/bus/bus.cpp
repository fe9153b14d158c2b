// SPDX-License-Identifier: BSD-3-Clause
#include "common/bus/bus.hpp"

#include "common/bus/datagram_filter.hpp"

#include <lcm/lcm.h>

#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <map>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace waymark {
namespace {

constexpr std::string_view kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";
constexpr std::size_t kMaxQueuedBytesPerChannel = std::size_t{16} << 20;
// Small messages cost more than their payload; 10000 of them are minutes of any of our channels.
constexpr std::size_t kMaxQueuedMessagesPerChannel = 10000;
constexpr std::size_t kMaxLargePayloadBytes = std::size_t{4} << 20;
constexpr int kHandleTimeout_ms = 50;
// LCM's own queue only bridges the moments in which our thread is not scheduled.
constexpr int kLcmQueueCapacity = 200;

SetupError no_network(const std::string& url) {
  return SetupError{"cannot join the LCM network " + url +
                    "\n  without a network, give multicast a route over loopback:"
                    "\n    ip link set lo up"
                    "\n    ip route add 224.0.0.0/4 dev lo"
                    "\n  or set another --lcm-url (see README, \"No multicast route\")"};
}

}  // namespace

std::string lcm_url_or_default(const std::string& given_url) {
  if (!given_url.empty()) return given_url;
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  if (from_environment != nullptr && *from_environment != '\0') return from_environment;
  return std::string{kDefaultUrl};
}

class Bus::Implementation {
 public:
  Implementation(const std::string& url, const std::vector<Inbox::Subscription>& subscriptions,
                 LargeMessages large_messages, const ChannelNames& names)
      : max_payload_bytes_{large_messages == LargeMessages::kAccepted ? kMaxLargePayloadBytes
                                                                      : kMaxPayloadBytes},
        names_{names},
        lcm_{lcm_create(url.c_str()), &lcm_destroy} {
    if (lcm_ == nullptr) throw no_network(url);
    for (const Inbox::Subscription& subscription : subscriptions) {
      queues_[subscription.channel].backlog = subscription.backlog;
      const std::string name{names_.on_network(subscription.channel)};
      std::vector<std::string>& channels = channels_of_[name];
      channels.push_back(subscription.channel);
      if (channels.size() > 1) continue;  // several channels on one name, told apart by type
      lcm_subscription_t* handle = lcm_subscribe(lcm_.get(), name.c_str(), &on_receive, this);
      if (handle == nullptr) throw no_network(url);
      lcm_subscription_set_queue_capacity(handle, kLcmQueueCapacity);
    }
    if (subscriptions.empty()) return;
    // A TCP server that is not there shows nowhere else, and waiting for it would abort.
    if (!is_connected()) throw no_network(url);
    if (large_messages == LargeMessages::kRefused) filter_.emplace(url);
    receiver_ = std::thread{[this] {
      receive_until_stopped();
    }};
  }

  ~Implementation() {
    stop_ = true;
    if (receiver_.joinable()) receiver_.join();
  }

  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;

  std::optional<Message> receive(std::chrono::milliseconds timeout) {
    std::unique_lock lock{mutex_};
    arrived_.wait_for(lock, timeout, [this] { return !order_.empty(); });
    if (order_.empty()) return std::nullopt;
    Queue& queue = *order_.front();
    order_.pop_front();
    Message message = std::move(queue.messages.front());
    queue.messages.pop_front();
    queue.bytes -= message.payload.size();
    return message;
  }

  void publish(const Message& message) {
    if (message.payload.size() > kMaxPayloadBytes) {
      throw std::logic_error{message.channel + ": a message of " +
                             std::to_string(message.payload.size()) +
                             " bytes does not fit one datagram"};
    }
    const std::string name{names_.on_network(message.channel)};
    if (name.empty()) throw std::logic_error{message.channel + ": has no name on this network"};
    // The sender never learns of loss: lockstep and counters find it.
    lcm_publish(lcm_.get(), name.c_str(), message.payload.data(),
                static_cast<unsigned>(message.payload.size()));
  }

  void collect_counts(Counters& counters) {
    const std::lock_guard lock{mutex_};
    if (const std::int64_t dropped = filter_ ? filter_->take_dropped() : 0; dropped > 0)
      counts_.add("datagrams dropped: no whole message of LCM, or too many at once",
                  CountKind::kLoss, dropped);
    for (const auto& [name, count] : counts_.all())
      counters.add(name, count.kind, count.value);
    counts_ = {};
  }

 private:
  struct Queue {
    Backlog backlog{Backlog::kKeepAll};
    std::deque<Message> messages{};
    std::size_t bytes{0};
  };

  static void on_receive(const lcm_recv_buf_t* buffer, const char* channel, void* self) {
    // Nothing may be thrown through C.
    try {
      static_cast<Implementation*>(self)->enqueue(buffer, channel);
    } catch (...) {
    }
  }

  void enqueue(const lcm_recv_buf_t* buffer, const char* name) {
    const std::lock_guard lock{mutex_};
    const auto found = channels_of_.find(std::string_view{name});
    if (found == channels_of_.end()) return;  // a name without end, from a broken datagram
    // liblcm 1.3.1 reports size -1 for a datagram without a channel end.
    if (buffer->data == nullptr || buffer->data_size > max_payload_bytes_) {
      counts_.add(found->second.front() + " rejected: too large", CountKind::kRejection);
      return;
    }
    const std::span bytes{static_cast<const std::uint8_t*>(buffer->data), buffer->data_size};
    const std::string& channel = ChannelNames::of_type(found->second, fingerprint_of(bytes));
    const auto time = time_of(bytes);
    if (!time) {
      counts_.add(channel + " rejected: bad time", CountKind::kRejection);
      return;
    }
    push(channel, queues_[channel], {channel, *time, {bytes.begin(), bytes.end()}});
  }

  void push(const std::string& channel, Queue& queue, Message message) {
    if (queue.backlog == Backlog::kNewestOnly && !queue.messages.empty()) {
      counts_.add(channel + " skipped: newer one came", CountKind::kEvent,
                  static_cast<std::int64_t>(queue.messages.size()));
      std::erase(order_, &queue);
      queue.messages.clear();
      queue.bytes = 0;
    }
    if (queue.bytes + message.payload.size() > kMaxQueuedBytesPerChannel ||
        queue.messages.size() >= kMaxQueuedMessagesPerChannel) {
      counts_.add(channel + " dropped: queue full", CountKind::kLoss);
      return;
    }
    queue.bytes += message.payload.size();
    queue.messages.push_back(std::move(message));
    order_.push_back(&queue);
    arrived_.notify_one();
  }

  bool is_connected() const { return lcm_get_fileno(lcm_.get()) >= 0; }

  void receive_until_stopped() {
    while (!stop_ && is_connected())
      lcm_handle_timeout(lcm_.get(), kHandleTimeout_ms);
    const std::lock_guard lock{mutex_};
    if (!stop_) counts_.add("connection lost, messages dropped", CountKind::kLoss);
  }

  std::size_t max_payload_bytes_;
  ChannelNames names_;
  std::map<std::string, std::vector<std::string>, std::less<>> channels_of_;  ///< network -> ours
  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm_;
  std::optional<DatagramFilter> filter_;
  std::mutex mutex_;
  std::condition_variable arrived_;
  std::map<std::string, Queue, std::less<>> queues_;
  std::deque<Queue*> order_;  ///< queue of each waiting message, by arrival
  Counters counts_;
  std::atomic<bool> stop_{false};
  std::thread receiver_;
};

void check_network(const std::string& url) {
  // Without a subscription LCM would not try to listen.
  const Bus bus{url, {{"CHECK"}}};
}

Bus::Bus(const std::string& url, const std::vector<Inbox::Subscription>& subscriptions,
         LargeMessages large_messages, const ChannelNames& names)
    : implementation_{std::make_unique<Implementation>(url, subscriptions, large_messages, names)} {
}

Bus::~Bus() = default;

std::optional<Message> Bus::receive(std::chrono::milliseconds timeout) {
  return implementation_->receive(timeout);
}

void Bus::publish(const Message& message) {
  implementation_->publish(message);
}

void Bus::collect_counts(Counters& counters) {
  implementation_->collect_counts(counters);
}

}  // namespace waymark
