// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// What a click in the picture of a debug window chooses.
#include "plugin/window/program/model/object_click.h"
#include "tests/support/test.h"

namespace spidar::test::object_click_test {
namespace {

using Eigen::Vector2d;

MovingObject object(uint32_t id, const Vector2d& middle_px, const Vector2d& size_px) {
  MovingObject made;
  made.id = id;
  made.position_px = middle_px;
  made.size_px = size_px;
  made.points = 10;
  return made;
}

/// A picture of 200 × 100 px, shown at twice its size with its corner at (10, 20).
const window::Rect kPicture{10, 20, 400, 200};

DrawnFrame report() {
  DrawnFrame made;
  made.visible = {0, 0, 200, 100};
  made.frame.place = FilmPlace::whole(200, 100);
  made.frame.objects = {object(1, {-50, 0}, {60, 60}), object(2, {-50, 0}, {20, 20}),
                        object(3, {50, 0}, {40, 40})};
  return made;
}

window::Mouse mouse_at(const Vector2d& frame_px, bool down) {
  window::Mouse mouse;
  mouse.at_px = Vector2d(kPicture.x, kPicture.y) + 2 * frame_px;
  mouse.down = down;
  return mouse;
}

TEST(ObjectClick, ChoosesTheObjectThatItIsPressedOnOnce) {
  window::ObjectClick click;
  EXPECT_FALSE(click.update(mouse_at({150, 50}, false), kPicture, report()));
  const std::optional<window::ChoiceRequest> request =
      click.update(mouse_at({140, 60}, true), kPicture, report());
  ASSERT_TRUE(request && request->position);
  EXPECT_NEAR((*request->position - Vector2d(0.7, 0.6)).norm(), 0, 1e-12);
  EXPECT_TRUE(click.holds());
  EXPECT_FALSE(click.update(mouse_at({50, 50}, true), kPicture, report())) << "still down";
  EXPECT_TRUE(click.holds());
  EXPECT_FALSE(click.update(mouse_at({50, 50}, false), kPicture, report()));
  EXPECT_FALSE(click.holds());
}

TEST(ObjectClick, OnTheChosenOneLetsGo) {
  DrawnFrame chosen = report();
  chosen.click = 1;
  chosen.frame.felt_object = 3;
  window::ObjectClick click;
  const std::optional<window::ChoiceRequest> request =
      click.update(mouse_at({150, 50}, true), kPicture, chosen);
  ASSERT_TRUE(request);
  EXPECT_FALSE(request->position);
  EXPECT_EQ(request->object, 3u);
  click.update(mouse_at({150, 50}, false), kPicture, chosen);
  const std::optional<window::ChoiceRequest> other =
      click.update(mouse_at({50, 50}, true), kPicture, chosen);
  EXPECT_TRUE(other && other->position) << "another one";
  // Felt, but not by a click.
  chosen.click = 0;
  const std::optional<window::ChoiceRequest> kept =
      window::ObjectClick().update(mouse_at({150, 50}, true), kPicture, chosen);
  EXPECT_TRUE(kept && kept->position);
}

TEST(ObjectClick, OfBoxesInEachOtherTheSmallestIsMeant) {
  ASSERT_NE(window::object_at(report(), {0.25, 0.5}), nullptr);
  EXPECT_EQ(window::object_at(report(), {0.25, 0.5})->id, 2u);
  EXPECT_EQ(window::object_at(report(), {0.25, 0.7})->id, 1u);
  EXPECT_EQ(window::object_at(report(), {0.5, 0.5}), nullptr);
  DrawnFrame hidden = report();
  hidden.frame.objects[1].points = 0;
  EXPECT_EQ(window::object_at(hidden, {0.25, 0.5})->id, 1u);
}

/// There the button moves the hand.
TEST(ObjectClick, BesideObjectsAndWhereNoneAreKnownIsNone) {
  DrawnFrame touched = report(), mean = report();
  touched.touch.on = true;
  mean.motion = MotionKind::kMean;
  window::Mouse taken = mouse_at({150, 50}, true), outside = taken, nowhere = taken;
  taken.taken = true;
  outside.at_px << 700, 60;
  nowhere.at_px.setConstant(std::numeric_limits<double>::quiet_NaN());
  const auto none = [](const window::Mouse& mouse, const window::Rect& picture,
                       const DrawnFrame& of) {
    window::ObjectClick click;
    return !click.update(mouse, picture, of) && !click.holds();
  };
  EXPECT_TRUE(none(mouse_at({100, 50}, true), kPicture, report()));
  EXPECT_TRUE(none(mouse_at({150, 50}, true), kPicture, touched));
  EXPECT_TRUE(none(mouse_at({150, 50}, true), kPicture, mean));
  EXPECT_TRUE(none(mouse_at({150, 50}, true), window::Rect{}, report())) << "no picture yet";
  EXPECT_TRUE(none(taken, kPicture, report()));
  EXPECT_TRUE(none(outside, kPicture, report()));
  EXPECT_TRUE(none(nowhere, kPicture, report()));
}

}  // namespace
}  // namespace spidar::test::object_click_test
