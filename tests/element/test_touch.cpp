// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// Reliefs of frames, and how what is touched moves.
#include "plugin/filter/touch/relief_stream.h"
#include "plugin/gobject/structure_fields.h"
#include "spidar/devices/sim/simulated_device.h"
#include "spidar/loop/stiffness_limit.h"
#include "spidar/loop/string_grip.h"
#include "spidar/profiles/profile.h"
#include "tests/support/allocation_count.h"
#include "tests/support/element_harness.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace spidar::test::touch_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;

/// With the lag that the simulated device has.
Profile profile_of_simulation() {
  Profile profile = load_profile(kDefaultProfile);
  profile.drive_lag_known = true;
  return profile;
}

/// Of a frame of 320 × 240 that is 40 ms after the one before.
Frame some_analysis() {
  Frame analysis;
  analysis.place = FilmPlace::whole(320, 240);
  analysis.interval_ns = static_cast<int64_t>(kFrame);
  analysis.picture = FrameComparison::kOther;
  return analysis;
}

TEST(TouchedMotion, IsThatOfTheObjectUnderTheFingerElseOfTheBackground) {
  Frame analysis = some_analysis();
  Background background;
  background.model.kind = ModelKind::kSimilarity;
  background.model.shift_px = {3, 0};
  background.model.linear = 0.01 * Eigen::Matrix2d::Identity();
  MovingObject large;
  large.position_px = {40, 0};
  large.size_px = {80, 80};
  large.area_px2 = 6400;
  large.points = 9;
  large.on_screen_px_s = {-50, 25};
  MovingObject small = large;
  small.size_px = {20, 20};
  small.area_px2 = 400;
  small.on_screen_px_s = {0, 100};
  MovingObject hidden = large;
  hidden.position_px = {-100, 0};
  hidden.points = 0;
  analysis.background = background;
  analysis.objects = {large, small, hidden};
  const auto at = [&](double x_px, double y_px) {
    return filter::touched_displacement_px(analysis, {0.5 + x_px / 320, 0.5 + y_px / 240});
  };
  constexpr double kRounding = 1e-12;
  EXPECT_NEAR((at(45, 5) - Eigen::Vector2d(0, 4)).norm(), 0, kRounding) << "the smaller one";
  EXPECT_NEAR((at(70, 30) - Eigen::Vector2d(-2, 1)).norm(), 0, kRounding);
  EXPECT_NEAR((at(0, 100) - Eigen::Vector2d(3, 1)).norm(), 0, kRounding) << "beside them";
  EXPECT_NEAR((at(-100, 0) - Eigen::Vector2d(2, 0)).norm(), 0, kRounding) << "out of sight";
  for (const FrameComparison says_nothing : {FrameComparison::kFirst, FrameComparison::kWaiting,
                                             FrameComparison::kSame, FrameComparison::kAlike}) {
    Frame still = analysis;
    still.picture = says_nothing;
    EXPECT_EQ(filter::touched_displacement_px(still, {0.5, 0.5}).norm(), 0);
  }
}

TEST(TouchedMotion, IsNoneAroundTheFilm) {
  Frame analysis = some_analysis();
  analysis.place.area = {160, 0, 160, 120};
  analysis.background.emplace();
  analysis.background->model.kind = ModelKind::kTranslation;
  analysis.background->model.shift_px = {3, 0};
  EXPECT_EQ(filter::touched_displacement_px(analysis, {0.9, 0.1}), Eigen::Vector2d(3, 0));
  EXPECT_EQ(filter::touched_displacement_px(analysis, {0.4, 0.1}), Eigen::Vector2d(0, 0));
  EXPECT_EQ(filter::touched_displacement_px(analysis, {0.9, 0.6}), Eigen::Vector2d(0, 0));
}

TEST(TouchedMotion, WithoutModelsItIsThatOfTheWholePicture) {
  Frame analysis = some_analysis();
  analysis.motion.velocity_px_s = {100, -50};
  EXPECT_NEAR(
      (filter::touched_displacement_px(analysis, {0.1, 0.9}) - Eigen::Vector2d(4, -2)).norm(), 0,
      1e-12);
}

/// The loop is not ticked, so that a test can inspect what was published.
struct Reliefs {
  Reliefs() : loop(std::make_unique<HapticLoop>(std::make_unique<StringGrip>(profile, device))) {
    stream.connect(loop.get(), profile, {0.03, 0.03});
  }
  const Profile profile = profile_of_simulation();
  SimulatedDevice device{profile, SimulatedDevice::Time::kFixedStep};
  std::unique_ptr<HapticLoop> loop;
  filter::ReliefStream stream;
};

uint64_t number_of(const filter::ReliefStream& stream, const char* field) {
  GstStructure* stats = gst_structure_new_empty("stats");
  StructureFields to(stats);
  stream.describe(to);
  guint64 value = 0;
  gst_structure_get_uint64(stats, field, &value);
  gst_structure_free(stats);
  return value;
}

