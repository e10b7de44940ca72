// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// The data of a debug window, without a window.
#include "core/force/motion_rendering.h"
#include "plugin/filter/display/motion_display.h"
#include "plugin/filter/spidar_motion.h"
#include "plugin/gobject/ref.h"
#include "plugin/window/program/model/layout.h"
#include "plugin/window/program/model/timeline.h"
#include "plugin/window/view/window_view.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace spidar::test::window_model_test {
namespace {

constexpr double kRounding = 1e-9;

TEST(FeltObjects, AreThoseWhoseMotionIsFelt) {
  DrawnFrame report;
  for (const uint32_t id : {3u, 5u, 8u}) {
    MovingObject object;
    object.id = id;
    object.points = id == 8 ? 0 : 10;  // the last one is out of sight
    object.relative_px_s = {10.0 * id, 1};
    report.frame.objects.push_back(object);
  }
  const auto felt = [&] { return felt_objects(report); };
  report.frame.felt_object = 5;
  report.motion = MotionKind::kObject;
  EXPECT_EQ(felt(), std::vector<uint32_t>{5});
  report.motion = MotionKind::kObjects;
  report.frame.choice.is_kept = true;
  EXPECT_EQ(felt(), std::vector<uint32_t>{5}) << "by a click";
  report.frame.felt_object = 0;
  report.frame.choice.is_kept = false;
  EXPECT_EQ(felt(), (std::vector<uint32_t>{3, 5}));
  report.touch.on = true;
  EXPECT_TRUE(felt().empty()) << "only the surface is";
  report.touch.motion_fraction = 0.5;
  EXPECT_EQ(felt(), (std::vector<uint32_t>{3, 5}));
  report.motion = MotionKind::kCamera;
  EXPECT_TRUE(felt().empty());
}

TEST(Layout, PanelsFillAnyWindowAndDoNotOverlap) {
  for (const auto& [width, height] : {std::pair{1280, 800},
                                      {640, 480},
                                      {3840, 2160},
                                      {20, 10},
                                      {1, 1},
                                      {0, 0},
                                      {500, 2000},
                                      {700, 960}}) {
    for (const double scale : {0.5, 1.0, 2.0, 8.0}) {
      SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height) + " at " +
                   std::to_string(scale));
      const window::Layout l = window::lay_out(width, height, scale);
      const std::vector<window::Rect> panels{l.picture, l.timeline, l.force,    l.speed,   l.gain,
                                             l.status,  l.grip,     l.tensions, l.controls};
      for (size_t i = 0; i < panels.size(); ++i) {
        const window::Rect& a = panels[i];
        EXPECT_GE(a.width, 0);
        EXPECT_GE(a.height, 0);
        EXPECT_GE(a.x, 0);
        EXPECT_GE(a.y, 0);
        EXPECT_LE(a.right(), std::max(width, 1) + kRounding);
        EXPECT_LE(a.bottom(), std::max(height, 1) + kRounding);
        for (size_t k = 0; k < i; ++k) {
          const window::Rect& b = panels[k];
          const bool apart = a.right() <= b.x + kRounding || b.right() <= a.x + kRounding ||
                             a.bottom() <= b.y + kRounding || b.bottom() <= a.y + kRounding;
          EXPECT_TRUE(apart) << i << " and " << k;
        }
      }
    }
  }
}

TEST(Layout, TheTimelineHasRoomForItsLines) {
  for (const auto& [width, height] : {std::pair{1500, 900}, {1280, 720}, {800, 600}, {640, 480}}) {
    const window::Layout l = window::lay_out(width, height, 1);
    EXPECT_GT(l.grip.x, l.picture.right());
    // Title, two buttons, with as much as above the title below: 7 + 14 + 4, 2 + 20, 6 + 16, 7.
    EXPECT_GE(l.timeline.height, 76) << height;
  }
}

