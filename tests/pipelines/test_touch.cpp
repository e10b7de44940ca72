// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Touching the picture: whole pipelines on a test clock, with the simulated device whose hand the
// test moves. TickWatch also checks every tick.
#include <gst/video/video.h>

#include "plugin/filter/spidar_motion.h"
#include "plugin/frame/touch_view.h"
#include "tests/pipelines/touched_pipeline.h"
#include "tests/support/test.h"

namespace spidar::test::touch_test {
namespace {

constexpr double kRelief_m = 0.008;
/// The hand is never moved by more than this when a surface rises under it.
constexpr double kGentle_m_s = 0.05;

/// Black is half of the relief behind the middle of the workspace, white as far before it.
double height_m(double luma) {
  return kRelief_m * (luma / 255 - 0.5);
}

/// What is not switched on changes nothing, to the last bit: wanted, commanded and delivered
/// wrench, tensions and pose of every tick.
TEST(Touch, OffIsAsIfThereWereNoSuchProperties) {
  const std::string ball = "pattern=ball";
  Touched plain(touched_film(ball, ""));
  Touched off(touched_film(ball,
                           "touch=off touch-relief=20 touch-stiffness=800 touch-friction=1 "
                           "touch-texture=3 motion-fraction=0.3"));
  // Switched on, and off again before anything is shown.
  Touched was_on(touched_film(ball, "touch=luma touch=off"));
  for (Touched* touched : {&plain, &off, &was_on}) {
    touched->hold(0.002, 0.001, -0.006);
    touched->play(50);
    touched->pipeline.set_state(GST_STATE_PAUSED);
    touched->wait(5);
    touched->pipeline.seek(GST_SECOND);
    touched->pipeline.set_state(GST_STATE_PLAYING);
    touched->play(25);
  }
  EXPECT_GT(plain.last().commanded.force_N.norm(), 0.1) << "it is forces that are compared";
  EXPECT_EQ(off.trace(), plain.trace());
  EXPECT_EQ(was_on.trace(), plain.trace());
}

TEST(Touch, TheFilmIsAddedByItsFraction) {
  for (const double fraction : {0.0, 0.5, 1.0}) {
    Touched plain(touched_film("pattern=ball", ""));
    Touched touched(
        touched_film("pattern=ball", "touch=luma motion-fraction=" + std::to_string(fraction)));
    for (Touched* pipeline : {&plain, &touched}) {
      pipeline->hold(0, 0, 0.004 + 0.01);  // above all that there is
      pipeline->play(50);
    }
    EXPECT_GT(plain.last().wanted.force_N.norm(), 0.1);
    EXPECT_NEAR((touched.last().wanted.force_N - fraction * plain.last().wanted.force_N).norm(), 0,
                1e-12);
    EXPECT_TRUE(touched.last().contact.has_surface);
  }
}

/// When the contact ends, the hand sinks in at its own speed. After that the surface rises.
TEST(Touch, PauseSeekMuteAndOffEndIt) {
  Touched touched(touched_film("pattern=white", "touch=luma"));
  touched.hold(0, 0, -0.004);
  const auto expect_contact = [&](const char* after) {
    touched.play(50);
    EXPECT_LE(touched.fastest_m_s(), kGentle_m_s) << after;
    EXPECT_GT(touched.last().commanded.force_N.z(), 1) << after;
  };
  const auto expect_rest = [&](const char* what) {
    touched.wait(50);
    EXPECT_EQ(touched.last().commanded.stacked().norm(), 0) << what;
    touched.wait(500);
    touched.fastest_m_s();
  };
  touched.play(20);
  touched.fastest_m_s();
  expect_contact("start");

  touched.pipeline.set_state(GST_STATE_PAUSED);
  expect_rest("pause");
  touched.pipeline.set_state(GST_STATE_PLAYING);
  expect_contact("pause");

  g_object_set(touched.pipeline.element(), "mute", TRUE, nullptr);
  expect_rest("mute");
  touched.play(10);
  EXPECT_EQ(touched.last().commanded.stacked().norm(), 0) << "frames while muted";
  g_object_set(touched.pipeline.element(), "mute", FALSE, nullptr);
  expect_contact("mute");

  gst_util_set_object_arg(G_OBJECT(touched.pipeline.element()), "touch", "off");
  expect_rest("off");
  gst_util_set_object_arg(G_OBJECT(touched.pipeline.element()), "touch", "luma");
  expect_contact("off");

  // Paused, so that nothing is shown between the flush and the time it is looked at.
  touched.pipeline.set_state(GST_STATE_PAUSED);
  touched.pipeline.seek(5 * GST_SECOND);
  expect_rest("seek");
  touched.pipeline.set_state(GST_STATE_PLAYING);
  expect_contact("seek");
}

/// A grey wedge, black at the top: where the grip is held is known by how high the surface is
/// there.
TEST(Touch, PlacesAreThoseOfThePointerInPicturesOfAllShapes) {
  for (const auto& [width, height] : {std::pair{320, 240}, {90, 160}, {16, 16}, {1920, 1080}}) {
    SCOPED_TRACE(testing::Message() << width << "x" << height);
    Touched touched(touched_film("pattern=gradient", "touch=luma touch-friction=0", width, height));
    const GripPointer pointer(load_profile(kDefaultProfile).geometry);
    for (const double y_m : {-0.016, 0.0, 0.012}) {
      touched.hold(0.004, y_m, -0.008);
      touched.play(40);
      const touch::Contact& contact = touched.last().contact;
      ASSERT_TRUE(contact.touching);
      const Eigen::Vector3d grip_m = touched.last().pose.position_m;
      const Eigen::Vector2d position = pointer.position(grip_m);
      // The proxy is the surface's nearest point: up the slope of the wedge by the depth.
      const double slope = kRelief_m / (2 * pointer.half_size_m().y());
      const double z_m =
          grip_m.z() + contact.depth_m * std::sqrt(1 + slope * slope);  // straight above the grip
      // Steps of brightness, half a row of so few, and of the encoder.
      const double step_m = kRelief_m / 255 + 0.5 * kRelief_m / height + 2 * 1.6e-5;
      EXPECT_NEAR(z_m, height_m(touched.luma(position.x(), position.y())), step_m) << y_m;
    }
  }
}

}  // namespace
}  // namespace spidar::test::touch_test
