// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Messages of the Inverse Service, written by hand from the published examples.
#include "spidar/devices/inverse3/packets.h"
#include "tests/support/messages.h"
#include "tests/support/test.h"

namespace spidar::test::inverse3_test {
namespace {

using inverse3::Answer;
using inverse3::State;
using inverse3::Version;

ByteView view(const std::string& text) {
  return {reinterpret_cast<const uint8_t*>(text.data()), text.size()};
}

template <typename Encode>
std::string written(const Encode& encode, size_t capacity = inverse3::kCommandSize) {
  std::string text(capacity, '\0');
  text.resize(encode(MutableBytes(reinterpret_cast<uint8_t*>(text.data()), capacity)));
  return text;
}

/// The state of one device; `position` is a JSON value.
std::string message(const std::string& position, const std::string& more = "",
                    const std::string& id = "\"049D\"") {
  return R"({"session_id":7,"inverse3":[{"device_id":)" + id + R"(,"state":{"cursor_position":)" +
         position + more + R"(},"status":{"calibrated":true,"power_supply":true}}]})";
}
constexpr const char* kMiddle = R"({"x":0,"y":-0.1,"z":0.18})";
constexpr const char* kEcho = R"(,"current_cursor_force":{"x":0,"y":0,"z":0})";

Answer read(const std::string& text, State& state, const std::string& id = "") {
  return inverse3::decode_state(view(text), id, state);
}

TEST(Inverse3, TheForceIsInItsAxesUnderTheKeyOfTheVersion) {
  State device;
  device.id = "049D";
  const auto force = [&](MutableBytes bytes) {
    return inverse3::encode_force(device, {1, 2, 3}, bytes);
  };
  const std::string axes = R"(":{"x":1.000000,"y":-3.000000,"z":2.000000}}}}]})";
  const std::string head = R"({"inverse3":[{"device_id":"049D","commands":{"set_cursor_force":{")";
  EXPECT_EQ(written(force), head + "values" + axes);
  device.version = Version::k35;
  EXPECT_EQ(written(force), head + "vector" + axes);
  EXPECT_EQ(written(force, 80), "") << "no room";
}

TEST(Inverse3, ForcesAreLimitedAndNumbers) {
  State device;
  device.id = "1";
  const auto sent_N = [&](const Eigen::Vector3d& force_N) {
    Eigen::Vector3d read_N = Eigen::Vector3d::Constant(99);
    const std::string text =
        written([&](MutableBytes bytes) { return inverse3::encode_force(device, force_N, bytes); });
    EXPECT_TRUE(inverse3::decode_force(view(text), "1", read_N)) << text;
    EXPECT_FALSE(inverse3::decode_force(view(text), "2", read_N));
    return read_N;
  };
  EXPECT_TRUE(sent_N({6, 0, 80}).isApprox(Eigen::Vector3d(6, 0, 80).normalized() * 10, 1e-6));
  EXPECT_NEAR(sent_N(Eigen::Vector3d::Constant(1e300)).norm(), 10, 1e-5);
  EXPECT_TRUE(sent_N({std::numeric_limits<double>::quiet_NaN(), 1, 0}).isZero(0));
  EXPECT_TRUE(sent_N({1, -std::numeric_limits<double>::infinity(), 0}).isZero(0));
}

TEST(Inverse3, ThePositionIsFromTheMiddleInBothVersions) {
  State state;
  ASSERT_EQ(read(message(R"({"x":0.01,"y":-0.13,"z":0.2})"), state), Answer::kState);
  EXPECT_EQ(state.version, Version::k31);
  EXPECT_EQ(state.id, "049D");
  EXPECT_TRUE(state.position_m.isApprox(Eigen::Vector3d(0.01, 0.02, 0.03), 1e-12))
      << state.position_m.transpose();
  ASSERT_EQ(read(message(R"({"x":0.01,"y":-0.03,"z":0.02})", kEcho), state), Answer::kState);
  EXPECT_EQ(state.version, Version::k35);
  EXPECT_TRUE(state.position_m.isApprox(Eigen::Vector3d(0.01, 0.02, 0.03), 1e-12));
}

