// SPDX-License-Identifier: BSD-3-Clause
#include "common/bus/bus.hpp"

#include "common/bus/channel_owners.hpp"
#include "common/bus/datagram_receiver.hpp"
#include "common/logging/logging.hpp"
#include "common/messages/codec.hpp"

#include <fmt/format.h>
#include <lcm/lcm.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <condition_variable>
#include <cstdlib>
#include <deque>
#include <map>
#include <mutex>
#include <stdexcept>
#include <system_error>
#include <thread>

namespace waymark {
namespace {

constexpr std::string_view kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";
constexpr std::size_t kMaxQueuedBytesPerChannel = std::size_t{16} << 20;
// Bounds the number of small messages, which cost more than their payload. 10000 of them are
// minutes of any of our channels.
constexpr std::size_t kMaxQueuedMessagesPerChannel = 10000;
constexpr std::size_t kMaxLargePayloadBytes = std::size_t{4} << 20;
constexpr int kHandleTimeout_ms = 50;
// LCM's own queue only has to cover the time in which the receiver thread is not scheduled.
constexpr int kLcmQueueCapacity = 200;
constexpr std::chrono::seconds kBetweenWarnings{10};
constexpr const char* kMalformed = "datagrams rejected: no whole message of LCM";
constexpr const char* kFragments =
    "datagrams rejected: parts of messages above 65 kB, which need --large-messages";

// A second of 640 x 480 RGB images at 10 Hz.
constexpr int kLargeBuffer_bytes = 8 << 20;
constexpr std::string_view kMulticastScheme = "udpm://";
// Kinds of networks that liblcm 1.3.1 knows.
constexpr std::array kSchemes{kMulticastScheme, std::string_view{"tcpq://"},
                              std::string_view{"memq://"}, std::string_view{"file://"}};

/// @throws SetupError for a URL that is wrong whatever the network is.
void check_url(const std::string& url) {
  const auto is_of = [&](std::string_view scheme) {
    return url.starts_with(scheme);
  };
  if (std::ranges::none_of(kSchemes, is_of)) {
    throw SetupError{fmt::format(
        "cannot join the LCM network {}: expected udpm://ADDRESS:PORT?ttl=N, such as {}, or "
        "tcpq://HOST:PORT",
        url, kDefaultUrl)};
  }
  multicast_group_of(url);
}

SetupError no_network(const std::string& url) {
  if (!url.starts_with(kMulticastScheme))
    return SetupError{"cannot join the LCM network " + url + ": is its server there?"};
  return SetupError{"cannot join the LCM network " + url +
                    "\n  without a network, give multicast a route over loopback:"
                    "\n    ip link set lo up"
                    "\n    ip route add 224.0.0.0/4 dev lo"
                    "\n  or set another --lcm-url (see docs/reference.md, \"No multicast route\")"};
}

/// False for statuses, commands and (in lockstep) acknowledgements: several processes may publish
/// them.
bool has_one_publisher(std::string_view channel) {
  using namespace channels;
  return !channel.ends_with("_STATUS") && channel != kSlamCommand.name &&
         channel != kMbotSystemReset.name && channel != kDriveCommand.name && channel != kAck.name;
}

}  // namespace

std::string lcm_url_or_default(const std::string& given_url) {
  if (!given_url.empty()) return given_url;
  const char* from_environment = std::getenv("LCM_DEFAULT_URL");
  if (from_environment != nullptr && *from_environment != '\0') return from_environment;
  return std::string{kDefaultUrl};
}

std::string with_large_buffer(const std::string& lcm_url) {
  if (!lcm_url.starts_with(kMulticastScheme) || lcm_url.find("recv_buf_size=") != lcm_url.npos)
    return lcm_url;
  const bool has_options = lcm_url.find('?') != lcm_url.npos;
  return fmt::format("{}{}recv_buf_size={}", lcm_url, has_options ? "&" : "?", kLargeBuffer_bytes);
}

class Bus::Implementation {
 public:
  Implementation(const std::string& url, const std::vector<Inbox::Subscription>& subscriptions,
                 LargeMessages large_messages, const ChannelNames& names, Publishers publishers)
      : max_payload_bytes_{large_messages == LargeMessages::kAccepted ? kMaxLargePayloadBytes
                                                                      : kMaxPayloadBytes},
        names_{names},
        publishers_{publishers},
        lcm_{create(url, large_messages), &lcm_destroy} {
    if (lcm_ == nullptr) throw no_network(url);
    const auto group =
        large_messages == LargeMessages::kRefused ? multicast_group_of(url) : std::nullopt;
    for (const Inbox::Subscription& subscription : subscriptions) {
      queues_[subscription.channel].backlog = subscription.backlog;
      const std::string name{names_.on_network(subscription.channel)};
      std::vector<std::string>& channels = channels_of_[name];
      channels.push_back(subscription.channel);
      if (channels.size() > 1 || group) continue;  // subscribed already, or datagrams_ receives
      lcm_subscription_t* handle = lcm_subscribe(lcm_.get(), name.c_str(), &on_receive, this);
      if (handle == nullptr) throw no_network(url);
      lcm_subscription_set_queue_capacity(handle, kLcmQueueCapacity);
    }
    if (subscriptions.empty()) return;
    if (group) {
      join(*group, url);
    } else if (!is_connected()) {
      // Where a TCP server is missing, LCM reports no error, but gives an invalid descriptor, and
      // waiting on that would abort.
      throw no_network(url);
    }
    receiver_ = std::thread{[this] {
      if (datagrams_) {
        receive_datagrams();
      } else {
        receive_from_lcm();
      }
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
    // UDP does not report loss: lockstep and counters detect it.
    lcm_publish(lcm_.get(), name.c_str(), message.payload.data(),
                static_cast<unsigned>(message.payload.size()));
  }

  HeardChannels heard() const {
    const std::lock_guard lock{mutex_};
    return heard_;
  }

  void collect_counts(Counters& counters) {
    const std::lock_guard lock{mutex_};
    if (const std::int64_t lost = datagrams_ ? datagrams_->take_overflowed() : 0; lost > 0)
      counts_.add("datagrams lost: too many at once", CountKind::kLoss, lost);
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

  /// @return nullptr if the network cannot be joined.
  static lcm_t* create(const std::string& url, LargeMessages large_messages) {
    check_url(url);
    const bool is_large = large_messages == LargeMessages::kAccepted;
    return lcm_create((is_large ? with_large_buffer(url) : url).c_str());
  }

  void join(const MulticastGroup& group, const std::string& url) {
    try {
      datagrams_.emplace(group);
    } catch (const std::system_error&) {
      throw no_network(url);
    }
  }

  static void on_receive(const lcm_recv_buf_t* buffer, const char* name, void* self) {
    if (buffer->data == nullptr) return;
    // No exception may pass through C frames.
    try {
      // For a datagram whose channel name has no terminating zero, liblcm 1.3.1 gives the size -1,
      // which enqueue() rejects as too large.
      static_cast<Implementation*>(self)->enqueue(
          name, {static_cast<const std::uint8_t*>(buffer->data), buffer->data_size}, std::nullopt);
    } catch (...) {
    }
  }

  /// @param sender  nullopt if liblcm received the message: it does not report the sender.
  void enqueue(std::string_view name, std::span<const std::uint8_t> bytes,
               const std::optional<Sender>& sender) {
    const std::lock_guard lock{mutex_};
    const auto now = std::chrono::steady_clock::now();
    note_heard(heard_, name, now);
    if (sender) owners_.note_activity(*sender, now);
    const auto found = channels_of_.find(name);
    if (found == channels_of_.end()) return;
    if (bytes.size() > max_payload_bytes_) {
      counts_.add(found->second.front() + " rejected: too large", CountKind::kRejection);
      return;
    }
    const std::string& channel = ChannelNames::of_type(found->second, fingerprint_of(bytes));
    if (sender && publishers_ == Publishers::kOnePerChannel && has_one_publisher(channel) &&
        !is_accepted(channel, *sender, now))
      return;
    const auto time = time_of(bytes);
    if (!time) {
      counts_.add(channel + " rejected: bad time", CountKind::kRejection);
      return;
    }
    push(channel, queues_[channel], {channel, *time, {bytes.begin(), bytes.end()}});
  }

  bool is_accepted(const std::string& channel, const Sender& sender, ChannelOwners::Time now) {
    switch (owners_.check(channel, sender, now)) {
      case ChannelOwners::Verdict::kAccepted:
        return true;
      case ChannelOwners::Verdict::kNewOwner:
        counts_.add(channel + " has another publisher than before");
        return true;
      case ChannelOwners::Verdict::kRefused:
        break;
    }
    counts_.add(channel + " rejected: somebody else publishes, too", CountKind::kRejection);
    warn_of_rival(channel, sender, now);
    return false;
  }

  void warn_of_rival(const std::string& channel, const Sender& rival, ChannelOwners::Time now) {
    const auto [warned, is_first] = warned_.try_emplace(channel, now);
    if (!is_first && now - warned->second < kBetweenWarnings) return;
    warned->second = now;
    logging::warn(
        "{}: {} publishes, too, and is refused as long as {} is heard; two drivers or stacks on "
        "one network? (ss -uap 'sport = :{}' says whose it is)",
        channel, to_string(rival), to_string(owners_.owner_of(channel)), rival.port);
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

  void receive_datagrams() {
    while (!stop_) {
      const auto received = datagrams_->receive();
      if (received) enqueue(received->message.channel, received->message.payload, received->sender);
      const std::int64_t malformed = datagrams_->take_malformed();
      const std::int64_t fragments = datagrams_->take_fragments();
      if (malformed == 0 && fragments == 0) continue;
      const std::lock_guard lock{mutex_};
      if (malformed > 0) counts_.add(kMalformed, CountKind::kRejection, malformed);
      if (fragments > 0) counts_.add(kFragments, CountKind::kRejection, fragments);
    }
  }

  void receive_from_lcm() {
    while (!stop_ && is_connected())
      lcm_handle_timeout(lcm_.get(), kHandleTimeout_ms);
    const std::lock_guard lock{mutex_};
    if (!stop_) counts_.add("connection lost, messages dropped", CountKind::kLoss);
  }

  std::size_t max_payload_bytes_;
  ChannelNames names_;
  Publishers publishers_;
  /// Name on the network -> Waymark's channels that have it.
  std::map<std::string, std::vector<std::string>, std::less<>> channels_of_;
  std::unique_ptr<lcm_t, decltype(&lcm_destroy)> lcm_;
  std::optional<DatagramReceiver> datagrams_;  ///< nullopt: liblcm receives instead
  mutable std::mutex mutex_;
  std::condition_variable arrived_;
  std::map<std::string, Queue, std::less<>> queues_;
  std::deque<Queue*> order_;  ///< queue of each waiting message, by arrival
  Counters counts_;
  HeardChannels heard_;
  ChannelOwners owners_;
  /// Time of the last warning of a rival publisher, by channel.
  std::map<std::string, ChannelOwners::Time, std::less<>> warned_;
  std::atomic<bool> stop_{false};
  std::thread receiver_;
};

void check_network(const std::string& url) {
  // Without a subscription Bus would not join the network.
  const Bus bus{url, {{"CHECK"}}};
}

Bus::Bus(const std::string& url, const std::vector<Inbox::Subscription>& subscriptions,
         LargeMessages large_messages, const ChannelNames& names, Publishers publishers)
    : implementation_{std::make_unique<Implementation>(url, subscriptions, large_messages, names,
                                                       publishers)} {}

Bus::~Bus() = default;

std::optional<Message> Bus::receive(std::chrono::milliseconds timeout) {
  return implementation_->receive(timeout);
}

void Bus::publish(const Message& message) {
  implementation_->publish(message);
}

HeardChannels Bus::heard() const {
  return implementation_->heard();
}

void Bus::collect_counts(Counters& counters) {
  implementation_->collect_counts(counters);
}

}  // namespace waymark
