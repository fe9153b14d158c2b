// SPDX-License-Identifier: BSD-3-Clause
// Input: the index of a message type, then a payload without its fingerprint. It is decoded,
// checked, converted and encoded again.
#include "common/bus/datagram_receiver.hpp"
#include "common/messages/codec.hpp"
#include "common/messages/convert.hpp"
#include "message_types.hpp"

#include <cmath>
#include <cstdlib>

namespace waymark::fuzz {
namespace {

void convert(const planar_lidar_t& message) {
  const LidarScan scan = to_scan(message);
  if (std::ssize(scan.ranges_m) != message.nranges) std::abort();
}

void convert(const lidar_t& message) {
  const LidarScan scan = to_scan(message);
  if (std::ssize(scan.ranges_m) != message.num_ranges) std::abort();
}

void convert(const pose2D_t& message) {
  if (!std::isfinite(to_odometry(message).odom_from_base.theta())) std::abort();
}

void convert(const marker_detections_t& message) {
  if (to_detections(message).detections.size() != message.detections.size()) std::abort();
}

template <class Type>
void convert(const Type&) {}

template <class Type>
void check(Channel<Type> channel, std::span<const std::uint8_t> body) {
  std::vector<std::uint8_t> payload(8);
  const auto fingerprint = static_cast<std::uint64_t>(Type::getHash());
  for (std::size_t i = 0; i < payload.size(); ++i)
    payload[i] = static_cast<std::uint8_t>(fingerprint >> (8 * (payload.size() - 1 - i)));
  payload.insert(payload.end(), body.begin(), body.end());
  const Decoded<Type> decoded = decode<Type>(payload);
  if (!decoded.message) return;
  convert(*decoded.message);
  // An accepted message can be sent on, and is accepted again.
  const Message again = encode(channel, *decoded.message);
  if (again.payload.size() != payload.size() || !decode<Type>(again.payload).message) std::abort();
}

}  // namespace
}  // namespace waymark::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace waymark::fuzz;
  if (size == 0) return 0;
  const std::span bytes{data, size};
  for_each_type([&](std::size_t index, const auto& channel) {
    if (index == bytes[0]) check(channel, bytes.subspan(1));
  });
  return 0;
}