TEST(ReliefStream, WhatTheLoopHasNoRoomForIsLeftOutAndCounted) {
  init_gstreamer();
  Reliefs reliefs;
  const std::vector<uint8_t> grey(320 * 240, 128);
  const ImageView luma{grey.data(), 320, 240, 320};
  TouchProperties touch;
  reliefs.stream.add(luma, some_analysis(), 0, touch, {0.5, 0.5});
  EXPECT_EQ(number_of(reliefs.stream, "reliefs"), 0u) << "off";
  touch.kind = TouchProperties::Kind::kLuma;
  for (size_t n = 0; n < filter::ReliefStream::kSlots + 5; ++n) {
    reliefs.stream.add(luma, some_analysis(), static_cast<int64_t>(n * kFrame), touch, {0.5, 0.5});
  }
  EXPECT_EQ(number_of(reliefs.stream, "reliefs"), filter::ReliefStream::kSlots);
  EXPECT_EQ(number_of(reliefs.stream, "reliefs-left-out"), 5u);
}

TEST(ReliefStream, TakesNothingFromTheHeapAfterTheFirstFrame) {
  if (!kCountsAllocations) GTEST_SKIP() << "a sanitizer has the heap";
  init_gstreamer();
  Reliefs reliefs;
  reliefs.loop->open();
  const std::vector<uint8_t> grey(1920 * 1080, 128);
  TouchProperties touch;
  touch.kind = TouchProperties::Kind::kLuma;
  touch.texture = 1;
  int64_t now_ns = 0;
  long before = 0;
  for (int n = 0; n < 100; ++n) {
    if (n == 1) before = allocations;
    reliefs.stream.add({grey.data(), 1920, 1080, 1920}, some_analysis(), n, touch, {0.5, 0.5});
    reliefs.stream.clear();
    now_ns += kTick_ns;
    reliefs.loop->tick(now_ns, now_ns);  // which makes room
  }
  EXPECT_EQ(allocations, before);
}

/// A bump moves 12 pixels to the right and 9 down from frame to frame. Half-way between two frames
/// it is where half of that leads, and as high as in them; cross-faded it would be 0.3 mm lower,
/// and moved the other way much more.
TEST(ReliefStream, TheSurfaceMovesAsTheBackgroundDoes) {
  init_gstreamer();
  constexpr int kWidth = 320, kHeight = 240;
  constexpr double kSigma_px = 25;
  constexpr double kRelief_m = 0.008;
  const Eigen::Vector2d step_px(12, 9);
  const Eigen::Vector2d pixel_m(0.06 / kWidth, 0.06 / kHeight);
  Reliefs reliefs;
  TouchProperties touch;
  touch.kind = TouchProperties::Kind::kLuma;
  touch.friction = 0;
  Background background;
  background.model.kind = ModelKind::kTranslation;
  background.model.shift_px = step_px;
  Frame analysis = some_analysis();
  analysis.background = background;
  // In frame n the bump is so far from the middle.
  const auto bump_px = [&](double n) { return Eigen::Vector2d((n - 8.5) * step_px); };
  std::vector<uint8_t> luma(kWidth * kHeight);
  for (int n = 0; n < 18; ++n) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const Eigen::Vector2d at_px(x + 0.5 - kWidth / 2, y + 0.5 - kHeight / 2);
        const double distance = (at_px - bump_px(n)).norm() / kSigma_px;
        luma[static_cast<size_t>(y * kWidth + x)] =
            static_cast<uint8_t>(std::lround(255 * std::exp(-distance * distance / 2)));
      }
    }
    const auto shown_ns = static_cast<int64_t>(kFrame) * (n + 10);
    reliefs.stream.add({luma.data(), kWidth, kHeight, kWidth}, analysis, shown_ns, touch,
                       {0.5, 0.5});
  }
  // Half-way from frame 8 to 9 its top is in the middle, where the grip is held.
  reliefs.loop->open();
  int64_t now_ns = 0;
  reliefs.loop->set_playback_clock({0, 0, 1.0, true});
  const auto half_way_ns = static_cast<int64_t>(kFrame) * 37 / 2;
  while (now_ns < half_way_ns) {
    now_ns += kTick_ns;
    reliefs.loop->tick(now_ns, now_ns);
  }
  const TickRecord last = reliefs.loop->snapshot().last;
  ASSERT_TRUE(last.contact.touching);
  // The pose of the exchange before; the contact is of that.
  const Eigen::Vector3d grip_m = last.pose.position_m;
  const Eigen::Vector2d away_px(grip_m.x() / pixel_m.x(), -grip_m.y() / pixel_m.y());
  const double distance = away_px.norm() / kSigma_px;
  ASSERT_LT(distance, 0.5) << "it is the top that is touched";
  const double surface_m = kRelief_m * (std::exp(-distance * distance / 2) - 0.5);
  const double cosine = last.contact.force_N.normalized().z();
  // A step of brightness, what the smoothing takes from the top (σ² of 0.5 mm over that of the
  // bump), and what the grip moves in a tick.
  const double tolerance_m = kRelief_m / 255 + kRelief_m * 2.5e-7 / 2.2e-5 + 2e-5;
  EXPECT_NEAR(grip_m.z() + last.contact.depth_m / cosine, surface_m, tolerance_m);
}

