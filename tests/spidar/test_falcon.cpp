// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Packets of the Novint Falcon, written by hand from the published description.
#include "spidar/devices/falcon/packets.h"
#include "tests/support/test.h"

namespace spidar::test::falcon_test {
namespace {

using falcon::Command;
using falcon::Light;
using falcon::Packet;
using falcon::Reading;

Packet packet(const std::string& text) {
  Packet packet{};
  std::copy_n(text.begin(), std::min(text.size(), packet.size()), packet.begin());
  return packet;
}

std::string text(const Packet& packet) {
  return {packet.begin(), packet.end()};
}

TEST(NovintFalcon, ACommandIsLettersForNibblesAndFlags) {
  Packet written;
  falcon::encode_command({{0, 1, -1}, Light::kRed, true}, written);
  // 0; 0x0001 from the lowest nibble on; 0xFFFF; red and homing: 8 + 1
  EXPECT_EQ(text(written), "<AAAABAAAPPPPJA>");
  falcon::encode_command({{0x0123, -0x0123, 0}, Light::kNone, false}, written);
  EXPECT_EQ(text(written), "<DCBANNOPAAAAAA>");  // 0xFEDD

  Command read;
  ASSERT_TRUE(falcon::decode_command(written, read));
  EXPECT_EQ(read.digit, (std::array<int, 3>{0x0123, -0x0123, 0}));
  EXPECT_EQ(read.light, Light::kNone);
  EXPECT_FALSE(read.homing);
}

TEST(NovintFalcon, MotorsAreShortenedToTwelveBits) {
  Packet written;
  falcon::encode_command({{100'000, -100'000, 4095}}, written);
  Command read;
  ASSERT_TRUE(falcon::decode_command(written, read));
  EXPECT_EQ(read.digit, (std::array<int, 3>{4095, -4095, 4095}));
  // 4096 is not sent, and not taken.
  EXPECT_FALSE(falcon::decode_command(packet("<AAABAAAAAAAABA>"), read));
}

TEST(NovintFalcon, AReadingHasCountsButtonsAndMarks) {
  Reading read;
  // libnifalcon's example is 0xFA59; the right and the left button, all encoders at their
  // marks: 'A' + 0x79.
  ASSERT_TRUE(falcon::decode_reading(packet("<JFKPBAAAAAAI\xBA"
                                            "A>"),
                                     read));
  EXPECT_EQ(read.count, (std::array<int16_t, 3>{-1447, 1, -32768}));
  EXPECT_EQ(read.buttons, 0b1001);
  EXPECT_TRUE(read.all_homed());
  read.homed = 5;
  EXPECT_FALSE(read.all_homed());
  Packet written;
  falcon::encode_reading(read, written);
  EXPECT_EQ(text(written),
            "<JFKPBAAAAAAI\x9A"
            "A>");
}

TEST(NovintFalcon, WhatIsNoPacketIsRefused) {
  Reading reading;
  Command command;
  const std::string good = "<AAAAAAAAAAAAAA>";
  ASSERT_TRUE(falcon::decode_reading(packet(good), reading));
  for (const size_t at : {0u, 1u, 12u, 13u, 15u}) {
    for (const char other : {'@', 'Q', '\0'}) {
      if (at == 13 && other == 'Q') continue;  // marks and buttons, see below
      std::string bad = good;
      bad[at] = other;
      EXPECT_FALSE(falcon::decode_reading(packet(bad), reading)) << bad;
      EXPECT_FALSE(falcon::decode_command(packet(bad), command)) << bad;
    }
  }
  EXPECT_TRUE(falcon::decode_reading(packet("<AAAAAAAAAAAAQA>"), reading));
  EXPECT_EQ(reading.homed, 1);
  EXPECT_FALSE(falcon::decode_command(packet("<AAAAAAAAAAAAQA>"), command)) << "no such light";
  const Packet whole = packet(good);
  EXPECT_FALSE(falcon::decode_reading({whole.data(), 15}, reading));
  EXPECT_FALSE(falcon::decode_reading({}, reading));
}

TEST(NovintFalcon, EncodersTurnByTheCableOnTheDrum) {
  EXPECT_DOUBLE_EQ(falcon::angle_rad(0), 35 * M_PI / 180);
  // A turn of the motor, 1280 counts, winds 14.25 mm · π of cable onto a drum of 110 mm.
  EXPECT_DOUBLE_EQ(falcon::angle_rad(1280) - falcon::angle_rad(0), 2 * M_PI * 14.25 / 110);
  for (const int count : {-1500, -1, 0, 1, 1447})
    EXPECT_EQ(falcon::count_at(falcon::angle_rad(count)), count);
}

TEST(NovintFalcon, TheLineIsThatOfThePublishedProgram) {
  const auto listed = [](const auto& line) {
    std::vector<std::pair<int, int>> all;
    for (const VendorRequest& request : line) all.emplace_back(request.request, request.value);
    return all;
  };
  using Requests = std::vector<std::pair<int, int>>;
  EXPECT_EQ(listed(falcon::kHelloLine), (Requests{{0, 1},
                                                  {0, 2},
                                                  {9, 16},
                                                  {3, 0x4138},
                                                  {4, 8},
                                                  {2, 0},
                                                  {1, 0x200},
                                                  {1, 0x100},
                                                  {1, 0x101}}));
  EXPECT_EQ(listed(falcon::kLoadLine), (Requests{{1, 0x100}, {3, 0x15}}));
  EXPECT_EQ(listed(falcon::kRunLine), (Requests{{9, 1}, {3, 2}, {0, 1}, {0, 2}}));
}

}  // namespace
}  // namespace spidar::test::falcon_test
