// SPDX-License-Identifier: BSD-3-Clause
#include "common/bus/datagram_receiver.hpp"
#include "common/errors/setup_error.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

std::vector<std::uint8_t> bytes(const std::string& text) {
  return {text.begin(), text.end()};
}

using namespace std::string_literals;

TEST(MulticastGroup, IsReadFromTheUrlWithTheDefaultsOfLcm) {
  const auto given = multicast_group_of("udpm://239.1.2.3:7700?ttl=1");
  ASSERT_TRUE(given);
  EXPECT_EQ(given->address, 0xef010203U);
  EXPECT_EQ(given->port, 7700);
  for (const char* url : {"udpm://", "udpm://?ttl=0", "udpm://239.255.76.67"}) {
    const auto usual = multicast_group_of(url);
    ASSERT_TRUE(usual) << url;
    EXPECT_EQ(usual->address, 0xefff4c43U) << url;
    EXPECT_EQ(usual->port, 7667) << url;
  }
  EXPECT_FALSE(multicast_group_of("memq://"));
  EXPECT_FALSE(multicast_group_of("tcpq://127.0.0.1:7700"));
}

TEST(MulticastGroup, AnInvalidGroupIsASetupError) {
  for (const char* url : {"udpm://127.0.0.1:7667", "udpm://239.255.76:7667", "udpm://lidar:7667",
                          "udpm://239.255.76.67:", "udpm://239.255.76.67:0",
                          "udpm://239.255.76.67:65536", "udpm://239.255.76.67:77x"}) {
    EXPECT_THROW(multicast_group_of(url), SetupError) << url;
  }
}

TEST(WholeMessage, IsMagicSequenceNumberChannelAndPayload) {
  const auto datagram = bytes("LC02\0\0\0\7LIDAR\0abc"s);
  const auto message = whole_message_in(datagram);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->channel, "LIDAR");
  EXPECT_EQ(std::string(message->payload.begin(), message->payload.end()), "abc");
  const auto without_payload = bytes("LC02\0\0\0\7L\0"s);
  ASSERT_TRUE(whole_message_in(without_payload));
  EXPECT_TRUE(whole_message_in(without_payload)->payload.empty());
}

TEST(WholeMessage, RejectsOtherDatagrams) {
  const std::string long_name(64, 'A');
  for (const std::string& text :
       {""s, "LC02"s, "LC02\0\0\0"s, "LC02\0\0\0\7"s, "LC02\0\0\0\7\0abc"s, "LC02\0\0\0\7LIDAR"s,
        "LC03\0\0\0\7LIDAR\0abc"s, "lc02\0\0\0\7LIDAR\0abc"s,
        "LC02\0\0\0\7"s + long_name + "\0"s}) {
    EXPECT_FALSE(whole_message_in(bytes(text))) << text;
  }
}

TEST(Fragment, IsRecognisedByTheMagicNumberLC03) {
  EXPECT_TRUE(is_fragment(bytes("LC03\0\0\0\7rest"s)));
  for (const std::string& text : {""s, "LC03"s, "LC03\0\0\0"s, "LC02\0\0\0\7LIDAR\0abc"s})
    EXPECT_FALSE(is_fragment(bytes(text))) << text;
}

TEST(Sender, IsWrittenAsAddressAndPort) {
  EXPECT_EQ(to_string(Sender{0xc0a80102, 40000}), "192.168.1.2:40000");
}

}  // namespace
}  // namespace waymark
