// SPDX-License-Identifier: LGPL-2.1-or-later
// Copyright 2026 the gst-spidar authors
/// Debug windows for a test, and the colours in their pictures.
#pragma once

#include <stb/stb_image.h>

#include "plugin/window/program/model/layout.h"
#include "plugin/window/window.h"
#include "tests/support/element_harness.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/test.h"
#include "tests/support/video_frames.h"
#include "tests/support/virtual_display.h"

namespace spidar::test {

/// Long enough for any machine: it is only reached when a test fails.
constexpr std::chrono::minutes kLong{2};

struct Color {
  int r = 0, g = 0, b = 0;
};

/// What a window shows: RGB, rows from the top.
struct Screenshot {
  int width = 1, height = 1;
  std::vector<uint8_t> rgb{0, 0, 0};
};

inline Color at(const Screenshot& shot, double x, double y) {
  const size_t i = 3 * (static_cast<size_t>(std::floor(y)) * static_cast<size_t>(shot.width) +
                        static_cast<size_t>(std::floor(x)));
  return {shot.rgb.at(i), shot.rgb.at(i + 1), shot.rgb.at(i + 2)};
}

inline std::string shown(const Color& c) {
  return std::to_string(c.r) + " " + std::to_string(c.g) + " " + std::to_string(c.b);
}

inline bool is_grey(const Color& c) {
  // A conversion from limited to full range may be off by one level a channel.
  return std::abs(c.r - c.g) <= 2 && std::abs(c.g - c.b) <= 2 && c.r < 200;
}
inline bool is_red(const Color& c) {
  return c.r > 180 && c.g < 100 && c.b < 100;
}
inline bool is_white(const Color& c) {
  return c.r > 240 && c.g > 240 && c.b > 240;
}

/// One that has been asked for everything before is answered; what came before is in it.
inline Screenshot look(window::Window& window) {
  const TemporaryFolder folder;
  const std::string path = folder.path / "window.png";
  const std::string error = window.take_picture(path, kLong);
  EXPECT_EQ(error, "");
  Screenshot shot;
  int channels = 0;
  if (uint8_t* const pixels = stbi_load(path.c_str(), &shot.width, &shot.height, &channels, 3)) {
    shot.rgb.assign(pixels, pixels + size_t{3} * static_cast<size_t>(shot.width * shot.height));
    stbi_image_free(pixels);
  }
  return shot;
}

class WindowTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    // For spidar-window, which begins after this. Software OpenGL compiles code and registers its
    // stack frames with libgcc, which allocates under a lock of its own. If the address sanitizer
    // then unwinds the stack with libgcc for that allocation, it deadlocks.
    setenv("ASAN_OPTIONS", "fast_unwind_on_malloc=1", 1);
    init_gstreamer();
    display = &VirtualDisplay::shared();
  }
  void SetUp() override {
    if (!display->runs()) GTEST_SKIP() << VirtualDisplay::kWhyNot;
  }

  /// A grey frame of 320 × 240 with `report`, once the window wants one.
  static void give(window::Window& window, DrawnFrame report, int level = 128) {
    GstVideoInfo info;
    gst_video_info_set_format(&info, GST_VIDEO_FORMAT_RGB, 320, 240);
    GstBuffer* buffer = gst_buffer_new_allocate(nullptr, GST_VIDEO_INFO_SIZE(&info), nullptr);
    gst_buffer_memset(buffer, 0, static_cast<guint8>(level), GST_VIDEO_INFO_SIZE(&info));
    GstVideoFrame frame;
    gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ);
    report.visible = visible_part(frame);
    report.frame.place = FilmPlace::whole(320, 240);
    while (!window.wants_frame() || !window.queue_frame(frame, report)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    gst_video_frame_unmap(&frame);
    gst_buffer_unref(buffer);
  }

  static void press(window::Window& window, int key) {
    window::UserInput input;
    input.key = key;
    window.input(input);
  }
  static void set_mouse(window::Window& window, const window::Mouse& mouse) {
    window::UserInput input;
    input.mouse = mouse;
    window.input(input);
  }

  static window::PictureMap map_of(const Screenshot& shot) {
    return window::map_picture(window::lay_out(shot.width, shot.height, 1).picture, 0, 0, 320, 240,
                               1);
  }

  /// Grey level of the frame in the window, where nothing is drawn over it.
  static int level_in(window::Window& window) {
    const Screenshot shot = look(window);
    const Eigen::Vector2d p = map_of(shot)({100, 100});
    return at(shot, p.x(), p.y()).g;
  }

  static inline VirtualDisplay* display = nullptr;
};

}  // namespace spidar::test