/// Force to the right for each newton to the viewer, on a grip that is pressed against the middle
/// of a 2D+Z frame. From left to right each half is dark to bright, or grey.
double tilt(touch::DepthLayout layout, bool picture_rises, bool depth_rises) {
  constexpr int kWidth = 512, kHeight = 256;
  const bool is_right = layout == touch::DepthLayout::kRight;
  const int half_width = is_right ? kWidth / 2 : kWidth;
  std::vector<uint8_t> luma(kWidth * kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const bool is_depth = is_right ? x >= kWidth / 2 : y >= kHeight / 2;
      const int rising = x % half_width * 256 / half_width;
      luma[static_cast<size_t>(y * kWidth + x)] =
          static_cast<uint8_t>((is_depth ? depth_rises : picture_rises) ? rising : 128);
    }
  }
  Reliefs reliefs;
  reliefs.loop->open();
  TouchProperties touch;
  touch.kind = is_right ? TouchProperties::Kind::kDepth : TouchProperties::Kind::kDepthBelow;
  touch.friction = 0;
  reliefs.stream.add({luma.data(), kWidth, kHeight, kWidth}, some_analysis(), 0, touch, {0.5, 0.5});
  Pose hand;
  hand.position_m.z() = -0.02;  // behind any relief of 8 mm
  reliefs.device.set_hand(hand);
  reliefs.loop->set_playback_clock({0, 0, 1.0, true});
  for (int64_t now_ns = kTick_ns; now_ns < 2000 * kTick_ns; now_ns += kTick_ns)
    reliefs.loop->tick(now_ns, now_ns);
  const touch::Contact contact = reliefs.loop->snapshot().last.contact;
  EXPECT_TRUE(contact.touching);
  EXPECT_GT(contact.force_N.z(), 0.5);
  return contact.force_N.x() / contact.force_N.z();
}

TEST(ReliefStream, DepthInHalfOfTheFrameIsTheRelief) {
  init_gstreamer();
  for (const touch::DepthLayout layout : {touch::DepthLayout::kRight, touch::DepthLayout::kBelow}) {
    // 8 mm of relief, for the depths between the percentiles 2 and 98, over 60 mm. Each end is
    // known to one of 256 grey levels or columns; and a step of an encoder is 22.5 µm of some 3 mm.
    const double slope = 0.008 / (0.96 * 0.06);
    EXPECT_NEAR(tilt(layout, false, true), -slope, slope * (2.0 / 256 + 0.0225 / 3));
    EXPECT_NEAR(tilt(layout, true, false), 0, slope * 0.0225 / 3);
  }
}

TEST(ReliefStream, ADeviceWithoutAWorkspaceIsAnErrorThatSaysSo) {
  init_gstreamer();
  Reliefs reliefs;
  reliefs.stream.connect(reliefs.loop.get(), reliefs.profile, {0.03, 0});
  const std::vector<uint8_t> grey(320 * 240, 128);
  TouchProperties touch;
  touch.kind = TouchProperties::Kind::kLuma;
  EXPECT_THROW(
      reliefs.stream.add({grey.data(), 320, 240, 320}, some_analysis(), 0, touch, {0.5, 0.5}),
      std::invalid_argument);
}

TEST(TouchProperties, ASlowDriveGetsLessStiffnessAndAWarning) {
  Profile profile = load_profile(kDefaultProfile);
  EXPECT_EQ(most_stiffness_N_m(profile), 200) << "until the lag was measured";
  profile.drive_lag_known = true;
  EXPECT_EQ(most_stiffness_N_m(profile), touch::ContactSettings::kMaxStiffness_N_m);
  profile.drive_lag_s = 0.0055;  // twice the delay of 3.5 ms
  EXPECT_NEAR(most_stiffness_N_m(profile), touch::ContactSettings::kMaxStiffness_N_m / 2, 1e-9);
  TouchProperties touch;
  touch.stiffness_N_m = 700;
  const touch::ContactSettings contact = filter::contact_settings(touch, profile);
  EXPECT_NEAR(contact.stiffness_N_m, 400, 1e-9);
  EXPECT_NEAR(contact.delay_s, 0.007, 1e-12);
  EXPECT_NEAR(contact.damping_N_s_m(), 1.5 * 400 * 0.007, 1e-9);
}

}  // namespace
}  // namespace spidar::test::touch_test
