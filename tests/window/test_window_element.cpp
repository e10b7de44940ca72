// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A debug window and its element: states, settings, and a window system that hangs.
#include <unistd.h>

#include <GLFW/glfw3.h>

#include "plugin/filter/display/motion_display.h"
#include "plugin/filter/spidar_motion.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"
#include "tests/window/window_fixture.h"

namespace spidar::test::window_element_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
class WindowElement : public WindowTest {
 protected:
  void TearDown() override {
    if (display->runs()) display->thaw();
  }

  void open(const std::string& properties) {
    h = std::make_unique<ElementHarness>(properties, [this] { return time_ns; });
    h->set_caps(make_caps("I420", 320, 240));
  }

  std::shared_ptr<window::Window> window() {
    return gst_spidar_motion_state(GST_SPIDAR_MOTION(h->element())).display.window();
  }

  void push_next() {
    const int n = frames++;
    ASSERT_EQ(h->push_moved(2.0 * n, 0, static_cast<GstClockTime>(n) * kFrame), GST_FLOW_OK);
  }

  void tick(int count) {
    for (int i = 0; i < count; ++i) {
      time_ns += kTick_ns;
      h->tick(time_ns);
    }
  }

  bool has_window_property() {
    gboolean value = FALSE;
    g_object_get(h->element(), "debug-window", &value, nullptr);
    return value != FALSE;
  }

  int64_t time_ns = 1'000'000'000;
  int frames = 0;
  std::unique_ptr<ElementHarness> h;
};

TEST_F(WindowElement, ShowsTheFramesAndChangesSettings) {
  open("device=sim debug-window=true max-force=2");
  tick(300);
  ASSERT_NE(window(), nullptr);
  while (!window()->wants_frame()) g_usleep(1000);
  for (int n = 0; n < 4; ++n) push_next();
  const Screenshot shot = look(*window());
  // The picture is a texture of many grey levels, the panel behind it has one.
  const window::Rect picture = window::lay_out(shot.width, shot.height, 1).picture;
  int least = 255, most = 0;
  for (double x = picture.x + picture.width / 4; x < picture.x + picture.width / 2; ++x) {
    const int level = at(shot, x, picture.y + picture.height / 4).g;
    least = std::min(least, level);
    most = std::max(most, level);
  }
  EXPECT_GT(most - least, 50);

  press(*window(), GLFW_KEY_SPACE);
  press(*window(), GLFW_KEY_UP);
  look(*window());
  gboolean mute = FALSE;
  gdouble max_force = 0;
  g_object_get(h->element(), "mute", &mute, "max-force", &max_force, nullptr);
  EXPECT_TRUE(mute);
  EXPECT_NEAR(max_force, 2.1, 1e-9);
  EXPECT_TRUE(h->warnings().empty());
}

TEST_F(WindowElement, ClosedByTheUserTheVideoGoesOn) {
  open("device=none debug-window=true");
  look(*window());
  press(*window(), GLFW_KEY_Q);
  while (has_window_property()) g_usleep(1000);
  for (int n = 0; n < 3; ++n) push_next();
  EXPECT_EQ(h->motions().size(), 3u);
  EXPECT_TRUE(h->warnings().empty());
  g_object_set(h->element(), "debug-window", TRUE, nullptr);
  ASSERT_NE(window(), nullptr);
  look(*window());  // and may be opened again
}

TEST_F(WindowElement, StateMayGoUpAndDown) {
  open("device=none debug-window=true");
  for (int n = 0; n < 4; ++n) {
    // Every other time while it draws, else while it opens.
    if (n % 2 == 0) look(*window());
    EXPECT_EQ(gst_element_set_state(h->element(), GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
    EXPECT_EQ(window(), nullptr);
    EXPECT_EQ(gst_element_set_state(h->element(), GST_STATE_PLAYING), GST_STATE_CHANGE_SUCCESS);
    EXPECT_NE(window(), nullptr);
  }
  EXPECT_TRUE(h->warnings().empty());
  EXPECT_TRUE(has_window_property());
}

TEST_F(WindowElement, TheWindowIsWhatThePropertySaysWhoeverSetsIt) {
  open("device=none");
  for (int round = 0; round < 5; ++round) {
    std::vector<std::thread> threads;
    for (int k = 0; k < 4; ++k) {
      threads.emplace_back([this, k] {
        for (int n = 0; n < 5; ++n) {
          g_object_set(h->element(), "debug-window", (n + k) % 2 == 0, nullptr);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    ASSERT_EQ(window() != nullptr, has_window_property()) << round;
  }
  EXPECT_TRUE(h->warnings().empty());
}

TEST_F(WindowElement, AWindowSystemThatHangsHoldsUpNothing) {
  open("device=sim debug-window=true alpha=0.01");
  look(*window());
  display->freeze();
  // The window waits for the X server as soon as the socket between them is full.
  while (window()->take_picture("/dev/null", std::chrono::milliseconds(200)).empty()) {
  }
  tick(300);
  PlaybackClock clock;
  clock.playing = true;
  clock.monotonic_ns = time_ns;
  h->state().feed.output.session()->loop().set_playback_clock(clock);
  for (int n = 0; n < 20; ++n) {
    push_next();
    tick(40);
  }
  EXPECT_EQ(h->motions().size(), 20u);
  EXPECT_GT(h->state().feed.output.session()->loop().snapshot().last.commanded.force_N.norm(), 0.5)
      << "50 px/s by eq. 15: 0.89 N";
  EXPECT_EQ(gst_element_set_state(h->element(), GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
  EXPECT_EQ(h->state().feed.output.session(), nullptr);
  display->thaw();
  EXPECT_EQ(gst_element_set_state(h->element(), GST_STATE_PLAYING), GST_STATE_CHANGE_SUCCESS);
  look(*window());  // and all is well again
}

TEST_F(WindowElement, WithoutADisplayIsOneWarning) {
  const std::string name = getenv("DISPLAY");
  unsetenv("DISPLAY");
  open("device=none debug-window=true");
  while (has_window_property()) g_usleep(1000);
  setenv("DISPLAY", name.c_str(), 1);
  for (int n = 0; n < 3; ++n) push_next();
  EXPECT_EQ(h->motions().size(), 3u);
  EXPECT_TRUE(h->errors().empty());
  gboolean saved = TRUE;
  g_signal_emit_by_name(h->element(), "save-window", "/tmp/none.png", &saved);
  EXPECT_FALSE(saved);
  ASSERT_EQ(h->warnings().size(), 1u);
  EXPECT_NE(h->warnings()[0].find("DISPLAY"), std::string::npos) << h->warnings()[0];
}

}  // namespace
}  // namespace spidar::test::window_element_test
