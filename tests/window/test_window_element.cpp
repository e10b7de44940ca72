// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
// A debug window and its element: states, settings, and a window system that hangs.
#include <chrono>
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <unistd.h>
#include <vector>

#include <GLFW/glfw3.h>
#include <gtest/gtest.h>

#include "plugin/display/motion_display.h"
#include "plugin/spidar_motion.h"
#include "plugin/window/model/layout.h"
#include "tests/support/element_harness.h"
#include "tests/support/video_frames.h"
#include "tests/support/virtual_display.h"

namespace spidar::test::window_element_test {
namespace {

constexpr GstClockTime kFrame = 40 * GST_MSECOND;
/// Long enough for any machine: it is only reached when a test fails.
constexpr std::chrono::minutes kLong{2};

int64_t read_time(void* time) {
  return *static_cast<int64_t*>(time);
}

class WindowElement : public testing::Test {
 protected:
  static void SetUpTestSuite() { display = &VirtualDisplay::shared(); }
  void SetUp() override {
    if (!display->runs()) GTEST_SKIP() << VirtualDisplay::kWhyNot;
  }
  void TearDown() override {
    if (display->runs()) display->thaw();
  }

  void open(const std::string& properties) {
    h = std::make_unique<ElementHarness>(properties, read_time, &time_ns);
    h->set_caps(make_caps("I420", 320, 240));
  }

  std::shared_ptr<Window> window() {
    return gst_spidar_motion_display(GST_SPIDAR_MOTION(h->element())).window();
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

  static VirtualDisplay* display;
  int64_t time_ns = 1'000'000'000;
  int frames = 0;
  std::unique_ptr<ElementHarness> h;
};
VirtualDisplay* WindowElement::display;

TEST_F(WindowElement, ShowsTheFramesAndChangesSettings) {
  open("device=sim debug-window=true max-force=2");
  tick(300);
  ASSERT_NE(window(), nullptr);
  ASSERT_TRUE(window()->screenshot(kLong).has_value());  // it is there and wants a frame
  for (int n = 0; n < 4; ++n) push_next();
  const std::optional<Screenshot> shot = window()->screenshot(kLong);
  ASSERT_TRUE(shot.has_value());
  // The picture is a texture of many grey levels, the panel behind it has one.
  const Rect picture = lay_out(shot->width, shot->height, 1).picture;
  int least = 255, most = 0;
  for (double x = picture.x + picture.width / 4; x < picture.x + picture.width / 2; ++x) {
    const size_t y = static_cast<size_t>(picture.y + picture.height / 4);
    const int level =
        shot->rgb[3 * (y * static_cast<size_t>(shot->width) + static_cast<size_t>(x)) + 1];
    least = std::min(least, level);
    most = std::max(most, level);
  }
  EXPECT_GT(most - least, 50);

  window()->press(GLFW_KEY_SPACE);
  window()->press(GLFW_KEY_UP);
  ASSERT_TRUE(window()->screenshot(kLong).has_value());
  gboolean mute = FALSE;
  gdouble max_force = 0;
  g_object_get(h->element(), "mute", &mute, "max-force", &max_force, nullptr);
  EXPECT_TRUE(mute);
  EXPECT_NEAR(max_force, 2.1, 1e-9);
  EXPECT_TRUE(h->warnings().empty());
}

TEST_F(WindowElement, ClosedByTheUserTheVideoGoesOn) {
  open("device=none debug-window=true");
  std::shared_ptr<Window> first = window();
  ASSERT_TRUE(first->screenshot(kLong).has_value());
  first->press(GLFW_KEY_Q);
  EXPECT_FALSE(first->screenshot(kLong).has_value());
  first.reset();
  // The window is gone before the property says so.
  while (has_window_property()) g_usleep(1000);
  for (int n = 0; n < 3; ++n) push_next();
  EXPECT_EQ(h->motions().size(), 3u);
  g_object_set(h->element(), "debug-window", TRUE, nullptr);
  ASSERT_NE(window(), nullptr);
  EXPECT_TRUE(window()->screenshot(kLong).has_value()) << "and may be opened again";
}

TEST_F(WindowElement, StateMayGoUpAndDownTenTimes) {
  open("device=none debug-window=true");
  for (int n = 0; n < 10; ++n) {
    // Every other time while it draws, else while it opens.
    if (n % 2 == 0) {
      ASSERT_TRUE(window()->screenshot(kLong).has_value());
    }
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
  for (int round = 0; round < 20; ++round) {
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

TEST_F(WindowElement, ASecondElementHasItsOwn) {
  open("device=none debug-window=true");
  ElementHarness other("device=none debug-window=true");
  other.set_caps(make_caps("RGB", 64, 48));
  EXPECT_EQ(other.push_moved(0, 0, 0), GST_FLOW_OK);
  EXPECT_TRUE(window()->screenshot(kLong).has_value());
  EXPECT_TRUE(gst_spidar_motion_display(GST_SPIDAR_MOTION(other.element()))
                  .window()
                  ->screenshot(kLong)
                  .has_value());
}

TEST_F(WindowElement, AWindowSystemThatHangsHoldsUpNothing) {
  open("device=sim debug-window=true");
  ASSERT_TRUE(window()->screenshot(kLong).has_value());
  display->freeze();
  // The window thread waits for the X server as soon as the socket between them is full.
  while (window()->screenshot(std::chrono::milliseconds(200))) {
  }
  tick(300);
  PlaybackClock clock;
  clock.playing = true;
  clock.monotonic_ns = time_ns;
  h->engine().output().session()->loop().set_playback_clock(clock);
  for (int n = 0; n < 20; ++n) {
    push_next();
    tick(40);
  }
  EXPECT_EQ(h->motions().size(), 20u);
  EXPECT_GT(h->engine().output().session()->loop().snapshot().last.commanded.force_N.norm(), 0.5)
      << "50 px/s by eq. 15: 0.89 N";
  EXPECT_EQ(gst_element_set_state(h->element(), GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
  EXPECT_EQ(h->engine().output().session(), nullptr);
  display->thaw();
  EXPECT_EQ(gst_element_set_state(h->element(), GST_STATE_PLAYING), GST_STATE_CHANGE_SUCCESS);
  EXPECT_TRUE(window()->screenshot(kLong).has_value()) << "and all is well again";
}

TEST_F(WindowElement, WithoutADisplayIsOneWarning) {
  const auto play_without_a_display = [this] {
    unsetenv("DISPLAY");
    open("device=none debug-window=true");
    EXPECT_FALSE(window()->screenshot(kLong).has_value());
    for (int n = 0; n < 3; ++n) push_next();
    EXPECT_EQ(h->motions().size(), 3u);
    EXPECT_TRUE(h->errors().empty());
    gboolean saved = TRUE;
    g_signal_emit_by_name(h->element(), "save-window", "/tmp/none.png", &saved);
    EXPECT_FALSE(saved);
    EXPECT_EQ(h->warnings().size(), 1u);
    std::fprintf(stderr, "warning: %s", h->warnings().at(0).c_str());
    _exit(HasFailure() ? 1 : 0);
  };
  // In a process of its own, where no window was before: GLFW keeps its display.
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(play_without_a_display(), testing::ExitedWithCode(0), "warning: .*window");
}

TEST_F(WindowElement, MayOutliveItsElement) {
  open("device=none debug-window=true");
  const std::shared_ptr<Window> left_over = window();
  ASSERT_TRUE(left_over->screenshot(kLong).has_value());
  h.reset();
  while (left_over->screenshot(kLong)) {  // once more, perhaps; then it closes by itself
  }
}

}  // namespace
}  // namespace spidar::test::window_element_test