TEST(Layout, WhatIsNotThereOrCannotBeReadLeavesItsRoomToOthers) {
  const window::Layout all = window::lay_out(1280, 800, 1);
  const window::Layout none = window::lay_out(1280, 800, 1, {true, false, false});
  EXPECT_EQ(none.grip.height + none.tensions.height, 0);
  EXPECT_NEAR(none.controls.y, all.grip.y, kRounding);
  EXPECT_NEAR(none.controls.bottom(), all.controls.bottom(), kRounding);
  EXPECT_NEAR(window::lay_out(1280, 800, 1, {true, true, false}).controls.y, all.tensions.y,
              kRounding);
  for (const auto& [width, height] : {std::pair{560, 380}, {640, 480}, {800, 600}, {560, 1000}}) {
    for (const double scale : {1.0, 2.0}) {
      SCOPED_TRACE(std::to_string(width) + "x" + std::to_string(height));
      const window::Layout l =
          window::lay_out(static_cast<int>(scale * width), static_cast<int>(scale * height), scale);
      // "Compare", two buttons and "Reset" beside each other; "Speed to force" within its margins.
      EXPECT_GE(l.controls.width, scale * 220);
      EXPECT_GE(l.controls.height, scale * 190);
      EXPECT_GE(l.timeline.height, scale * 76);
      for (const window::Rect& plot : {l.force, l.speed, l.gain}) {
        if (plot.width == 0) continue;
        EXPECT_GE(plot.width, scale * 132);
        EXPECT_GE(plot.height, scale * 90);
      }
      EXPECT_GE(l.picture.height, scale * 0.4 * height);
    }
  }
}

TEST(Layout, ThePictureKeepsItsShapeAndItsPlace) {
  const window::Rect panel{10, 20, 400, 300};
  // Pixels twice as wide as high: 100 × 100 of them are 2 : 1.
  const window::PictureMap map = window::map_picture(panel, 5, 6, 100, 100, 2);
  EXPECT_NEAR(map.shown.width, 400, kRounding);
  EXPECT_NEAR(map.shown.height, 200, kRounding);
  EXPECT_NEAR(map.shown.y, 70, kRounding);
  // The first pixel shown is (5, 6); its centre is half a pixel from the corner.
  EXPECT_NEAR((map({5, 6}) - Eigen::Vector2d(12, 71)).norm(), 0, kRounding);
  EXPECT_NEAR((map({104, 105}) - Eigen::Vector2d(408, 269)).norm(), 0, kRounding);
}

TEST(Layout, TheGripIsSeenFromTheRightAndAbove) {
  StringGeometry geometry;
  geometry.count = 1;
  geometry.exit_m[0] = {0.1, 0, 0};
  const window::GripProjection project({0, 0, 200, 100}, geometry);
  const Eigen::Vector2d centre = project(Eigen::Vector3d::Zero());
  EXPECT_NEAR((centre - Eigen::Vector2d(100, 50)).norm(), 0, kRounding);
  EXPECT_GT(project({0.1, 0, 0}).x(), centre.x());
  EXPECT_LT(project({0, 0.1, 0}).y(), centre.y()) << "up is up";
  EXPECT_LT(project({0, 0, 0.1}).x(), centre.x()) << "near is left";
  EXPECT_GT(project({0, 0, 0.1}).y(), centre.y()) << "and down";
}

class Settings : public testing::Test {
 protected:
  const Ref<GstElement> element =
      (init_gstreamer(), sunk(GST_ELEMENT(g_object_new(GST_TYPE_SPIDAR_MOTION, nullptr))));
  const std::shared_ptr<window::Source> source =
      gst_spidar_motion_state(GST_SPIDAR_MOTION(element.get())).display.source();
  window::ElementState state;
};

TEST_F(Settings, AreThoseThatCanBeChangedWhilePlaying) {
  source->read(state);
  EXPECT_EQ(state.no_force, "The video is paused.");
  EXPECT_GT(state.settings.size(), 10u);
  for (const window::Setting& setting : state.settings) {
    EXPECT_FALSE(setting.help.empty()) << setting.name;
  }
  EXPECT_EQ(state.setting("device"), nullptr) << "not while playing";
  EXPECT_EQ(state.setting("debug-window"), nullptr) << "the window is no switch for itself";
  EXPECT_EQ(state.setting("post-messages"), nullptr) << "nothing that is felt or seen";
  EXPECT_EQ(state.value("max-force", 0), 3);
  EXPECT_EQ(state.setting("max-force")->usual, 3);
  g_object_set(element.get(), "max-force", 2.5, nullptr);
  source->read(state);
  EXPECT_EQ(state.value("max-force", 0), 2.5);
}

TEST(Layout, TextGrowsWithAWindowLargerThanUsual) {
  EXPECT_EQ(window::text_scale(1, 640, 480), 1);
  EXPECT_EQ(window::text_scale(1, 1280, 800), 1);
  EXPECT_EQ(window::text_scale(1, 1920, 1080), 1.25);  // by the height
  EXPECT_EQ(window::text_scale(1, 2560, 900), 1.125);
  EXPECT_EQ(window::text_scale(2, 2560, 1600), 2);
  EXPECT_EQ(window::text_scale(2, 3840, 2400), 3);
}

