// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// pointer=grip with a joystick, whose stick is the grip.
#include "spidar/session/haptic_session.h"
#include "tests/emulated_bus/bus_state.h"
#include "tests/support/element_harness.h"
#include "tests/support/moving_scene.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"

namespace spidar::test::force_feedback_pointer_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
constexpr int kWidth = 320, kHeight = 240;

class StickTest : public testing::Test {
 protected:
  StickTest() : scene(kWidth, kHeight) {
    clear_bus();
    scene.plain_background();
  }
  ~StickTest() override {
    h.reset();
    clear_bus();
  }

  void open(const std::string& properties) {
    h.reset();
    h = std::make_unique<ElementHarness>(properties + " motion=objects",
                                         [this] { return time_ns; });
    h->set_caps(make_caps("GRAY8", kWidth, kHeight));
    for (int ms = 0; ms < 300; ++ms) tick();  // strings are taut
  }
  void tick() {
    time_ns += kTick_ns;
    h->tick(time_ns);
  }
  LoopSnapshot seen() { return h->state().feed.output.session()->loop().snapshot(); }
  double stick_x_m() { return seen().last.pose.position_m.x(); }

  /// Opens the device and waits until its stick is seen to be half of the way to the end stop,
  /// which is half of the way to the frame: 59 mm / 2. The thread that reads the stick and the
  /// guardian run in real time: if a busy machine stops the ticks for too long, the device is lost.
  void open_with_stick_at(int side) {
    do {
      bus().evdev[0].axis[0] = side * 500;
      open("device=ff pointer=grip");
      while (side * stick_x_m() < 0.9 * 0.059 / 4 && seen().counters.times_lost == 0) tick();
    } while (seen().counters.times_lost > 0);
  }

  /// The felt velocity to the right while two discs move by 2 px a frame, 50 px/s: the first, from
  /// `left`, to the left, and the second, from `right`, to the right.
  double felt_px_s(double left, double right) {
    h->state().film.begin_run();
    for (int n = 0; n < 6; ++n, ++frames) {
      const ImageView view = scene.draw({}, {{{left - 2 * n, 0}}, {{right + 2 * n, 0}}});
      h->push(gst_buffer_new_memdup(view.data, kWidth * kHeight),
              static_cast<GstClockTime>(frames) * kFrame);
    }
    return h->motions().back().velocity_x;
  }

  MovingScene scene;
  int64_t time_ns = 1'000'000'000;
  int frames = 0;
  std::unique_ptr<ElementHarness> h;
};

TEST_F(StickTest, PointsAtWhatIsFelt) {
  plug_evdev(0, EvdevKind::kStick);
  scene.add_disc(36);
  scene.add_disc(36);
  for (const int side : {-1, 1}) {
    open_with_stick_at(side);
    // For the fraction of each disc see DeviceTest.TheGripPointsAtWhatIsFelt.
    EXPECT_GT(side * felt_px_s(-80, 80), 0.64 * 50) << side;
  }
}

/// The simulated joystick has its stick at the centre.
TEST_F(StickTest, TheSimulatedOnePointsAtTheCentre) {
  scene.add_disc(24);
  scene.add_disc(24);
  open("device=sim:ff pointer=grip");
  EXPECT_NEAR(stick_x_m(), 0, 1e-4);
  DeviceView view;
  ASSERT_TRUE(h->state().feed.output.read_device(view));
  EXPECT_FALSE(view.has_strings) << "the window shows none";
  // The pointer is on the second disc. The edge of the other one is 130 + 10 − 24 px away, which is
  // 1.9 σ of 60 px and leaves that one exp(−1.9² / 2) = 0.16 of the weight for an equal area. If it
  // has twice the area, (1 − 0.32) / (1 + 0.32) = 0.51 of the speed is left.
  EXPECT_GT(felt_px_s(-130, 0), 0.51 * 50);
  EXPECT_LT(felt_px_s(0, 130), -0.51 * 50);
  // A pointer at the other disc would feel that one.
  open("device=sim:ff pointer=0.1,0.5");
  EXPECT_LT(felt_px_s(-130, 0), 0);
}

}  // namespace
}  // namespace spidar::test::force_feedback_pointer_test