TEST(Inverse3, TheFirstDeviceOrTheNamedOne) {
  const std::string two =
      R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":0,"y":0,"z":0}}},)"
      R"({"device_id":"B","state":{"cursor_position":{"x":0.1,"y":0,"z":0}}}]})";
  State state;
  ASSERT_EQ(read(two, state), Answer::kState);
  EXPECT_EQ(state.id, "A");
  ASSERT_EQ(read(two, state, "B"), Answer::kState);
  EXPECT_EQ(state.position_m.x(), 0.1);
  EXPECT_EQ(read(two, state, "C"), Answer::kAbsent);
  EXPECT_EQ(read(R"({"session_id":1,"inverse3":[]})", state), Answer::kAbsent);
  EXPECT_EQ(read(R"({"session_id":1})", state), Answer::kAbsent);
}

TEST(Inverse3, WhatIsNoStateIsRefused) {
  State state;
  for (const std::string& text :
       {std::string(), std::string("{"), std::string("[1]"), std::string("\xff\xfe"),
        std::string(100'000, '['), message("null"), message(R"({"x":0,"y":0})"),
        message(R"({"x":"0","y":0,"z":0})"), message(R"({"x":NaN,"y":0,"z":0})"),
        message(R"({"x":1e999,"y":0,"z":0})"), message(R"({"x":1e300,"y":1e300,"z":0})"),
        message(R"({"x":30,"y":-130,"z":200})"),  // millimetres
        message(kMiddle, "", "7"), message(kMiddle, "", R"("a\"b")"), message(kMiddle, "", "\"\""),
        std::string(R"({"inverse3":[{"device_id":"1"}]})"), std::string(R"({"inverse3":[7]})")})
    EXPECT_EQ(read(text, state), Answer::kBroken) << text.substr(0, 200);
}

TEST(Inverse3, ButtonsOfEitherHandleAndWhatTheDeviceLacks) {
  State state;
  const auto with = [&](const std::string& handles) {
    std::string text = message(kMiddle);
    text.insert(1, handles + ",");
    EXPECT_EQ(read(text, state), Answer::kState) << text;
    return state.buttons;
  };
  EXPECT_EQ(with(R"("verse_grip":[])"), 0u);
  EXPECT_EQ(with(R"("verse_grip":[{"state":{"button":true}}])"), 1u);
  EXPECT_EQ(with(R"("wireless_verse_grip":[{"state":{"buttons":{"a":true,"c":true}}}])"), 5u);
  EXPECT_EQ(with(R"("wireless_verse_grip":[{"state":{"buttons":{"b":true}}}])"), 2u);
  EXPECT_EQ(with(R"("wireless_verse_grip":[7])"), 0u);
  EXPECT_TRUE(state.calibrated && state.powered);
  ASSERT_EQ(read(R"({"inverse3":[{"device_id":"1","state":{"cursor_position":{"x":0,"y":0,"z":0}},)"
                 R"("status":{"calibrated":false,"power_supply":false}}]})",
                 state),
            Answer::kState);
  EXPECT_FALSE(state.calibrated || state.powered);
}

TEST(Inverse3, OnlyTheLaterVersionIsToldWhereTheOriginIs) {
  State device;
  device.id = "1";
  const auto start = [&](MutableBytes bytes) { return inverse3::encode_start(device, bytes); };
  EXPECT_EQ(written(start).find("preset"), std::string::npos);
  device.version = Version::k35;
  expect_contains(written(start), R"("configure":{"preset":{"preset":"arm_front_centered"})");
  Eigen::Vector3d force_N(1, 1, 1);
  ASSERT_TRUE(inverse3::decode_force(view(written(start)), "1", force_N));
  EXPECT_TRUE(force_N.isZero(0));
}

/// RFC 6455, section 5.2.
TEST(Inverse3, AFrameHasItsLengthAndAMask) {
  const auto frame = [](const std::string& text) {
    return written([&](MutableBytes bytes) { return inverse3::encode_frame(view(text), bytes); });
  };
  EXPECT_EQ(frame("{}"), std::string("\x81\x82\0\0\0\0{}", 8));
  const std::string text(200, 'x');
  EXPECT_EQ(frame(text), std::string("\x81\xFE\x00\xC8\0\0\0\0", 8) + text);
  EXPECT_EQ(frame(std::string(600, 'x')), "");
}

}  // namespace
}  // namespace spidar::test::inverse3_test