TEST_F(Settings, HavePresets) {
  source->read(state);
  ASSERT_NE(std::find(state.presets.begin(), state.presets.end(), "gentle"), state.presets.end());
  const double before = state.value("alpha", 0);
  source->load_preset("gentle");
  source->read(state);
  EXPECT_LT(state.value("alpha", 0), before);
}

TEST(Layout, OfATrackTheForceHasThePlaceOfTheSpeed) {
  const window::Layout l = window::lay_out(1280, 800, 1, {false});
  EXPECT_NEAR(l.force.right(), l.status.right(), kRounding);
  EXPECT_EQ(l.speed.width, 0);
  EXPECT_EQ(l.gain.width, 0);
}

TEST(Play, IsAskedOfTheApplication) {
  ElementHarness h("device=none");
  const std::shared_ptr<window::Source> source =
      gst_spidar_motion_state(GST_SPIDAR_MOTION(h.element())).display.source();
  GstBus* const bus = gst_bus_new();
  gst_element_set_bus(h.element(), bus);
  source->play(false);
  GstMessage* const message = gst_bus_pop_filtered(bus, GST_MESSAGE_REQUEST_STATE);
  ASSERT_NE(message, nullptr);
  GstState state = GST_STATE_NULL;
  gst_message_parse_request_state(message, &state);
  EXPECT_EQ(state, GST_STATE_PAUSED);
  gst_message_unref(message);
  gst_object_unref(bus);
}

/// A change of the state has a lock that a seek waits for, and may wait for the window.
TEST(Seek, GoesUpstreamAndWaitsForNoChangeOfTheState) {
  ElementHarness h("device=none");
  GST_STATE_LOCK(h.element());
  std::thread window([&h] {
    const auto source = gst_spidar_motion_state(GST_SPIDAR_MOTION(h.element())).display.source();
    for (const int64_t to_ns : {3, 4, 5}) source->seek(to_ns);
  });
  window.join();
  GST_STATE_UNLOCK(h.element());
  gint64 to_ns = 0;
  while (to_ns != 5) {  // the last of those that waited
    GstEvent* const event = gst_harness_pull_upstream_event(h.harness());
    ASSERT_NE(event, nullptr) << "no seek within a minute";
    if (GST_EVENT_TYPE(event) == GST_EVENT_SEEK) {
      gst_event_parse_seek(event, nullptr, nullptr, nullptr, nullptr, &to_ns, nullptr, nullptr);
      EXPECT_GE(to_ns, 0);
    }
    gst_event_unref(event);
  }
}

TEST(GainCurve, IsThatOfTheController) {
  window::Timeline timeline;
  window::Moment moment;
  moment.speed_px_s = 400;
  moment.interval_s = 0.04;
  timeline.add(moment);
  moment.time_s = 0.02;
  moment.interval_s = 0;
  timeline.add(moment);
  ControllerSettings settings;  // eq. 15: 2 · 3 / π · atan(0.01 v)
  settings.alpha_s_px = 0.01;
  const std::vector<double> nonlinear = timeline.gain_curve(settings, 200, 3);
  ASSERT_EQ(nonlinear.size(), 3u);
  EXPECT_EQ(nonlinear[0], 0);
  EXPECT_NEAR(nonlinear[1], 1.5, kRounding);
  EXPECT_NEAR(nonlinear[2], 6 / M_PI * std::atan(2.0), kRounding);
  settings.law = ControlLaw::kLinear;  // eq. 12: k = 3 / 400
  const std::vector<double> linear = timeline.gain_curve(settings, 200, 3);
  EXPECT_NEAR(linear[2], 1.5, kRounding);
  // The same as one that was given the frame, once.
  settings.law = ControlLaw::kAdaptive;
  GainController adaptive(settings);
  adaptive.force_N(400, 0.04);
  EXPECT_NEAR(timeline.gain_curve(settings, 200, 3)[1], adaptive.force_N(100), kRounding);
  settings.max_force_N = -1;
  EXPECT_TRUE(timeline.gain_curve(settings, 200, 3).empty());
}

TEST(GainCurve, SpeedIsThatOfTheReferenceFrame) {
  ImageMotion motion;
  motion.velocity_px_s = {30, 40};
  EXPECT_NEAR(reference_speeds_px_s(motion, {}, 960).norm(), 25, kRounding);
  motion.velocity_px_s.setZero();
  motion.growth_1_s = 0.5;  // by half of 480 px
  motion.roll_rad_s = 0.5;
  EXPECT_NEAR(reference_speeds_px_s(motion, {1, 0}, 960).norm(), 120, kRounding);
}

}  // namespace
}  // namespace spidar::test::window_model_test
