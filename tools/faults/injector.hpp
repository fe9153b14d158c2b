// SPDX-License-Identifier: BSD-3-Clause
// Injects faults into the messages of a log.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/messages/message.hpp"
#include "faults/fault_config.hpp"

#include <waymark/marker_detections_t.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace waymark::faults {

/// Ids and sightings that occur in the log, for wrong ids and ghosts.
struct LogContent {
  std::vector<int> ids{};  ///< in order, each once
  std::vector<marker_detection_t> sightings{};

  void add(const Message& message);
};

/// The same log, configuration and seed give the same bytes.
class Injector {
 public:
  Injector(const FaultConfig& config, std::uint64_t seed, const LogContent& content)
      : config_{config}, seed_{seed}, content_{content} {}

  /// Call for all messages in the order of the log. @return nullopt when the message is dropped.
  std::optional<Message> apply(const Message& message);

  /// How often each fault was injected, by name.
  const std::map<std::string, std::int64_t>& counts() const { return counts_; }

  /// Keys of the configured faults that have affected no message.
  std::vector<std::string> never_injected() const;

 private:
  bool is_off(const std::vector<double>& times_s, Timestamp time) const;
  Message with_faulty_markers(const Message& message);
  Message with_faulty_odometry(const Message& message);
  /// False if the sighting is dropped.
  bool corrupt(marker_detection_t& detection, std::uint64_t index);
  void add_ghost(marker_detections_t& message);
  int another_id(int id, double uniform) const;

  FaultConfig config_;
  std::uint64_t seed_;
  const LogContent& content_;
  std::optional<Timestamp> start_{};
  std::uint64_t frame_{0};
  std::optional<Se2> last_odometry_{};  ///< last pose as recorded
  Se2 odom_from_base_{};                ///< last pose with faults
  std::set<std::string> injected_{};    ///< keys of faults that have affected a message
  std::map<std::string, std::int64_t> counts_{};
};

}  // namespace waymark::faults
