// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The position in the picture at which the grip points.
#include "plugin/frame/touch_view.h"
#include "plugin/properties/motion_properties.h"
#include "spidar/profiles/profile.h"
#include "tests/support/test.h"

namespace spidar::test::grip_pointer_test {
namespace {

/// A few operations on numbers up to 1.
constexpr double kRounding = 1e-15;

TEST(GripPointer, HalfOfTheWayToTheFrameIsTheEdgeOfThePicture) {
  const GripPointer pointer(load_profile("spidar-gcc").geometry);
  // Exits at ±59, ±64, ±59 mm.
  EXPECT_NEAR(pointer.half_size_m().x(), 0.0295, kRounding);
  EXPECT_NEAR(pointer.half_size_m().y(), 0.032, kRounding);
  EXPECT_EQ(pointer.position({0, 0, 0}), Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(pointer.position({0, 0, 0.05}), Eigen::Vector2d(0.5, 0.5)) << "depth does not matter";
  // Right is right; up in the device is up in the picture, whose y goes down.
  EXPECT_LT((pointer.position({0.0295 / 2, 0.032 / 2, 0}) - Eigen::Vector2d(0.75, 0.25)).norm(),
            kRounding);
  EXPECT_LT((pointer.position({-0.0295, -0.032, 0}) - Eigen::Vector2d(0, 1)).norm(), kRounding);
}

TEST(GripPointer, BeyondTheEdgeIsTheEdge) {
  const GripPointer pointer(load_profile("spidar-gcc").geometry);
  EXPECT_EQ(pointer.position({1, 1, 0}), Eigen::Vector2d(1, 0));
  EXPECT_EQ(pointer.position({-1, -1, 0}), Eigen::Vector2d(0, 1));
}

TEST(GripPointer, WithoutADeviceItIsTheMiddle) {
  EXPECT_EQ(GripPointer().position({0.1, -0.1, 0}), Eigen::Vector2d(0.5, 0.5));
}

TEST(Pointer, IsAPlaceTheGripOrTheMouse) {
  for (const char* text : {"grip", "mouse", "0,1", "0.25,0.75"}) {
    const std::optional<Pointer> pointer = parse_pointer(text);
    ASSERT_TRUE(pointer) << text;
    EXPECT_EQ(text_of(*pointer), text);
  }
  for (const char* text :
       {"", "fixed", "0.5", "0.5,", ",0.5", "0.5;0.5", "0.5,0.5,0.5", "1.1,0", "0,-0.1", "nan,0"}) {
    EXPECT_FALSE(parse_pointer(text)) << text;
  }
}

}  // namespace
}  // namespace spidar::test::grip_pointer_test
